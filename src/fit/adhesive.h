// Adhesion: JKR's and DMT's laws of a sphere, fitted to a curve with its pull-off.
#pragma once

#include <span>

#include "fit/contact_model.h"
#include "fit/regression.h"

namespace palpate::fit {

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

// Fits the way back of a curve of depth (m) and force (N), or its approach (test.way), with one
// row of the pull-off: rows in contact follow the law, rows after it the baseline, which is an
// offset where three rows are free (none, and a tilt, on request). Parameters: E in kPa, w in
// mJ/m^2, h_0 in mm, F_0 in N, tilt in N/mm. `by_tabor` takes JKR above mu = 0.7, in the middle of
// the transition from 0.1 to 5 on a logarithmic scale, and says so.  docs/theory.md [jkr], [tabor]
// Throws InputError for a curve without a pull-off clear of its scatter, and like fit_contact().
[[nodiscard]] Fit fit_adhesive(std::span<const double> depth, std::span<const double> force,
                               const ContactTest& test, const AdhesiveTest& adhesion);

}  // namespace palpate::fit
