// A measured file as a table of texts: where it begins, how it is separated, what heads it.
#pragma once

#include <string>
#include <vector>

#include "record/measured.h"
#include "record/measured_text.h"

namespace palpate::record {

struct RawRow {
  int line = 0;
  std::vector<Piece> fields;  // one a column
};

struct RawTable {
  enum class Kind { plain, afm_tab, chiaro, febio_log };

  std::string file;
  Kind kind = Kind::plain;
  std::vector<std::string> names;  // one a column; empty: the file names none
  std::vector<std::string> units;  // of a row of units below the names; empty: no such row
  int header_line = 0;             // 0: none
  char decimal = '.';
  std::vector<RawRow> rows;
  std::vector<std::string> notes;

  [[nodiscard]] std::size_t width() const { return rows.front().fields.size(); }
};

// The one table of the text; throws InputError with its place where there is none, or where it can
// be read in two ways. At least one row; every row is as wide as the header.
[[nodiscard]] RawTable raw_table(std::string_view bytes, const std::string& file,
                                 const DataLayout& layout);

// The number that a field says, NaN where it says that there is none (empty, `nan`, `NA`, `-`), or
// nothing where it is another word. A number that no double holds is infinite.
[[nodiscard]] std::optional<double> measured_number(std::string_view text, char decimal);

// The table of FEBio's log data: `*Step`, `*Time`, `*Data  = a;b` before rows of an item and its
// values. Columns: step, time (s), item and the data's names.
[[nodiscard]] bool is_febio_log(const std::vector<Line>& lines);
[[nodiscard]] RawTable febio_table(const std::vector<Line>& lines, const std::string& file);

}  // namespace palpate::record
