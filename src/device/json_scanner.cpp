// Scans JSON according to RFC 8259; \u escapes and UTF-8 are not checked.
#include "device/json_scanner.h"

#include <charconv>

#include "base/text.h"

namespace palpate::device {

void JsonScanner::space() {
  while (at_ < text_.size() &&
         (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r'))
    ++at_;
}

bool JsonScanner::take(char c) {
  space();
  if (failed_ || peek() != c || at_ == text_.size()) return false;
  ++at_;
  return true;
}

bool JsonScanner::take_word(std::string_view word) {
  if (!text_.substr(at_).starts_with(word)) return false;
  at_ += word.size();
  return true;
}

bool JsonScanner::enter(char bracket) {
  if (!take(bracket)) return false;
  if (++depth_ > deepest) fail();
  first_ = true;
  return !failed_;
}

// Reads the comma before a member or element, unless it is the first; false at the closing `end`.
bool JsonScanner::separator(char end) {
  if (failed_) return false;
  if (take(end)) {
    --depth_;
    first_ = false;
    return false;
  }
  if (!first_ && !take(',')) {
    fail();
    return false;
  }
  first_ = false;
  return true;
}

std::optional<std::string_view> JsonScanner::next_key() {
  if (!separator('}')) return std::nullopt;
  space();
  const auto key = raw_string();
  if (!key || !take(':')) {
    fail();
    return std::nullopt;
  }
  return key;
}

bool JsonScanner::next_element() { return separator(']'); }

std::optional<std::string_view> JsonScanner::raw_string() {
  if (peek() != '"' || at_ == text_.size()) return std::nullopt;
  const std::size_t start = ++at_;
  for (; at_ < text_.size(); ++at_) {
    const char c = text_[at_];
    if (c == '"') return text_.substr(start, at_++ - start);
    if (static_cast<unsigned char>(c) < 0x20) break;
    if (c == '\\') ++at_;
  }
  fail();
  return std::nullopt;
}

std::optional<double> JsonScanner::raw_number() {
  const std::size_t start = at_;
  const auto digits = [this] {
    const std::size_t from = at_;
    while (is_digit(peek())) ++at_;
    return at_ > from;
  };
  if (peek() == '-') ++at_;
  const bool zero = peek() == '0';
  bool good = digits() && !(zero && at_ - start > (text_[start] == '-' ? 2u : 1u));
  if (good && peek() == '.') {
    ++at_;
    good = digits();
  }
  if (good && (peek() == 'e' || peek() == 'E')) {
    ++at_;
    if (peek() == '+' || peek() == '-') ++at_;
    good = digits();
  }
  double value = 0.0;
  if (good) {
    const auto read = std::from_chars(text_.data() + start, text_.data() + at_, value);
    // 1e400 is valid JSON but not a double.
    if (read.ec == std::errc::result_out_of_range) return std::nullopt;
    good = read.ec == std::errc() && read.ptr == text_.data() + at_;
  }
  if (!good) {
    fail();
    return std::nullopt;
  }
  return value;
}

std::optional<double> JsonScanner::number() {
  space();
  if (failed_) return std::nullopt;
  if (peek() == '-' || is_digit(peek())) return raw_number();
  skip();
  return std::nullopt;
}

std::optional<std::string_view> JsonScanner::string() {
  space();
  if (failed_) return std::nullopt;
  if (peek() == '"') return raw_string();
  skip();
  return std::nullopt;
}

std::optional<std::string_view> JsonScanner::word() {
  space();
  const std::size_t start = at_;
  if (peek() == '"') return string();
  if (!number()) return std::nullopt;
  return text_.substr(start, at_ - start);
}

std::optional<bool> JsonScanner::boolean() {
  space();
  if (failed_) return std::nullopt;
  if (take_word("true")) return true;
  if (take_word("false")) return false;
  skip();
  return std::nullopt;
}

void JsonScanner::skip() {
  space();
  if (failed_) return;
  if (enter('{')) {
    while (next_key()) skip();
  } else if (enter('[')) {
    while (next_element()) skip();
  } else if (peek() == '"') {
    raw_string();
  } else if (peek() == '-' || is_digit(peek())) {
    raw_number();
  } else if (!take_word("true") && !take_word("false") && !take_word("null")) {
    fail();
  }
}

bool JsonScanner::at_end() {
  space();
  return !failed_ && depth_ == 0 && at_ == text_.size();
}

}  // namespace palpate::device
