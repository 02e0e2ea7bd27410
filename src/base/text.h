// Numbers and words as text: exact and rounded numbers, and the nearest known word.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

// The shortest decimal text that reads back as the same double; `nan`, `inf` and `-inf` by name.
[[nodiscard]] std::string number_text(double value);

// The number with `digits` significant digits, for messages.
[[nodiscard]] std::string rounded_text(double value, int digits = 4);

// A number at the start of a text.
struct LeadingNumber {
  double value = 0.0;
  std::string_view rest;      // the text after the number
  bool out_of_range = false;  // such as 1e400
};
[[nodiscard]] std::optional<LeadingNumber> leading_number(std::string_view text);

// The value if the whole text is one number (not only an integer) that is not out of range.
[[nodiscard]] std::optional<double> whole_number(std::string_view text);

// The message for a number whose text is `given` and that no double can represent.
[[nodiscard]] std::string out_of_range_text(std::string_view given);

// The known word with the smallest edit distance from `word`; empty if none is similar.
[[nodiscard]] std::optional<std::string> nearest(std::string_view word,
                                                 std::span<const std::string> known);
// "did you mean `word`?" with the nearest known word; `otherwise` where none is similar.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string> known,
                                       const std::string& otherwise);

// Bytes as a quoted CSV field: printable ASCII as it is (quotes doubled), \r, \n, \\ or \xHH.
[[nodiscard]] std::string bytes_text(std::string_view bytes);

// Two hexadecimal digits, in small letters.
[[nodiscard]] std::string hex_text(unsigned char byte);

// A name from a file as part of a line, which its line feeds do not end.
[[nodiscard]] std::string one_line(std::string_view name);

// The offset of the first byte that does not start a UTF-8 character, or the text's size.
[[nodiscard]] std::size_t first_broken_character(std::string_view text);

// The first 200 bytes of a text, for a place of which the sentence names the part that is wrong.
[[nodiscard]] std::string shortened(std::string_view text);

// The text between backticks, as messages quote keys, words and options.
[[nodiscard]] std::string ticked(std::string_view text);

// A part of 1 with two significant digits, such as "1.5 %".
[[nodiscard]] std::string percent_text(double part);

// An estimated relative error: "about 1.5 %", or "more than 100 %", where its size tells nothing.
[[nodiscard]] std::string error_text(double error);

[[nodiscard]] constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }  // ASCII

// With the letters A to Z in lower case.
[[nodiscard]] std::string lower_case(std::string_view text);

// With a capital first letter, but for a name such as `tissue.young_modulus`, `mass_spring` or the
// parameter of `a, logarithmic fit`.
[[nodiscard]] std::string capitalized(std::string text);
// A label as part of a sentence: with a small first letter if the first word is one.
[[nodiscard]] std::string within_sentence(std::string label);

// A word of a command, in quotes, so that a shell takes it as one; `shown_word` has quotes only
// where a shell needs them.
[[nodiscard]] std::string shell_word(const std::string& text);
[[nodiscard]] std::string shown_word(const std::string& text);

[[nodiscard]] std::string trimmed(std::string_view text);
[[nodiscard]] std::string joined(std::span<const std::string> words, std::string_view separator);
[[nodiscard]] std::string alternatives(std::span<const std::string> words);  // "A, B or C"
[[nodiscard]] std::vector<std::string> split(std::string_view text, char separator);

}  // namespace palpate
