// Several layers on each other: as one where they are alike, and where one of them is rigid.

#include <gtest/gtest.h>

#include <cmath>

#include "contact/layer.h"
#include "layer_at_chi.h"

namespace palpate::contact {
namespace {

constexpr LayerBase bases[] = {LayerBase::bonded, LayerBase::frictionless};

Layer alike(double nu, LayerBase base) {
  return {.poisson_ratio = nu, .base = base, .below = {{0.3, 1.0, nu}, {0.5, 1.0, nu}}};
}

// A skin of 3 of 20 mm on what is `stiffness` times as stiff.
Layer surface_on(double stiffness, double nu_below = 0.45) {
  return {.poisson_ratio = 0.45, .below = {{0.85, stiffness, nu_below}}};
}

TEST(LayerStack, OfOneTissueIsOneLayer) {
  for (const LayerBase base : bases)
    for (const double nu : {0.0, 0.33, 0.5}) {
      const Layer one{.poisson_ratio = nu, .base = base};
      for (const double ratio : {0.05, 0.3, 1.0}) {
        const LayerSolution want = test::solve_layer(ratio, one);
        const LayerSolution got = test::solve_layer(ratio, alike(nu, base));
        // 9e-8: what the four waves leave near u = 0.
        EXPECT_NEAR(got.depth, want.depth, 2e-7) << nu << " " << ratio;
        EXPECT_NEAR(got.force, want.force, 2e-7) << nu << " " << ratio;
        EXPECT_NEAR(got.punch, want.punch, 2e-7) << nu << " " << ratio;
      }
    }
}

// On what does not yield the top layer is alone.
TEST(LayerStack, OnARigidLayerIsTheTopOne) {
  for (const double nu : {0.1, 0.45, 0.5}) {
    const Layer top{.poisson_ratio = nu};
    for (const Layer& stack :
         {Layer{.poisson_ratio = nu, .below = {{0.6, 1e9, 0.3}}},
          Layer{.poisson_ratio = nu, .below = {{0.4, 1e9, 0.3}, {0.2, 1e9, 0.2}}},
          Layer{.poisson_ratio = nu, .base = LayerBase::frictionless, .below = {{0.6, 1e9, 0.3}}}})
      for (const double ratio : {0.1, 0.5, 1.5})  // a over the top layer, 0.4 H
        EXPECT_NEAR(test::solve_layer(0.4 * ratio, stack).force_factor() /
                        test::solve_layer(ratio, top).force_factor(),
                    1.0, 1e-7)
            << nu << " " << ratio;
  }
}

// A small contact feels the top alone, and at once whether it lies on something softer or stiffer.
TEST(LayerStack, SofterBelowIsSofter) {
  double before = 0.0;
  for (const double stiffness : {0.1, 0.3, 1.0, 3.0, 10.0}) {
    const double factor = LayerLaw(surface_on(stiffness)).force_factor(0.16);
    EXPECT_GT(factor, before) << stiffness;
    before = factor;
    EXPECT_NEAR(LayerLaw(surface_on(stiffness)).force_factor(1e-6), 1.0, 1e-4) << stiffness;
  }
  EXPECT_LT(LayerLaw(surface_on(0.1)).force_factor(0.16), 0.7);
  EXPECT_LT(test::layer_first_coefficient(surface_on(0.1)), 0.0);
}

// Skins that bend on a base 200 to 400 times softer: by LayerEquation, and the force on 20 mm of
// 5 kPa under 0.1 mm of 2000 kPa, pressed 0.2 mm by a sphere of 6 mm, which a program with finite
// elements over the depth for each wave number and Hayes's equation has at 2.18 mN.
TEST(LayerStack, StiffSkinsFollowTheEquation) {
  const auto skin = [](double thickness, double below, double stiffness) {
    return Layer{.poisson_ratio = 0.45,
                 .below = {{below / (below + thickness), 1.0 / stiffness, 0.45}}};
  };
  for (const Layer& layer : {skin(0.1, 20.0, 400.0), skin(0.1, 10.0, 200.0), skin(0.5, 20.0, 400.0),
                             skin(1.0, 20.0, 200.0)}) {
    const LayerLaw law(layer);
    for (const double part : {0.01, 0.1, 0.3, 0.6, 0.95}) {
      const double chi = part * law.last_chi();
      const LayerEquation equation(layer, {.points = 120, .waves = 700});
      const double exact = equation.force_factor(chi);
      EXPECT_NEAR(law.force_factor(chi) / exact, 1.0, 2e-5) << layer.top() << " " << chi;
    }
  }
  const LayerContact contact{6e-3, 2e6 / (1.0 - 0.45 * 0.45), 20.1e-3,
                             LayerLaw(skin(0.1, 20.0, 400.0))};
  EXPECT_NEAR(contact.force(0.2e-3), 2.18e-3, 0.005e-3);
}

// A long rule is made of pieces.
TEST(LayerStack, ALongSumOverWavesIsThatOfAShortOne) {
  const Layer layer = surface_on(0.1);
  const auto sum = [&](int count) {
    double all = 0.0;
    for (const LayerWave& wave : layer_waves(layer, count))
      all += wave.missing * std::cos(0.7 * wave.number);
    return all;
  };
  EXPECT_NEAR(sum(9000) / sum(2000), 1.0, 1e-9);
}

// 1e-5, as the header says.
TEST(LayerStack, TheLawFollowsTheEquation) {
  for (const Layer& layer :
       {surface_on(0.1), surface_on(10.0, 0.3), alike(0.3, LayerBase::bonded)}) {
    const LayerLaw law(layer);
    for (double part = 0.01; part < 1.0; part += 0.13) {
      const double chi = part * law.last_chi();
      const LayerEquation equation(layer, layer_resolution(2.0 * law.last_chi() / layer.top()));
      const LayerSolution exact = test::layer_at_chi(equation, chi);
      EXPECT_NEAR(law.force_factor(chi) / exact.force_factor(), 1.0, 1e-5) << chi;
      EXPECT_NEAR(law.radius_factor(chi) / exact.radius_factor(), 1.0, 1e-5) << chi;
      const double step = 1e-4 * chi;
      const double slope =
          (law.force_factor(chi + step) - law.force_factor(chi - step)) / (2.0 * step);
      EXPECT_NEAR(law.stiffness_factor(chi), law.force_factor(chi) + chi / 3.0 * slope,
                  chi * (1e-5 * std::abs(slope) + 1e-6))
          << chi;
    }
  }
}

// Far from the force the whole stack is felt, near it the top layer: the two tables meet.
TEST(LayerStack, SurfaceDisplacementGoesOnFromTableToTable) {
  const LayerSurfaceDisplacement surface_displacement(surface_on(0.3), 20.0);
  const double border = 12.0 * 0.15;
  EXPECT_NEAR(surface_displacement.gamma(border * (1.0 + 1e-12)),
              surface_displacement.gamma(border * (1.0 - 1e-12)), 3e-5);
  EXPECT_NEAR(surface_displacement.gamma(12.0), 1.0 / 12.0, 1e-6);  // the rigid base holds it
  // One tissue in layers is one layer.
  const LayerSurfaceDisplacement one(Layer{.poisson_ratio = 0.3}, 11.0);
  const LayerSurfaceDisplacement split(alike(0.3, LayerBase::bonded), 11.0);
  for (const double rho : {0.0, 0.1, 0.5, 1.0, 2.3, 5.0, 11.0})
    EXPECT_NEAR(split.gamma(rho), one.gamma(rho), 1e-6) << rho;
  // How far the table reaches does not matter.
  for (const double farthest : {0.0, 0.3, 1.8, 5.0}) {
    const LayerSurfaceDisplacement near(surface_on(0.3), farthest);
    for (const double part : {0.0, 0.7, 1.0})
      EXPECT_EQ(near.gamma(part * farthest), surface_displacement.gamma(part * farthest))
          << farthest;
  }
}

}  // namespace
}  // namespace palpate::contact
