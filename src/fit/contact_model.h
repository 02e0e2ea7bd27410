// Fits a tip's force over its depth: the tissue's Young's modulus and the contact point, searched
// over the whole approach, by closed laws of rigid tips on an elastic half-space; with adhesion, by
// JKR's and DMT's laws of a sphere; and on a viscoelastic half-space, the modulus as a function of
// time.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/units.h"
#include "contact/layer.h"
#include "fit/parts.h"
#include "fit/regression.h"

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
// `, with a force offset`, behind the formula of a law.
[[nodiscard]] std::string with_baseline(Baseline baseline);

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

// A depth below the contact point: a length (m), or a share of the largest depth.
struct DepthLimit {
  double value = 0.0;
  bool share = false;
};

// The known quantities of a test with a rigid tip, and the part of the curve that is fitted.
struct ContactTest {
  double radius = 0.0;                   // of the sphere or the punch, m
  double poisson_ratio = 0.5;            // of the tissue, 0 to 1/2
  std::optional<double> thickness = {};  // m, of a layer on a rigid base; none: a half-space
  contact::LayerBase base = contact::LayerBase::bonded;
  Tip::Kind tip = Tip::Kind::paraboloid;  // of a half-space; a layer is pressed by a paraboloid
  double half_angle = 0.0;                // rad, of cones and pyramids

  enum class BaselineChoice { automatic, none, offset, tilt };
  BaselineChoice baseline = BaselineChoice::automatic;
  std::optional<double> baseline_from = {};  // m: of the rows before contact, only those from here
  std::optional<double> baseline_to = {};    // to here count
  std::optional<double> contact_point = {};  // m, known; none: fitted
  std::optional<DepthLimit> from = {};
  std::optional<DepthLimit> to = {};
  using Way = fit::Way;
  Way way = Way::approach;
  Residuals residuals = Residuals::independent;
  // m/N, of a cantilever whose bending was taken off the depth; 0: none. The tilt of its baseline
  // is light from elsewhere and bends nothing.
  double bending = 0.0;
};

// Fits F = E/(1 - nu^2) f(h - h_0) + F_0 + k (h - h_min) to `depth` (m) and `force` (N) of equal
// size, where f is the law of the tip or of a paraboloid on a finite layer
// (contact/layer.h), 0 before contact. Parameters: E in kPa, h_0 in mm and, if there is a
// baseline, F_0 in N and k in N/mm; ranges in mm, rmse in N. `automatic` fits an offset where three
// rows lie before contact, and a tilt where ten do. Of a curve that goes in and out, `way` is
// fitted. A known contact point is no parameter. Points that are not used are counted, and named in
// the notes.
// Throws InputError for fewer than 4 points, for fewer than 3 beyond the contact point, for a
// single depth, for a curve in which the load does not grow with depth or that shows no contact,
// and for data deeper than the law of a thin layer permits.
// docs/theory.md [layer], [tips], [tip_sphere], [contact_point]
[[nodiscard]] Fit fit_contact(std::span<const double> depth, std::span<const double> force,
                              const ContactTest& test);

enum class Adhesion { by_tabor, jkr, dmt };

// Force (N) of a sphere of radius R (m) on E* (Pa) with the work of adhesion w (J/m^2) at a depth
// (m), and its derivatives. JKR's stable branch ends at a depth of -3 a_c^2 / R, where the contact
// opens; beyond it the force stays that of the end, and so does DMT's at depths below 0.
//   jkr  h = a^2/R - sqrt(2 pi a w / E*),  F = 4 E* a^3 / (3 R) - sqrt(8 pi w E* a^3)
//                                      Johnson, Kendall & Roberts 1971, Proc. R. Soc. Lond. A 324
//   dmt  F = 4/3 E* sqrt(R) h^(3/2) - 2 pi R w   Derjaguin, Muller & Toporov 1975, J. Colloid 53
struct AdhesiveForce {
  double force = 0.0;  // N
  double by_modulus = 0.0, by_work = 0.0, by_depth = 0.0;
};
[[nodiscard]] AdhesiveForce adhesive_force(Adhesion law, double radius, double modulus, double work,
                                           double depth);

// mu = (R w^2 / (E*^2 z_0^3))^(1/3), z_0 (m) the distance of atoms at rest.  docs/theory.md [tabor]
//                                                      Tabor 1977, J. Colloid Interface Sci. 58
[[nodiscard]] double tabor_number(double radius, double modulus, double work, double distance);

struct AdhesiveTest {
  Adhesion law = Adhesion::by_tabor;
  double distance = 0.3e-9;  // m, z_0
};

inline constexpr const char* no_force = "the force is 0 at every point; name another `--y`";

// Fits the way back of a curve of depth (m) and force (N), or its approach (test.way), with one
// row of the pull-off: rows in contact follow the law, rows after it the baseline, which is an
// offset where three rows are free (none, and a tilt, on request). Parameters: E in kPa, w in
// mJ/m^2, h_0 in mm, F_0 in N, tilt in N/mm. `by_tabor` takes JKR above mu = 0.7, in the middle of
// the transition from 0.1 to 5 on a logarithmic scale, and says so.  docs/theory.md [jkr], [tabor]
// Throws InputError for a curve without a pull-off clear of its scatter, and like fit_contact().
[[nodiscard]] Fit fit_adhesive(std::span<const double> depth, std::span<const double> force,
                               const ContactTest& test, const AdhesiveTest& adhesion);

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
