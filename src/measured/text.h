// Divides the bytes of a measured file into lines of UTF-8, and lines into fields; finds out the
// separator and the decimal sign, or refuses an ambiguous table.
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

}  // namespace palpate::measured
