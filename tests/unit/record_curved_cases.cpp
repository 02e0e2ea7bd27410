// Contact on curved tissue and the paper's curvature against independent numbers: ellipse, curv.
#include <gtest/gtest.h>

#include <cmath>

#include "cases.h"
#include "contact/hertz.h"
#include "geometry/curvature.h"
#include "test_surfaces.h"

namespace palpate {
namespace {

using test::expect_case;

// F_exact over the force of a sphere, for A/B: forces go with the square root of the radius.
struct Ratios {
  double mean, geometric;
};
Ratios ratios(double a_over_b) {
  const double kappa = 1.0 / a_over_b - 1.0;  // on a sphere of radius 1, flat the other way
  const double radius = contact::elliptic_law(1.0, kappa, 0.0).value().force_radius;
  const double exact = contact::hertz::force(1e-3, radius, 1.0);
  return {exact / contact::hertz::force(1e-3, contact::mean_radius(1.0, kappa, 0.0), 1.0),
          exact / contact::hertz::force(1e-3, contact::geometric_radius(1.0, kappa, 0.0), 1.0)};
}

TEST(EllipseCases, ForceOverThatOfOneRadius) {
  expect_case("ellipse-01", ratios(0.8).mean);
  expect_case("ellipse-02", ratios(0.8).geometric);
  expect_case("ellipse-04", ratios(0.5).geometric);
  expect_case("ellipse-05", ratios(1.0 / 3.0).mean);
  expect_case("ellipse-07", ratios(0.2).mean);
  expect_case("ellipse-08", ratios(0.2).geometric);
}

TEST(CurvatureCases, VotingOnARotatedGrid) {
  const auto patch = test::rotated_patch(1e-3, std::numbers::pi / 6.0);
  const geometry::CurvatureStars stars(patch.surface, geometry::Neighbours(patch.surface),
                                       {.method = geometry::CurvatureMethod::taubin, .rings = 1});
  const auto found = stars.at_vertex(patch.surface, patch.middle);
  ASSERT_EQ(found.status, geometry::StarStatus::full);
  expect_case("curv-03", 0.5 * (found.curvature.kappa_1 + found.curvature.kappa_2));
}

}  // namespace
}  // namespace palpate
