// Tables for stdout: as CSV, on their side, or as JSON.
#pragma once

#include <string>

#include "record/table.h"

namespace palpate::cli {

// One JSON object a row, one a line; nothing becomes null.
[[nodiscard]] std::string json_lines(const record::Table& table);

// A table of one row as CSV of two columns, `name` and `value`.
[[nodiscard]] std::string names_and_values(const record::Table& table);

}  // namespace palpate::cli
