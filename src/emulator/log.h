// A CSV log of traffic, faults and the true state, with which tests compare the client's results.
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace emulator {

class Log {
 public:
  // The columns are `time_s,kind,text` and `columns`, which have units in their names. Without a
  // path nothing is logged. Throws InputError if the file cannot be written.
  Log(const std::string& path, std::string_view columns);

  // `kind`: in, out, fault, state and others; `values`: one number per column of `columns`.
  void row(std::int64_t now, std::string_view kind, std::string_view text,
           std::span<const double> values);

 private:
  std::optional<std::ofstream> file_ = {};
};

}  // namespace emulator
