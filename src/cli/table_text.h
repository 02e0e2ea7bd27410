// Tables for stdout: as JSON, as CSV, or for a person's eyes.
#pragma once

#include <string>

#include "cli/talk.h"
#include "record/table.h"

namespace palpate::cli {

// One JSON object per row and line; empty cells become null.
[[nodiscard]] std::string json_lines(const record::Table& table);

// A table of one row as one of two columns, `name` and `value`.
[[nodiscard]] record::Table names_and_values(const record::Table& table);

// Aligned columns; numbers to the right and with four digits, whole numbers with all of theirs.
[[nodiscard]] std::string aligned(const record::Table& table);

// The result of a verb on stdout: with --json one line a row; on a terminal, unless --csv is given,
// `for_eyes` as aligned columns; else `table` as CSV.
void print_result(const record::Table& table, const record::Table& for_eyes, const Talk& talk);

}  // namespace palpate::cli
