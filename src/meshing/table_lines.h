// A text file as lines of words with their places, without comments and empty lines.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace palpate::meshing {

class TableLines {
 public:
  // Reads the whole file. Throws InputError if it does not exist or cannot be read.
  explicit TableLines(std::string file);

  // Goes to the next line that contains words; false at the end of the file.
  [[nodiscard]] bool next();

  // The same; a line that ends with a backslash goes on in the next one.
  [[nodiscard]] bool next_joined();

  // The current line's words, which refer to data of this object.
  [[nodiscard]] const std::vector<std::string_view>& words() const { return words_; }

  // The current line as it is, and the whole file.
  [[nodiscard]] std::string_view text() const { return current_; }
  [[nodiscard]] std::string_view file_text() const { return text_; }

  // The next `bytes` bytes after the current line, for binary parts of a file; next() continues
  // after them. Throws InputError if the file ends before.
  [[nodiscard]] std::string_view take(std::size_t bytes);

  // Goes on after the next empty line.
  void skip_paragraph();

  // The current line's number, from 1.
  [[nodiscard]] int line() const { return line_; }

  // Word `i` as a finite number or an integer, named `what` in messages. Throws InputError if it is
  // not.
  [[nodiscard]] double number(std::size_t i, const std::string& what) const;
  [[nodiscard]] int whole(std::size_t i, const std::string& what) const;

  [[noreturn]] void fail(const std::string& message) const;  // at the current line
  [[noreturn]] void fail_at(std::size_t i, const std::string& message) const;  // at word `i`

 private:
  std::string file_;
  std::string text_;
  std::size_t position_ = 0;
  int line_ = 0;
  std::string_view current_;
  std::vector<std::string_view> words_;
};

}  // namespace palpate::meshing
