// std::to_chars and std::from_chars: no locale, the same text on every machine.
#include "base/text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>
#include <system_error>

namespace palpate {

std::string number_text(double value) {
  if (std::isnan(value)) return "nan";
  std::array<char, 64> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

std::string rounded_text(double value, int digits) {
  if (std::isnan(value)) return "nan";
  std::array<char, 64> buffer{};
  auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                              std::chars_format::general, digits);
  const std::string_view text(buffer.data(), static_cast<std::size_t>(result.ptr - buffer.data()));
  if (std::abs(value) < 1e6 && text.find("e+") != std::string_view::npos) {  // 3e+02 is 300
    double rounded = 0.0;
    std::from_chars(text.data(), text.data() + text.size(), rounded);
    result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), rounded,
                           std::chars_format::fixed, 0);
  }
  return {buffer.data(), result.ptr};
}

std::optional<LeadingNumber> leading_number(std::string_view text) {
  const std::string_view given = text;
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  LeadingNumber number;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), number.value);
  if (result.ec == std::errc::invalid_argument) return std::nullopt;
  number.out_of_range = result.ec == std::errc::result_out_of_range;
  number.rest = given.substr(static_cast<std::size_t>(result.ptr - given.data()));
  return number;
}

std::optional<double> whole_number(std::string_view text) {
  const auto number = leading_number(text);
  if (!number || number->out_of_range || !number->rest.empty()) return std::nullopt;
  return number->value;
}

namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = lower(c);
  return result;
}

// Levenshtein distance with transpositions of neighbours counted as one edit.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  std::vector<std::size_t> next(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    next[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = row[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      next[j] = std::min({row[j] + 1, next[j - 1] + 1, change});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        next[j] = std::min(next[j], before[j - 2] + 1);
    }
    before.swap(row);
    row.swap(next);
  }
  return row.back();
}

}  // namespace

std::optional<std::string> nearest(std::string_view word, std::span<const std::string> known) {
  std::optional<std::string> best;
  // Of two that are as near, the one that differs in capitals only is meant: `KPA` is `kPa`.
  std::pair best_distance(1 + std::max<std::size_t>(2, word.size() / 2), std::size_t{0});
  for (const std::string& candidate : known) {
    const bool same_letters = lower(word) == lower(candidate);
    const std::size_t distance = same_letters ? 0 : edit_distance(word, candidate);
    const std::pair ranked(distance, edit_distance(lower(word), lower(candidate)));
    if (ranked < best_distance && distance < candidate.size()) {
      best_distance = ranked;
      best = candidate;
    }
  }
  return best;
}

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  const auto last = text.find_last_not_of(" \t\r\n");
  return std::string(text.substr(first, last - first + 1));
}

std::string joined(std::span<const std::string> words, std::string_view separator) {
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += separator;
    text += word;
  }
  return text;
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  std::size_t from = 0;
  while (true) {
    const std::size_t to = text.find(separator, from);
    parts.emplace_back(text.substr(from, to - from));
    if (to == std::string_view::npos) return parts;
    from = to + 1;
  }
}

}  // namespace palpate
