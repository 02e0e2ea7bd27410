// A measured file as a table of texts, with names and units of its columns.
#pragma once

#include <string>
#include <vector>

#include "measured/measured.h"
#include "measured/text.h"

namespace palpate::measured {

struct RawRow {
  int line = 0;               // in the file, from 1
  std::vector<Piece> fields;  // one per column
};

struct RawTable {
  enum class Kind { plain, afm_tab, chiaro, febio_log, jpk, anton_paar, bluehill };

  std::string file;
  Kind kind = Kind::plain;
  std::vector<std::string> names;  // one per column; empty: the file has none
  std::vector<std::string> units;  // from a row of units below the names; empty: no such row
  int header_line = 0;             // 0: none
  char decimal = '.';
  std::vector<RawRow> rows;
  std::vector<std::string> notes;
  std::size_t tables = 1;  // of the same columns, in the column `segment` if there are several

  [[nodiscard]] std::size_t width() const { return rows.front().fields.size(); }
};

// The table of the text, with at least one row and all rows as wide as the header. Throws
// InputError with its place if there is no table or it is ambiguous.
[[nodiscard]] RawTable raw_table(std::string_view bytes, const std::string& file,
                                 const DataLayout& layout);

// The number in a field; NaN for a missing number (empty, `nan`, `NA`, `-`); nothing for any other
// word. A number outside the range of doubles is infinite.
[[nodiscard]] std::optional<double> measured_number(std::string_view text, char decimal);

// FEBio's log data: `*Step`, `*Time`, `*Data  = a;b` before rows of an item and its values. The
// table has the columns step, time (s), item and the names of the data.
[[nodiscard]] bool is_febio_log(const std::vector<Line>& lines);
[[nodiscard]] RawTable febio_table(const std::vector<Line>& lines, const std::string& file);

// Text exports of JPK: `# columns:` and `# units:` above values separated by blanks, and before
// each part of the curve `# segment: extend` (or retract, pause), which become a column `segment`.
// If the file has a spring constant and no tip position, a column `tip position` = height + force /
// k is added.
[[nodiscard]] bool is_jpk_text(const std::vector<Line>& lines);
[[nodiscard]] RawTable jpk_table(const std::vector<Line>& lines, const std::string& file);

}  // namespace palpate::measured
