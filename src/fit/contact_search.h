// Closed laws of rigid tips on an elastic half-space, and the contact point of a curve of force
// over depth, searched over the whole approach.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpate::fit {

// A rigid axisymmetric or pyramidal tip. Lengths in m, angles in rad.
struct Tip {
  enum class Kind { paraboloid, sphere, cone, pyramid_3, pyramid_4, flat_punch };

  Kind kind = Kind::paraboloid;
  double radius = 0.0;      // m; of curvature, or of the flat end of a punch
  double half_angle = 0.0;  // rad; between the axis and a face or the side of a cone

  [[nodiscard]] bool has_angle() const {
    return kind == Kind::cone || kind == Kind::pyramid_3 || kind == Kind::pyramid_4;
  }
};

// Force for E* = E / (1 - nu^2) = 1 Pa, in N, and its derivative, N/m; both are 0 for h <= 0.
struct TipForce {
  double force, stiffness;
};

// With a the contact radius and E* = 1 Pa:                    docs/theory.md [tips], [tip_sphere]
//   paraboloid  F = 4/3 sqrt(R) h^(3/2)                               Hertz 1881; Sneddon 1965
//   sphere      F = (a^2 + R^2) artanh(a/R) - a R, h = a artanh(a/R)              Sneddon 1965
//   cone        F = 2/pi tan(alpha) h^2                                           Sneddon 1965
//   pyramid_3   F = 0.8887 tan(alpha) h^2                                        Bilodeau 1992
//   pyramid_4   F = 0.7453 tan(alpha) h^2                                        Bilodeau 1992
//   flat_punch  F = 2 R h                                                         Sneddon 1965
[[nodiscard]] TipForce tip_force(const Tip& tip, double depth);

// Hertz's paraboloid against the exact law of a sphere at the same depth, minus 1.
[[nodiscard]] double error_of_hertz(double depth, double radius);

// The words of `--tip`: paraboloid, sphere, cone, pyramid3, pyramid4, punch.
[[nodiscard]] std::string_view word(Tip::Kind kind);
[[nodiscard]] std::optional<Tip::Kind> find_tip(std::string_view word);

// The law as text, with its source: `F = 4/3 E/(1-nu^2) sqrt(R) (h-h_0)^(3/2), Hertz 1881`.
[[nodiscard]] std::string law_text(Tip::Kind kind);

// What is added to the contact force: nothing, a constant force, or a straight line over depth.
enum class Baseline { none, offset, tilt };

// A contact law for E* = 1 Pa; no force at depths of 0 and less.
using UnitLaw = std::function<TipForce(double depth)>;

// Rows of depth (m) and force of order one, of equal number; `low` and `high` bound the depths.
struct PressRows {
  std::vector<double> depth;
  std::vector<double> force;
  double low = 0.0;
  double high = 0.0;

  [[nodiscard]] double range() const { return high - low; }
};

// F = factor f(h - contact) + offset + tilt (h - low) / range
struct ContactGuess {
  double contact = 0.0;  // m
  double factor = 0.0;   // E* in Pa, divided by the scale of the force
  double offset = 0.0;
  double tilt = 0.0;
  double squares = 0.0;    // sum of squared residuals
  double straight = 0.0;   // the same of the baseline without contact
  std::size_t before = 0;  // rows before the contact point
};

// The least-squares fit over all contact points: for each of 400 the rest is linear and solved for,
// and the best is refined by Brent's method. Without a baseline the contact may lie up to one
// range before the first row, otherwise it lies within the rows. More than 4000 rows are averaged
// to 2000 for the search. Nothing if no contact point serves. This is the search by goodness of fit
// of Lin, Dimitriadis and Horkay 2007, J. Biomech. Eng. 129, with the baseline as a part of the
// model.                        docs/theory.md [contact_point]
struct SearchLimits {
  double deepest;           // largest depth of the law, m
  bool within_rows = true;  // the contact lies within the rows wherever there is a baseline
  std::optional<double> fixed = {};  // m, the known contact point
};
[[nodiscard]] std::optional<ContactGuess> search_contact(const UnitLaw& law, const PressRows& rows,
                                                         Baseline baseline,
                                                         const SearchLimits& limits);

// The contact point and the baseline that the rows support. The hypotheses of no baseline, an
// offset and a tilt are compared by n ln(SSE / n) + k ln n (Schwarz 1978, Ann. Stat. 6). Where the
// rows before contact determine a tilt (ten over a fifth of the depth in contact, whose own slope
// agrees with it), offset and tilt are fitted; where three of them do not rise, an offset; else
// neither.                                                               docs/theory.md [baseline]
struct ContactChoice {
  Baseline baseline = Baseline::none;
  ContactGuess guess;
  std::vector<std::pair<Baseline, double>> others = {};  // the factors with other baselines
};
[[nodiscard]] std::optional<ContactChoice> choose_contact(const UnitLaw& law, const PressRows& rows,
                                                          const SearchLimits& limits);

}  // namespace palpate::fit
