// Tables for stdout: transposed as CSV, or as JSON.
#pragma once

#include <string>

#include "record/table.h"

namespace palpate::cli {

// One JSON object per row and line; empty cells become null.
[[nodiscard]] std::string json_lines(const record::Table& table);

// A table of one row as CSV of two columns, `name` and `value`.
[[nodiscard]] std::string names_and_values(const record::Table& table);

}  // namespace palpate::cli
