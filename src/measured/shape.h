// Finds out the separator and the decimal sign of a table in text, or refuses an ambiguous table.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "measured/measured.h"
#include "measured/text.h"

namespace palpate::measured {

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
