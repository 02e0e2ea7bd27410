// The programme as guidance: what a hand is asked to do, and which step of it a moment belongs to.
#pragma once

#include <string>
#include <vector>

#include "base/vec3.h"
#include "scenario/scenario.h"

namespace palpate::run {

// Where the finger is, as the model sees it.
struct GuidePlace {
  double time = 0.0;           // s
  Vec3 offset = Vec3::Zero();  // m, from the first touch, z upwards
  double force = 0.0;          // N
};

class Guide {
 public:
  // `steps` outlive the guide; none is a creep or a relaxation.
  explicit Guide(const std::vector<scenario::Step>& steps) : steps_(&steps) {}

  // A moment: an `indent` is over at its travel or force, a `hold` after its time, a `retract` at
  // its travel, a `slide` after its way. At most one step ends in a moment. Allocates nothing.
  void pass(const GuidePlace& place);

  [[nodiscard]] int step() const { return step_; }  // counted from 1; of the last one at the end
  [[nodiscard]] bool done() const { return done_; }

 private:
  [[nodiscard]] bool is_over(const GuidePlace& place) const;

  const std::vector<scenario::Step>* steps_;
  int step_ = 1;
  bool done_ = false;
  bool any_ = false;
  GuidePlace begin_;  // of the step
};

// What a hand is to do: "press to 2 mm at about 5 mm/s".
[[nodiscard]] std::string guidance(const scenario::Step& step);

}  // namespace palpate::run
