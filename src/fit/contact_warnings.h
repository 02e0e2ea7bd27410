// What limits the result of a contact fit: the law, the depth, the baseline, the residuals.
#pragma once

#include "fit/contact_model.h"
#include "fit/contact_search.h"

namespace palpate::fit {

// A finished fit with the sizes that its warnings depend on.
struct ContactResult {
  const ContactTest& test;
  Baseline baseline;
  double deepest = 0.0;    // m, below the contact point
  std::size_t before = 0;  // rows before the contact point
  std::size_t beyond = 0;  // rows beyond it
  double drift = 0.0;      // rise of the tilt over all rows, as a share of the contact force
};

// Adds sentences to fit.warnings: few rows in contact, no rows before contact, a tilt as large as
// the contact force, a tip deeper than its radius, the error of Hertz's law at the deepest row.
void warn_of_contact(Fit& fit, const ContactResult& result);

// Adds sentences on R^2 below 0.9, correlated residuals and an end of the search without a minimum.
void warn_of_residuals(Fit& fit);

}  // namespace palpate::fit
