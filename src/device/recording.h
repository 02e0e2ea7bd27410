// A recorded run as a link: the same samples at the same times, every time.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "device/clock.h"
#include "device/sample.h"

namespace palpate::device {

// Reads a recording: a CSV with one header row, a column `time_s` that never falls, a position as
// `position_x_m`, `position_y_m`, `position_z_m` or as `travel_mm` (downwards, as in
// force_indentation.csv), and `force_N` where force was measured; other columns are passed over.
// Throws InputError with file:line.
[[nodiscard]] std::vector<Sample> parse_recording(std::string_view text, const std::string& file);

class Recording {
 public:
  // `clock` outlives the link; a stepped one is carried on to each sample's time.
  Recording(const std::string& file, Clock& clock);

  [[nodiscard]] const Identity& identity() const { return identity_; }
  [[nodiscard]] const Limits& limits() const { return limits_; }
  [[nodiscard]] Traffic traffic() const { return traffic_; }

  // The next row once its time has come, counted from the first call; waits `wait` s for it at
  // most. Each row comes once; after the last one the link is lost, recording_ended.
  [[nodiscard]] Sample sample(double wait);

 private:
  Clock& clock_;
  Identity identity_;
  Limits limits_;
  Traffic traffic_;
  std::vector<Sample> rows_;
  std::size_t next_ = 0;
  double start_ = 0.0;  // s, when the first row's time was 0
};

}  // namespace palpate::device
