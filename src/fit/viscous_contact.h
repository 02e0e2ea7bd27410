// A rigid sphere on a viscoelastic half-space: the modulus as a function of time, and the contact.
#pragma once

#include <span>

#include "fit/contact_model.h"
#include "fit/regression.h"

namespace palpate::fit {

// E(t) of the tissue after a step of strain, t in s.
enum class Viscous {
  power_law,  // E_1 (t / 1 s)^-beta
  solid,      // E_inf + (E_0 - E_inf) e^(-t/tau), a standard linear solid
};

// Fits depth (m) and force (N) over ascending time (s) by Boltzmann's superposition,
//   F(t) = 4 sqrt(R) / (3 (1-nu^2)) int_0^t1 E(t-s) d(h^(3/2))/ds ds,
// where t1 = t while the contact grows (Lee and Radok 1960, J. Appl. Mech. 27), and on the way back
// the earlier time of the same contact, int_t1^t E(t-s) dh/ds ds = 0 (Ting 1966, J. Appl. Mech.
// 33). The approach is fitted, with `test.way` = all both ways. Parameters: E_1 (kPa) and beta, or
// E_inf, E_0 (kPa) and tau (s); then h_0 in mm and F_0 in N where three rows lie before contact or
// an offset is asked for. More than 400 rows are averaged to 400 for the history; the force between
// these is linear. Throws InputError like fit_contact(), and for times that do not ascend.
//                                                                            docs/theory.md [ting]
[[nodiscard]] Fit fit_viscous(std::span<const double> time, std::span<const double> depth,
                              std::span<const double> force, const ContactTest& test,
                              Viscous model);

}  // namespace palpate::fit
