// A serial line used by one program only: raw bytes, no flow control, one stop bit, non-blocking.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

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
  SerialPort(SerialPort&& other) noexcept;
  SerialPort& operator=(SerialPort&&) = delete;

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
  void release();

  int file_ = -1;
  int lock_ = -1;
  Use use_;
  bool lost_ = false;
  Tap* tap_ = nullptr;
};

}  // namespace palpate::device
