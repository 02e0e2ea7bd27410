// Files that the emulator reads and writes: TOML tables, read by the `fields` of the structs that
// they fill, and a CSV log of traffic, faults and the true state, with which tests compare the
// results.
#pragma once

#include <cstdint>
#include <fstream>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/document.h"
#include "base/fields.h"

namespace emulator {

using palpate::at_least;
using palpate::FieldVisitor;
using palpate::InputError;
namespace unit = palpate::unit;

// Reads a file by `fields` and returns its document, so that checks of several keys can name a
// place. Throws InputError if the file is missing, invalid, or has unknown keys or wrong values.
palpate::Node read_settings(const std::string& path, const palpate::Fields& fields);

// Throws InputError with `sentence` and the place of the key `path` (dotted).
[[noreturn]] void refuse(const palpate::Node& file, const std::string& path,
                         const std::string& sentence);

// Refuses `waypoint` tables whose times `at` (s) do not ascend from above 0.
template <class Point>
void refuse_unordered(const palpate::Node& file, const std::vector<Point>& points) {
  double last = 0.0;
  for (std::size_t i = 0; i < points.size(); last = points[i++].at)
    if (points[i].at <= last)
      refuse(file, "waypoint." + std::to_string(i + 1) + ".at",
             "`at` must be later than that of the waypoint before; give a later time");
}

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
