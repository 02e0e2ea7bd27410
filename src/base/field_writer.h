// Writes a struct's fields as TOML that reads back to the same values.
#pragma once

#include <string>

#include "base/fields.h"

namespace palpate {

// Keys that have no effect for the present values are written only with `Written::all`.
enum class Written { used, all };
[[nodiscard]] std::string fields_as_toml(const Fields& fields, Written written = Written::used);

// A reference of every key in Markdown: type, range, default, meaning and when it is used.
[[nodiscard]] std::string fields_as_manual(const Fields& fields);

}  // namespace palpate
