// Words of commands that a person copies or a script runs.
#pragma once

#include <string>
#include <string_view>

namespace palpate {

// In quotes, so that a shell takes it as one word.
[[nodiscard]] inline std::string shell_word(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

// In quotes only where a shell needs them.
[[nodiscard]] inline std::string shown_word(const std::string& text) {
  constexpr std::string_view plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_./:=+,@%-";
  return text.empty() || text.find_first_not_of(plain) != std::string::npos ? shell_word(text)
                                                                            : text;
}

}  // namespace palpate
