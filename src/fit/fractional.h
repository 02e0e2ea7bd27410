// Spring-pots and the fractional Zener model: relaxation and creep by powers of time.
#pragma once

#include <span>

#include "fit/regression.h"

namespace palpate::fit {

enum class Fractional {
  spring_pot,        // y = c x^-beta / Gamma(1 - beta), relaxation
  spring_pot_creep,  // y = J x^beta / Gamma(1 + beta), creep
  zener,             // y = y_inf + (y_0 - y_inf) E_beta(-(x/tau)^beta), relaxation and creep
};

// E_alpha(-z) for z >= 0 and 0 < alpha <= 1, Mittag-Leffler's function, to about 1e-12: the inverse
// Laplace transform of s^(alpha-1) / (s^alpha + z) at 1 on a parabola.
//                 Garrappa 2015, SIAM J. Numer. Anal. 53; Weideman and Trefethen 2007, Math. Comp.
//                 76
[[nodiscard]] double mittag_leffler(double alpha, double z);

// Least squares as in regress(), after a step at options.x_origin. Parameters: c or J, and beta;
// y_inf, y_0, tau and beta. The exponent is between 0 and 1: a spring and a dashpot. Points at the
// step and before are excluded. Throws InputError for fewer points than parameters + 1.
//      docs/theory.md [spring_pot], [zener]; Mainardi 2010, Fractional calculus and waves, ch. 3
[[nodiscard]] Fit fit_fractional(std::span<const double> x, std::span<const double> y,
                                 Fractional model, const Options& options = {});

}  // namespace palpate::fit
