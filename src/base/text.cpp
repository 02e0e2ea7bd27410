// Numbers as text by std::to_chars and std::from_chars: no locale, the same on every machine.
#include "base/text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <numeric>
#include <system_error>

#include "base/index.h"

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
  const std::string_view text(buffer.data(), as_index(result.ptr - buffer.data()));
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
  number.rest = given.substr(as_index(result.ptr - given.data()));
  return number;
}

std::optional<double> whole_number(std::string_view text) {
  const auto number = leading_number(text);
  if (!number || number->out_of_range || !number->rest.empty()) return std::nullopt;
  return number->value;
}

std::string out_of_range_text(std::string_view given) {
  return ticked(given) +
         " is too large or too small; write a number between 1e-300 and 1e300 in size";
}

namespace {

// Levenshtein distance in which a transposition of neighbours counts as one edit.
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
  // Among equally near candidates one that differs only in capitals comes first: `KPA`, `kPa`.
  std::pair best_distance(1 + std::max<std::size_t>(2, word.size() / 2), std::size_t{0});
  for (const std::string& candidate : known) {
    const std::size_t longer = std::max(word.size(), candidate.size());
    const std::size_t shorter = std::min(word.size(), candidate.size());
    if (longer - shorter > best_distance.first) continue;  // it takes at least as many edits
    const bool same_letters = lower_case(word) == lower_case(candidate);
    const std::size_t distance = same_letters ? 0 : edit_distance(word, candidate);
    const std::pair ranked(distance, edit_distance(lower_case(word), lower_case(candidate)));
    if (ranked < best_distance && distance < candidate.size()) {
      best_distance = ranked;
      best = candidate;
    }
  }
  if (best || word.size() < 4) return best;
  for (const std::string& candidate : known) {  // `modulus` of `young_modulus`
    if (candidate.find(word) == std::string::npos) continue;
    if (best) return std::nullopt;
    best = candidate;
  }
  return best;
}

std::string did_you_mean(std::string_view word, std::span<const std::string> known,
                         const std::string& otherwise) {
  const auto near = nearest(word, known);
  return near ? "did you mean " + ticked(*near) + "?" : otherwise;
}

std::string bytes_text(std::string_view bytes) {
  std::string text = "\"";
  for (const char byte : bytes) {
    const auto value = static_cast<unsigned char>(byte);
    if (byte == '\r')
      text += "\\r";
    else if (byte == '\n')
      text += "\\n";
    else if (byte == '\\')
      text += "\\\\";
    else if (byte == '"')
      text += "\"\"";
    else if (value >= 0x20 && value < 0x7f)
      text += byte;
    else
      text += "\\x" + hex_text(value);
  }
  return text + "\"";
}

std::string hex_text(unsigned char byte) {
  constexpr std::string_view digits = "0123456789abcdef";
  return {digits[byte >> 4U], digits[byte & 15U]};
}

std::string one_line(std::string_view name) {
  std::string line;
  for (const char c : name) line += c == '\n' ? std::string("\\x0a") : std::string(1, c);
  return line;
}

std::string shortened(std::string_view text) {
  constexpr std::size_t most = 200;
  if (text.size() <= most) return std::string(text);
  std::size_t end = most;  // not within a letter of UTF-8
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0U) == 0x80U) --end;
  return std::string(text.substr(0, end)) + "...";
}

std::size_t first_broken_character(std::string_view text) {
  std::size_t at = 0;
  while (at < text.size()) {
    const auto lead = static_cast<unsigned char>(text[at]);
    const std::size_t size = lead < 0x80   ? 1
                             : lead < 0xc2 ? 0
                             : lead < 0xe0 ? 2
                             : lead < 0xf0 ? 3
                                           : 4;
    if (size == 0 || lead > 0xf4 || at + size > text.size()) return at;
    for (std::size_t i = 1; i < size; ++i)
      if ((static_cast<unsigned char>(text[at + i]) & 0xc0) != 0x80) return at;
    at += size;
  }
  return at;
}

std::string ticked(std::string_view text) { return "`" + std::string(text) + "`"; }

std::string percent_text(double part) { return rounded_text(100.0 * part, 2) + " %"; }

std::string error_text(double error) {
  return error > 1.0 ? "more than 100 %" : "about " + percent_text(error);
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return result;
}

std::string capitalized(std::string text) {
  const std::string word = text.substr(0, text.find(' '));
  const std::size_t dot = word.find('.');
  const bool name = word.find_first_of("_`=") != std::string::npos || word.find(',') == 1 ||
                    (dot != std::string::npos && dot + 1 < word.size());
  if (!text.empty() && !name)
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string within_sentence(std::string label) {
  const auto small = [](char c) { return c >= 'a' && c <= 'z'; };
  const std::size_t name = label.find("'s ");  // `Young's modulus`
  if (label.size() > 1 && small(label[1]) && name >= label.find(' '))
    label[0] = lower_case(label.substr(0, 1))[0];
  return label;
}

std::string shell_word(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

std::string shown_word(const std::string& text) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./:=+,@%-";
  return text.empty() || text.find_first_not_of(plain) != std::string::npos ? shell_word(text)
                                                                            : text;
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

std::string alternatives(std::span<const std::string> words) {
  if (words.size() < 2) return joined(words, "");
  return joined(words.first(words.size() - 1), ", ") + " or " + words.back();
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
