// A pseudo-terminal that plays the serial port.
#pragma once

#include <string>

namespace emulator {

class Pty {
 public:
  // Opens a pair, raw, 8N1 at `baud`; `link` is made to point to it where it is not empty.
  // Throws `Refused` where there is no pair, no such rate, or something else stands at `link`.
  Pty(int baud, const std::string& link);
  ~Pty();
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  [[nodiscard]] int descriptor() const { return master_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  // Whether the other side still has the rate that was set.
  [[nodiscard]] bool same_rate() const;
  [[nodiscard]] std::string read_all() const;
  // How many of the bytes the line took.
  [[nodiscard]] std::size_t write_some(const std::string& bytes) const;

 private:
  int baud_;
  std::string link_;
  std::string path_ = {};
  int master_ = -1;
  int slave_ = -1;  // held open, so that a client may come and go
};

}  // namespace emulator
