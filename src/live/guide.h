// Guides a person at the arm through the loading history: instructions, and the step being carried
// out.
#pragma once

#include <string>
#include <vector>

#include "base/vec3.h"
#include "scenario/scenario.h"

namespace palpate::live {

// State of the finger at one moment.
struct GuidePlace {
  double time = 0.0;           // s
  Vec3 offset = Vec3::Zero();  // m, from the first touch, z upwards
  double force = 0.0;          // N, computed by the model, upwards on the finger
};

class Guide {
 public:
  // `steps` outlive the guide and contain no creep or relaxation.
  explicit Guide(const std::vector<scenario::Step>& steps) : steps_(&steps) {}

  // Advances to a moment, without allocation. An `indent` ends at its travel or force, a `hold`
  // after its time, a `retract` at its travel, a `slide` after its distance; one step per call.
  void pass(const GuidePlace& place);

  [[nodiscard]] int step() const { return step_; }  // counted from 1; at the end, the last one
  [[nodiscard]] bool done() const { return done_; }

 private:
  [[nodiscard]] bool is_over(const GuidePlace& place) const;

  const std::vector<scenario::Step>* steps_;
  int step_ = 1;
  bool done_ = false;
  bool any_ = false;
  GuidePlace begin_;  // at the start of the step
};

// The instruction for a step: "press to 2 mm at about 5 mm/s".
[[nodiscard]] std::string guidance(const scenario::Step& step);

}  // namespace palpate::live
