// How a table in text is separated and where it begins: found out, or refused where it is unclear.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "record/measured.h"
#include "record/measured_text.h"

namespace palpate::record {

// A separator and a decimal sign.
struct Shape {
  char separator = ',';  // `,` `;` tab, or a blank for any run of blanks
  char decimal = '.';
  bool separator_given = false;
  bool decimal_given = false;
};

// The layout's separator and decimal sign, or those by which the most lines are numbers. Throws
// InputError where the layout's words are unknown or fit nothing.
[[nodiscard]] Shape shape_of(std::span<const Line> lines, const std::string& file,
                             const DataLayout& layout);

// How many fields are numbers, and whether every other one is empty or says that it holds none.
struct Numbers {
  int count = 0;
  bool all = false;
};
[[nodiscard]] Numbers numbers_in(std::span<const Piece> fields, char decimal);

// Whether a line is a comment: it begins with `#`.
[[nodiscard]] bool is_comment(const Line& line);
[[nodiscard]] bool is_blank(const Line& line);

}  // namespace palpate::record
