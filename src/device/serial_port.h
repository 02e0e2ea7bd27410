// A serial line used by one program only: raw bytes, 8N1, no flow control, non-blocking.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace palpate::device {

class Tap;

class SerialPort {
 public:
  enum class Use { alone, shared };  // shared: for a stop, whoever has the port
  // Opens `path` at `baud`: 9600, 19200, 38400 or 57600; any other value means 115200. Locks it for
  // Use::alone. Throws LinkError if the port does not exist, is not permitted, not a serial line,
  // or in use.
  SerialPort(const std::string& path, int baud, Use use = Use::alone);
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
