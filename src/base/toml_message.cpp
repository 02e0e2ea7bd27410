// Messages for TOML errors: the parser gives the byte where it stopped, the message the key or
// value before it.
#include "base/toml_message.h"

#include <algorithm>

#include "base/index.h"
#include "base/text.h"

namespace palpate {
namespace {

// True for the first byte of a UTF-8 character; columns count characters.
bool starts_character(char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }

// The byte offset of a line and column; at most the end of that line.
std::size_t offset_of(std::string_view text, const Place& place) {
  std::size_t at = 0;
  for (int line = 1; line < place.line && at < text.size(); ++line)
    at = std::min(text.find('\n', at), text.size() - 1) + 1;
  for (int column = 1; column < place.column && at < text.size() && text[at] != '\n'; ++column) do
      ++at;
    while (at < text.size() && !starts_character(text[at]));
  return at;
}

// The part of the parser's message that is in single quotes, such as '1e400'.
std::string_view parser_quote(std::string_view description) {
  const std::size_t from = description.find('\'');
  const std::size_t to = description.rfind('\'');
  return from == to ? "" : description.substr(from + 1, to - from - 1);
}

// The `key` or `[table]` whose second definition the parser found at `at`.
std::string_view repeated(std::string_view text, std::size_t at) {
  const auto rest = text.substr(at, text.find_first_of("\r\n", at) - at);
  if (rest.starts_with('[') && (at == 0 || text[at - 1] == '\n'))
    return rest.substr(0, rest.find_last_of(']') + 1);
  const std::size_t line = text.substr(0, at).find_last_of('\n') + 1;
  std::size_t equals = text.substr(0, at).find_last_of('=');
  if (equals == std::string_view::npos || equals < line) equals = text.find('=', at);
  if (equals == std::string_view::npos) return rest;
  const std::size_t end = text.find_last_not_of(" \t=", equals) + 1;
  const std::size_t comma = text.substr(0, end).find_last_of("{,");
  std::size_t begin = comma != std::string_view::npos && comma >= line ? comma + 1 : line;
  while (begin < end && (text[begin] == ' ' || text[begin] == '\t')) ++begin;
  return text.substr(begin, end - begin);
}

}  // namespace

Place place_at(std::string_view text, std::size_t offset, const std::string& file) {
  const auto before = text.substr(0, offset);
  const std::size_t line_start = before.find_last_of('\n') + 1;  // npos + 1 is 0: the first line
  const auto in_line = before.substr(line_start);
  return {file, 1 + static_cast<int>(std::count(before.begin(), before.end(), '\n')),
          1 + static_cast<int>(std::count_if(in_line.begin(), in_line.end(), starts_character))};
}

Problem toml_problem(std::string_view text, const Place& place, std::string_view description) {
  const auto says = [&](std::string_view part) {
    return description.find(part) != std::string_view::npos;
  };
  const std::size_t at = offset_of(text, place);
  const auto starting_at = [&](std::string_view part) {
    const std::size_t start = part.empty() ? at : text.rfind(part, at);
    return place_at(text, start == std::string_view::npos ? at : start, place.file);
  };

  if (says("redefine")) {
    const std::string_view twice = repeated(text, at);
    const auto offset = as_index(twice.data() - text.data());
    return {place_at(text, offset, place.file),
            ticked(twice) + " is given twice; keep one of the two"};
  }
  if (says("utf-8") || says("UTF-8"))
    return {place, "the file is not UTF-8 text; save it as UTF-8"};
  if (says("could not be interpreted as a value") || says("not representable")) {
    const std::string_view number = parser_quote(description);
    return {starting_at(number), ticked(number) + " is a number that " +
                                     (says("bits") ? "64 bits cannot" : "no double can") +
                                     " hold; write one between -1e300 and 1e300"};
  }
  if (says("unescaped control characters") || (says("string:") && says("end-of-file")))
    return {place, "a text is not closed on its line; end it with the quote it began with"};
  if (says("expected a comment or whitespace"))
    return {place,
            "a value is followed by more on its line; put quantities in double quotes, as "
            "`\"5 mm\"`, and each key on a line of its own"};
  if (says("determine value type"))
    return {place, "this is not a TOML value; put words in double quotes"};
  const std::size_t colon = description.find(": ");
  const bool framed = description.starts_with("Error while parsing ") && colon != description.npos;
  const auto what = framed ? "this " + std::string(description.substr(20, colon - 20)) +
                                 " cannot be read: " + std::string(description.substr(colon + 2))
                           : "this cannot be read: " + std::string(description);
  return {place, what + "; write `key = value`, texts and quantities in double quotes"};
}

}  // namespace palpate
