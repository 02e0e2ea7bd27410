// What went over the line and what the tissue and the hand truly did: a CSV for tests to judge by.
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace emulator {

// Printable ASCII as it is, the rest as \r, \n, \\ or \xHH.
[[nodiscard]] std::string escaped(std::string_view bytes);

class Log {
 public:
  // Columns `time_s,kind,text` and those given, units in their names. No path: no log.
  // Throws `Refused` where the file cannot be written.
  Log(const std::string& path, std::string_view columns);

  // kind: in, out, fault, state. `values` has as many numbers as columns were given.
  void row(std::int64_t now, std::string_view kind, std::string_view text,
           std::span<const double> values);

 private:
  std::optional<std::ofstream> file_ = {};
};

}  // namespace emulator
