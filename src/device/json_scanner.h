// Walks over JSON without building anything: no allocation, bounded depth, any bytes survive.
#pragma once

#include <optional>
#include <string_view>

namespace palpate::device {

class JsonScanner {
 public:
  explicit JsonScanner(std::string_view text) : text_(text) {}

  [[nodiscard]] bool failed() const { return failed_; }

  // At `{` or `[`: enters and returns true; anything else is left as it is.
  bool enter(char bracket);

  // Inside an object: goes to the next member and gives its key, unescaped as it is not; the value
  // must then be read or skipped. Nothing at the object's end or where the text is broken.
  std::optional<std::string_view> next_key();

  // Inside an array: true where there is an element, which must then be read or skipped.
  bool next_element();

  // A value, passed over where it is of another kind; nothing then.
  std::optional<double> number();
  std::optional<std::string_view> string();
  std::optional<bool> boolean();
  void skip();

  // Nothing but white space is left.
  bool at_end();

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
  bool first_ = false;  // no member of the present bracket has been read
  bool failed_ = false;
};

}  // namespace palpate::device
