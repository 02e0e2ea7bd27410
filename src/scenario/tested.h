// What a case tests, in the words of its pages.
#pragma once

#include <string>
#include <vector>

#include "scenario/family.h"

namespace palpate::scenario {

// What is known only after a run; empty texts are made of the scenario or missing.
struct Touched {
  std::string depth = {};  // `2 mm`
  std::string place = {};  // ` at x 30, y 30, z 30 mm`, behind the finger
};

// The parts of a sentence, to be joined by `; `: the tissue, its shape, its regions, and what the
// finger does or the loading between plates: `Tissue: skin, E 72.4 kPa, nu 0.33`, `block of
// 60 x 60 x 30 mm`, `region 1: muscle, E 6 kPa`, `pressed 2 mm by a sphere of radius 11 mm, then
// held for 1 s`. What one of the keys `varied` changes is not said.
[[nodiscard]] std::vector<std::string> tested(const Case& one,
                                              const std::vector<std::string>& varied = {},
                                              const Touched& touched = {});

}  // namespace palpate::scenario
