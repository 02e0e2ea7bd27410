// Writes a struct's fields as TOML that reads back to the same values.
#pragma once

#include <string>

#include "base/fields.h"

namespace palpate {

// Keys that have no effect for the present values are left out, unless all are asked for.
enum class Written { used, all };
[[nodiscard]] std::string fields_as_toml(const Fields& fields, Written written = Written::used);

// A markdown reference of every key: type, default, range, where it is used, meaning.
[[nodiscard]] std::string fields_as_manual(const Fields& fields);

}  // namespace palpate
