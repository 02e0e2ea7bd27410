// A pseudo-terminal in place of a serial port.
#pragma once

#include <string>

namespace emulator {

class Pty {
 public:
  // Opens a pair, raw, at `baud`; a `link` that is not empty becomes a symbolic link to the port.
  // Throws InputError if the pair cannot be opened, `baud` is unknown, or `link` is another file.
  Pty(int baud, const std::string& link);
  ~Pty();
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  [[nodiscard]] int descriptor() const { return master_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  // Whether the port still has the rate with which it was opened.
  [[nodiscard]] bool same_rate() const;
  [[nodiscard]] std::string read_all() const;
  // Whether the client has read all that was written.
  [[nodiscard]] bool is_read() const;
  // Returns the number of bytes that were accepted.
  [[nodiscard]] std::size_t write_some(const std::string& bytes) const;

 private:
  int baud_;
  std::string link_;
  std::string path_ = {};
  int master_ = -1;
  int slave_ = -1;  // kept open, so that clients can disconnect and reconnect
};

}  // namespace emulator
