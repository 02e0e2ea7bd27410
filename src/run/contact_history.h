// What the tissue's viscosity makes of the contact forces that its relaxed stiffness gives.
#pragma once

#include <optional>

#include "contact/viscous_contact.h"
#include "run/contacts.h"

namespace palpate::run {

// All contacts together are one press: their elastic forces' sum is phi, and each keeps its part of
// the force that Lee and Radok, or Ting, make of it. Without relaxation nothing changes.
//                                                                         docs/theory.md (64)
class ContactHistory {
 public:
  explicit ContactHistory(const scene::Scene& scene);

  // From now on the finger slides: the contact's force is then what it was, faded as it fades, by
  // the ratio of the elastic force to that of the slide's begin.
  void slide(bool slides) { slides_ = slides; }

  // Takes the touch, with elastic forces, to the end of a step of `time_step` s.
  void pass(const scene::Scene& scene, double time_step, Touch& touch);

  // Whether anything relaxes.
  [[nodiscard]] bool relaxes() const { return contact_.has_value(); }

 private:
  [[nodiscard]] double press(double time_step, double depth, double elastic);

  std::optional<contact::ViscousContact> contact_;
  double shortest_time_ = 0.0;  // s, of the relaxation
  bool slides_ = false;
  double depth_ = 0.0;    // m, of the last step that was no slide
  double elastic_ = 0.0;  // N
};

}  // namespace palpate::run
