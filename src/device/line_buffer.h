// Divides the bytes of a serial line into lines.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace palpate::device {

inline constexpr std::size_t longest_line = 160;  // bytes; longer than any reply to a command

// Stores at most the last kilobyte and never allocates.
class LineBuffer {
 public:
  // Appends all bytes; if the buffer is full, the oldest bytes are dropped and counted.
  void feed(std::string_view bytes);
  // Returns the next complete line without its end and outer spaces; empty lines are skipped. The
  // view is valid until the next call. A line longer than `longest_line` is returned in pieces.
  [[nodiscard]] std::optional<std::string_view> next();
  // The bytes that next() has not returned yet.
  [[nodiscard]] std::string_view rest() const;
  void clear();
  [[nodiscard]] std::size_t dropped() const { return dropped_; }  // bytes, since the start

 private:
  std::array<char, 1024> bytes_{};
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
  std::size_t dropped_ = 0;
};

[[nodiscard]] std::string_view without_outer_spaces(std::string_view text);  // and tabs

// The fraction (0 to 1) of bytes that no reply contains, which is large at a wrong baud rate.
[[nodiscard]] double garbage_share(std::string_view bytes);

// At most 40 bytes for a message, with a point for each byte that cannot be printed. Allocates.
[[nodiscard]] std::string printable(std::string_view bytes);

}  // namespace palpate::device
