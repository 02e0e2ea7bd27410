// A recorded run as a link, which returns the same samples at the same times in every run.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "device/clock.h"
#include "device/sample.h"

namespace palpate::device {

// Reads a recording: CSV text with one header row, a column `time_s` that never decreases, the
// position as `position_x_m`, `position_y_m`, `position_z_m` or as `travel_mm` (positive downwards,
// as in force_indentation.csv), and `force_N` if force was measured; other columns are ignored.
// Velocities are differences of the rows. Throws InputError with file and line.
[[nodiscard]] std::vector<Sample> parse_recording(std::string_view text, const std::string& file);

class Recording {
 public:
  // `clock` must outlive the link; a stepped clock is advanced to the time of each sample.
  Recording(const std::string& file, Clock& clock);

  static bool stop() { return true; }  // nothing moves

  [[nodiscard]] const Identity& identity() const { return identity_; }
  [[nodiscard]] const Limits& limits() const { return limits_; }
  [[nodiscard]] Traffic traffic() const { return traffic_; }

  // Returns each row once, when its time since the first row has passed since the first call; waits
  // for that at most `wait` s. After the last row the link is lost with recording_ended.
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
