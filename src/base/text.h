// Numbers and words as text: shortest round-trip numbers, the nearest known word.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

// The shortest decimal text that reads back as the same double; `nan`, `inf` and `-inf` by name.
[[nodiscard]] std::string number_text(double value);

// The number with `digits` significant digits, for people.
[[nodiscard]] std::string rounded_text(double value, int digits = 4);

// A number at the start of a text.
struct LeadingNumber {
  double value = 0.0;
  std::string_view rest;      // what follows the number
  bool out_of_range = false;  // such as 1e400
};
[[nodiscard]] std::optional<LeadingNumber> leading_number(std::string_view text);

// The whole text as one number, or nothing; an out-of-range number is nothing too.
[[nodiscard]] std::optional<double> whole_number(std::string_view text);

// The known word nearest to `word` by edit distance, or nothing where none is near enough to help.
[[nodiscard]] std::optional<std::string> nearest(std::string_view word,
                                                 std::span<const std::string> known);

[[nodiscard]] std::string trimmed(std::string_view text);
[[nodiscard]] std::string joined(std::span<const std::string> words, std::string_view separator);
[[nodiscard]] std::vector<std::string> split(std::string_view text, char separator);

}  // namespace palpate
