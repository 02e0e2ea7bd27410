// Fits relaxation and creep: with a sum of exponentials (Prony series), under the loading history
// of the test, and with spring-pots and the fractional Zener model, by powers of time.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "fit/regression.h"

namespace palpate::fit {

// Strain (relaxation) or stress (creep) over time, as a share of its largest value.
struct LoadingHistory {
  double ramp = 0.0;  // duration of a ramp at constant rate from 0; 0: a step
  std::vector<double>
      samples;  // one per point, linear between them and 0 before; instead of a ramp

  [[nodiscard]] bool step() const { return ramp == 0.0 && samples.empty(); }
};

// One term at all points and its derivative with respect to ln tau.
struct BasisColumn {
  std::vector<double> value, slope;
};

// phi(t) = integral from 0 to t of e^(-(t-s)/tau) dH/ds ds, Boltzmann's superposition of the
// history H, for the times `t` in ascending order from the start of the loading. Step: e^(-t/tau).
// Ramp of duration T: tau/T (1 - e^(-t/tau)), and from T on tau/T (e^(-(t-T)/tau) - e^(-t/tau)).
//                                                                            docs/theory.md [ramp]
[[nodiscard]] BasisColumn relaxing(std::span<const double> t, double tau,
                                   const LoadingHistory& history);

// H at the times: 1 for a step.
[[nodiscard]] std::vector<double> loading(std::span<const double> t, const LoadingHistory& history);

struct PronySeries {
  enum class Kind {
    relaxation,  // y = y_inf + sum_k y_k e^(-x/tau_k)
    creep,       // y = y_0 + sum_k y_k (1 - e^(-x/tau_k))
  };
  Kind kind = Kind::relaxation;
  int terms = 2;                // 1 to 5 with free times; above, the times are given
  bool liquid = false;          // relaxation to 0; creep that goes on: y_flow times the time
  LoadingHistory history = {};  // with a ramp, phi_k(x) of relaxing() replaces e^(-x/tau_k)
};

constexpr int most_free_terms = 5;
constexpr int most_terms = 60;

// Least squares as in regress(). Parameters: y_inf (or y_0), then y_k and tau_k > 0 in the order of
// increasing tau. A liquid has no y_inf in relaxation, and in creep y_flow after y_0, the rate of
// y_0 + y_flow int H dx + sum (Burgers 1935 with one term). Intervals are Student's, that of tau
// from the error of ln tau, docs/theory.md [prony]. With more than 5 terms, the times are spaced
// evenly in their logarithm from the distance of two points to the length of the record, and the
// y_k >= 0 follow by non-negative least squares, without intervals; terms of 0 are excluded. Values
// refer to the largest of the history. Throws InputError for fewer than 2 * terms + 2 usable points
// (terms + 2 if the times are given), if all x are equal, and for a history whose times do not
// ascend.
[[nodiscard]] Fit fit_prony(std::span<const double> x, std::span<const double> y,
                            const PronySeries& series, const Options& options = {});

// The x >= 0 that minimises |A x - b|, by the active set of Lawson and Hanson, Solving Least
// Squares Problems, 1974, chapter 23. `a` has at least as many rows as columns. Nothing if the
// active set has not settled after 3 changes per column.
[[nodiscard]] std::optional<Eigen::VectorXd> nonnegative_least_squares(const Eigen::MatrixXd& a,
                                                                       const Eigen::VectorXd& b);

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
