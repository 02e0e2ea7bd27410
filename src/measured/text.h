// Divides the bytes of a measured file into lines of UTF-8, and lines into fields.
#pragma once

#include <string>
#include <string_view>
#include <vector>

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

}  // namespace palpate::measured
