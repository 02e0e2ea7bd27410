// What a sweep will take, from running a few of its cases.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "scenario/family.h"

namespace palpate::sweep {

struct SweepForecast {
  std::size_t cases = 0;
  double seconds = 0.0;  // of processor time, on one worker
  double bytes = 0.0;    // of rows, without curves
  double memory = 0.0;   // bytes, that one worker's process takes at most
  bool curves = false;

  [[nodiscard]] std::string text() const;  // about 12 s on one worker and 2.4 MB
};

// The number of different set-ups that a family's cases share, from evenly chosen cases. A modulus
// of the only tissue scales a set-up; without a mesh it depends on the tissues alone.
[[nodiscard]] double set_ups(const scenario::Family& family, bool meshed);

// Runs some neighbouring cases for up to about two seconds: once with all that cases share, and
// once without. Nothing if a case is invalid or fails.
[[nodiscard]] std::optional<SweepForecast> forecast(const scenario::Family& family,
                                                    bool keeps_curves);

}  // namespace palpate::sweep
