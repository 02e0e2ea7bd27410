// A serial line used by one program only: raw bytes, no flow control, one stop bit, non-blocking;
// and its bytes as lines.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/files.h"

namespace palpate::device {

class Tap;

struct LineFormat {
  int baud = 115200;
  int data_bits = 8;  // 7 or 8
  enum class Parity { none, even, odd };
  Parity parity = Parity::none;
};
// Whether a line can be set to this rate, and the rates to which it can, for messages.
[[nodiscard]] bool is_known_rate(int baud);
[[nodiscard]] std::string known_rates();

class SerialPort {
 public:
  enum class Use { alone, shared };  // shared: for a stop, whoever has the port
  // Opens `path` and locks it for Use::alone. Throws LinkError if the port does not exist, is not
  // permitted, not a serial line, or in use, and if it cannot have the rate.
  SerialPort(const std::string& path, const LineFormat& format, Use use = Use::alone);
  ~SerialPort();
  SerialPort(SerialPort&& other) noexcept = default;

  // True if all bytes were accepted; false if the line is lost or its queue is full.
  bool write(std::string_view bytes);

  enum class Outcome { bytes, nothing, lost };
  struct Read {
    Outcome outcome = Outcome::nothing;
    std::size_t size = 0;
  };
  // Waits for bytes until `until` (s, wire_time()) and reads those that have arrived.
  [[nodiscard]] Read read(std::span<char> into, double until);

  // From now on `tap` receives a copy of all bytes written and read; null ends this.
  void tap(Tap* tap) { tap_ = tap; }

  [[nodiscard]] bool lost() const { return lost_; }
  [[nodiscard]] int descriptor() const { return file_; }

 private:
  void unlock();

  Descriptor lock_;
  Descriptor file_;  // closed before the lock
  Use use_;
  bool lost_ = false;
  Tap* tap_ = nullptr;
};

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

// A port with its bytes as lines, and the first ones for a diagnosis.
struct SerialLines {
  SerialPort port;
  LineBuffer lines;
  std::string first_bytes;

  SerialLines(const std::string& path, const LineFormat& format, Tap* tap,
              SerialPort::Use use = SerialPort::Use::alone);
  // Waits until `until` (s, wire_time()) for bytes, and takes them. False if none have come.
  bool receive(double until);
  // Discards what has arrived, which replies to no request that follows: the number of bytes.
  std::size_t drain();

 private:
  // Reads into `bytes`; empty if there are none.
  std::string_view read(std::span<char> bytes, double until);
};

[[nodiscard]] std::string_view without_outer_spaces(std::string_view text);  // and tabs

// The fraction (0 to 1) of bytes that no reply contains, which is large at a wrong baud rate.
[[nodiscard]] double garbage_share(std::string_view bytes);

// At most 40 bytes for a message, with a point for each byte that cannot be printed. Allocates.
[[nodiscard]] std::string printable(std::string_view bytes);

}  // namespace palpate::device
