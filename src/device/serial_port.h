// A serial line for one program alone: raw bytes, 8N1, no flow control, never waiting unasked.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace palpate::device {

class Tap;

class SerialPort {
 public:
  // Opens and locks `path` at `baud` (only 9600 to 115200 of the usual rates). Throws LinkError
  // with a sentence: no such port, no permission, no serial line, held by another program.
  SerialPort(const std::string& path, int baud);
  ~SerialPort();
  SerialPort(SerialPort&& other) noexcept;
  SerialPort& operator=(SerialPort&&) = delete;

  // True where all bytes were taken; false where the line is gone or its queue full.
  bool write(std::string_view bytes);

  enum class Outcome { bytes, nothing, lost };
  struct Read {
    Outcome outcome = Outcome::nothing;
    std::size_t size = 0;
  };
  // Waits for bytes till `until` (s, wire_time) and takes those that are there.
  [[nodiscard]] Read read(std::span<char> into, double until);

  // From now on it hears all that is written and read; null: nobody.
  void tap(Tap* tap) { tap_ = tap; }

  void discard_input();
  [[nodiscard]] bool lost() const { return lost_; }
  [[nodiscard]] int descriptor() const { return file_; }

 private:
  void release();

  int file_ = -1;
  int lock_ = -1;
  bool lost_ = false;
  Tap* tap_ = nullptr;
};

}  // namespace palpate::device
