// Converts elastic contact forces (of relaxed tissue) to the forces of viscoelastic tissue.
#pragma once

#include <optional>

#include "contact/viscous_contact.h"
#include "mechanics/contacts.h"

namespace palpate::mechanics {

// Treats all contacts as one press, theory.md [viscous]: phi is the sum of their elastic forces,
// Lee and Radok's or Ting's integral gives the total force, and each contact keeps its proportion.
// Forces on elastic tissue are not changed.
class ContactHistory {
 public:
  explicit ContactHistory(const scene::Scene& scene);

  // Begins (true) or ends a slide. During a slide the force relaxes as at constant depth and is
  // multiplied by the elastic force divided by the elastic force at the beginning of the slide.
  void slide(bool slides) { slides_ = slides; }

  // Advances by `time_step` (s). On entry the contacts of `touch` have the elastic forces at the
  // end of the step; on return the viscoelastic ones. Removes all contacts if the force is zero.
  void pass(const scene::Scene& scene, double time_step, Touch& touch);

  // Whether the tissue is viscous.
  [[nodiscard]] bool relaxes() const { return contact_.has_value(); }

 private:
  [[nodiscard]] double press(double time_step, double depth, double elastic);

  std::optional<contact::ViscousContact> contact_;
  double shortest_time_ = 0.0;  // s, of all branches, or the retardation time
  bool slides_ = false;
  double depth_ = 0.0;    // m, largest approach at the end of the last step before a slide
  double elastic_ = 0.0;  // N, sum of the elastic forces then
};

}  // namespace palpate::mechanics
