// The settings of a gauge on a serial line: a TOML file.
#pragma once

#include <optional>
#include <string>

#include "device/line_pattern.h"
#include "device/serial_port.h"

namespace palpate::device {

struct LineSettings {
  LineFormat line = {.baud = 9600};
  std::string pattern = {};
  LinePattern::Decimal decimal = LinePattern::Decimal::point;
  // Words of line_pattern.h, for what the pattern takes no unit from.
  std::string force_unit = {};
  std::string travel_unit = {};
  std::string time_unit = {};
  double force_zero = 0.0;   // as written in the lines, subtracted first
  double force_scale = 1.0;  // negative if the lines show compression as negative
  enum class Towards { down, up };
  Towards travel = Towards::down;  // where the travel in the lines increases
  std::string poll = {};           // sent for every reading; empty: the gauge sends by itself
  std::string start = {};          // sent after the port was opened
  std::string stop = {};           // sent before the port is closed
  double rate = 10.0;              // readings per second, that are sent or asked for
  double wait = 3.0;               // s, for the first line
  std::optional<double> start_force = {};  // N, with which a run without travel begins
};

// Reads the file. Throws InputError with the place of what is wrong, also of a pattern or a unit.
[[nodiscard]] LineSettings read_line_settings(const std::string& path);

}  // namespace palpate::device
