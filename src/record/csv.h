// Tables as CSV: commas, line feeds, one header row, empty fields for missing values.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/files.h"
#include "record/table.h"

namespace palpate::record {

// The table as text, from which parse_csv restores exactly the same table. Numbers have the fewest
// digits that identify the double. A word is quoted (RFC 4180) if it contains a separator, a quote,
// a line break or outer spaces, or would otherwise be read as a number or as missing. The table
// must have at least one column, distinct names, and rows as long as the header.
[[nodiscard]] std::string csv_text(const Table& table);

// Reads a whole CSV text with line ends LF or CR LF; `file` is its name in messages. Quoted fields
// are words; other fields are numbers (also `nan` and `inf`) if they can be read as such. Blank
// lines at the end of a table of several columns are skipped. Throws InputError with file:line for
// an empty file, a column without a name or with the name of another, another separator, a row
// longer or shorter than the header, a misplaced or open quote, and a number beyond all doubles.
[[nodiscard]] Table parse_csv(std::string_view text, const std::string& file);

// Reads and parses a file. Throws InputError also if the file cannot be read.
[[nodiscard]] Table read_csv(const std::string& path);

// A table that is written to a new file row by row.
class CsvFile {
 public:
  // Throws SystemError if the file cannot be created.
  CsvFile(const std::string& path, std::vector<std::string> columns);

  // Adds a row, which must be as long as the header. Throws SystemError if it cannot be written.
  void add(std::vector<Cell> row);
  // Returns when the whole file is on the disk. Throws SystemError.
  void finish();

 private:
  void flush();

  GrowingFile file_;
  Table held_;
  bool begun_ = false;
};

}  // namespace palpate::record
