// A measured file's bytes as lines of UTF-8, and a line as fields.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace palpate::record {

struct Line {
  int number = 0;  // in the file, from 1
  std::string text;
};

// Lines end by LF, CR LF or CR. A byte order mark is passed over; UTF-16 with one is read; what is
// no UTF-8 is read as ISO 8859-1, in which instruments write their micro signs. Throws InputError
// with the place of a NUL byte, which text does not hold.
[[nodiscard]] std::vector<Line> lines_of(std::string_view bytes, const std::string& file);

struct Piece {
  std::string text;  // trimmed, without its quotes
  int column = 1;    // in the line, from 1, in characters
};

// `separator` is one character; a blank stands for any run of blanks and tabs. Blanks and
// separators at the line's end make no field with ' ', one empty field each with the others.
// Quoted fields may hold the separator. Throws InputError where a quote is not closed.
[[nodiscard]] std::vector<Piece> pieces_of(const Line& line, char separator,
                                           const std::string& file);

}  // namespace palpate::record
