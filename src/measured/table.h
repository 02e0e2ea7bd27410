// A measured file as a table of texts, with names and units of its columns: its bytes as lines of
// UTF-8, the fields of the lines, the separator and the decimal sign.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "measured/measured.h"

namespace palpate::measured {

struct Line {
  int number = 0;  // in the file, from 1
  std::string text;
};

// Lines end with LF, CR LF or CR. A byte order mark is skipped; UTF-16 is recognised without one,
// too. Bytes that are not UTF-8 are read as ISO 8859-1, in which instruments write micro signs.
// Throws InputError with the place of a NUL byte, because text contains none, and for archives and
// binary formats with the way to unpack or export them.
[[nodiscard]] std::vector<Line> lines_of(std::string_view bytes, const std::string& file);

struct Piece {
  std::string text;  // trimmed, without its quotes
  int column = 1;    // in the line, from 1, in characters
};

// The fields of a line. The separator ' ' means any number of blanks and tabs, and those at the end
// of the line make no field; any other separator at the end is followed by an empty field. Quoted
// fields may contain the separator. Throws InputError if a quote is not closed.
[[nodiscard]] std::vector<Piece> pieces_of(const Line& line, char separator,
                                           const std::string& file);

// A separator and a decimal sign.
struct Shape {
  char separator = ',';  // `,` `;` tab, or a blank for any number of blanks
  char decimal = '.';
  bool separator_given = false;
  bool decimal_given = false;
};

// The layout's separator and decimal sign, or those with which most lines consist of numbers.
// Throws InputError if the layout's words are unknown or commas may also separate thousands.
[[nodiscard]] Shape shape_of(std::span<const Line> lines, const std::string& file,
                             const DataLayout& layout);

// The numbers among the fields of a line.
struct Numbers {
  int count = 0;     // fields that are a number, or a word such as `NA` for a missing number
  bool all = false;  // all other fields are empty
};
[[nodiscard]] Numbers numbers_in(std::span<const Piece> fields, char decimal);

// Whether a line is a comment: its first character other than a blank is `#`.
[[nodiscard]] bool is_comment(const Line& line);
[[nodiscard]] bool is_blank(const Line& line);

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
