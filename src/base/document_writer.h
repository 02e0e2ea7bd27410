// A tree of values as TOML that reads back to the same tree.
#pragma once

#include <string>
#include <string_view>

#include "base/document.h"

namespace palpate {

// A text or a key in double quotes, escaped.
[[nodiscard]] std::string toml_text(std::string_view text);

// A key, quoted where it has to be.
[[nodiscard]] std::string toml_key(std::string_view key);

// A value on one line, tables inline.
[[nodiscard]] std::string toml_value(const Node& value);

// A whole document: top-level keys, then a [table] each, inline tables below that.
[[nodiscard]] std::string toml_document(const Node& root);

}  // namespace palpate
