// Writes a tree of values as TOML that reads back to the same tree.
#pragma once

#include <string>
#include <string_view>

#include "base/document.h"

namespace palpate {

// A text or a key in double quotes, with escape sequences.
[[nodiscard]] std::string toml_text(std::string_view text);

// A key, quoted if TOML requires it.
[[nodiscard]] std::string toml_key(std::string_view key);

// A value on one line; tables are written inline.
[[nodiscard]] std::string toml_value(const Node& value);

// A whole document: first top-level keys, then each table under its [header], inline tables in it.
[[nodiscard]] std::string toml_document(const Node& root);

}  // namespace palpate
