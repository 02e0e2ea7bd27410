// Reads JSON text in one pass, without a tree, without allocation and to a limited depth.
#pragma once

#include <optional>
#include <string_view>

namespace palpate::device {

class JsonScanner {
 public:
  explicit JsonScanner(std::string_view text) : text_(text) {}

  [[nodiscard]] bool failed() const { return failed_; }

  // Enters an object (`{`) or array (`[`) and returns true, or reads nothing and returns false.
  bool enter(char bracket);

  // Inside an object: returns the key of the next member, with escape sequences left as they are;
  // its value must then be read or skipped. Nothing at the object's end and if the text is invalid.
  std::optional<std::string_view> next_key();

  // Inside an array: true if there is another element, which must then be read or skipped.
  bool next_element();

  // Each reads a value. A value of another type is skipped, and the result is nothing.
  std::optional<double> number();
  std::optional<std::string_view> string();
  std::optional<std::string_view> word();  // a string, or a number as it is written
  std::optional<bool> boolean();
  void skip();

  bool at_end();  // true if the text was valid and only white space is left

 private:
  void space();
  [[nodiscard]] char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  void fail() { failed_ = true; }
  bool take(char c);
  bool take_word(std::string_view word);
  std::optional<std::string_view> raw_string();
  std::optional<double> raw_number();
  bool separator(char end);

  static constexpr int deepest = 32;
  std::string_view text_;
  std::size_t at_ = 0;
  int depth_ = 0;
  bool first_ = false;  // no member of the current object or array has been read
  bool failed_ = false;
};

}  // namespace palpate::device
