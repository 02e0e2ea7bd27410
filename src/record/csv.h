// Tables as CSV: comma, line feed, one header row, an empty field where nothing is known.
#pragma once

#include <string>
#include <string_view>

#include "record/table.h"

namespace palpate::record {

// The table as text that parse_csv reads back as the very same table. Numbers have the fewest
// digits that name the same double. A word is quoted (RFC 4180) where it holds a comma, a quote,
// a line break or outer spaces, and where it would otherwise be read as a number or as nothing.
// The table has at least one column, distinct names, and rows as long as the header.
[[nodiscard]] std::string csv_text(const Table& table);

// Reads a whole CSV text; `file` is what places will say. Line feeds or CR LF; quoted fields are
// words, others are numbers (`nan` and `inf` too) where they read as one. Blank lines at the end
// of a table of several columns are passed over. Throws InputError with file:line: an empty file,
// a column without a name or named twice, another separator, a row longer or shorter than the
// header, a quote that is not closed or stands inside a field, a number that no double holds.
[[nodiscard]] Table parse_csv(std::string_view text, const std::string& file);

// Reads and parses a file. Throws InputError also where the file cannot be read.
[[nodiscard]] Table read_csv(const std::string& path);

}  // namespace palpate::record
