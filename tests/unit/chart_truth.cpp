// What a chart measures by: which reference serves what, and that it says its own error.
#include "base/stop_scope.h"
#include "chart/reference.h"
#include "chart/truth.h"

#include <gtest/gtest.h>

#include <cmath>

#include "contact/hertz.h"
#include "run/choose.h"
#include "run/displaced_surface.h"
#include "run/family.h"
#include "run/refined_mesh.h"
#include "scenario_text.h"
#include "scene/estimates.h"
#include "scene/scene.h"

namespace palpate::chart {
namespace {

Asked asked(const std::string& text) { return read_for_chart("scene.toml", text, {}); }

Truth truth(const std::string& text, std::size_t of_case = 0) {
  return find_truth(asked(text), of_case);
}

TEST(ChartReference, AHalfSpaceHasHertz) {
  const Truth found = truth(scenario::press +
                            "[tissue]\nshape = { kind = \"half_space\" }\n[contact]\nviscosity = "
                            "\"none\"\ndepth = \"hertz\"\n");
  EXPECT_EQ(found.kind, "closed form");
  const scenario::Case one =
      scenario::read_case(scenario::press + "[tissue]\nshape = { kind = \"half_space\" }\n");
  const scene::Choice choice = run::choose(one);
  const scene::Finger finger = scene::make_finger(choice.chosen);
  const double force = contact::hertz::force(0.002, finger.whole.radius, finger.whole.modulus);
  EXPECT_NEAR(found.moments.back().value, force, 1e-12 * force);  // rounding of the travel
  EXPECT_GT(choice.expected.ball, 0.0);
  EXPECT_DOUBLE_EQ(found.moments.back().error / found.moments.back().value,
                   choice.expected.ball + choice.expected.inertia);
  EXPECT_NE(found.sentence.find("finite strain, which would change it"), std::string::npos);
}

TEST(ChartReference, AWideFlatHasTheLayer) {
  // At 2 mm large strains would change more than the reference states, and so would a finger's
  // size.
  const std::string text =
      "[[step]]\nkind = \"indent\"\nto = \"0.05 mm\"\nrate = \"0.1 mm/s\"\n[tissue]\nshape = { "
      "kind = \"cuboid\", size = "
      "[\"200 mm\", \"200 mm\", \"30 mm\"] }\n[finger]\nmaterial = \"rigid\"\n";
  const Truth found = truth(text);
  EXPECT_EQ(found.kind, "closed form");
  const scene::Estimates estimated = run::choose(scenario::read_case(text)).expected;
  EXPECT_DOUBLE_EQ(found.moments.back().error / found.moments.back().value,
                   std::abs(estimated.sides) + estimated.size_error + estimated.inertia);
}

struct Creeping {
  double density = 0.0;  // kg/m^3
  const char* base = "";
  const char* kind = "";
};

// A uniform test is its law of time, however heavy the block is. On a bonded base the reference
// knows no law, and finds the same on meshes, because the block has no Poisson's ratio.
TEST(ChartReference, CreepIsTheMaterialsLaw) {
  for (const Creeping& block :
       {Creeping{1e3, "frictionless", "closed form"}, Creeping{2e4, "frictionless", "closed form"},
        Creeping{2e4, "bonded", "refined"}}) {
    const Truth found = truth(
        "[tissue]\nviscosity = \"kelvin_voigt\"\nretardation_time = \"0.1 s\"\nyoung_modulus = "
        "\"10 kPa\"\npoisson_ratio = 0\ndensity = \"" +
        std::to_string(block.density) + " kg/m^3\"\nbase = \"" + block.base +
        "\"\nshape = { kind = \"cuboid\", size = [\"60 mm\", \"60 mm\", \"30 mm\"] }\n"
        "[[step]]\nkind = \"creep\"\nstress = \"0.1 kPa\"\nload_time = \"0.5 s\"\n"
        "recovery_time = \"0.5 s\"\n[output]\ninterval = \"10 ms\"\n");
    EXPECT_EQ(found.kind, block.kind);
    ASSERT_EQ(found.moments.size(), 50U);  // 20 ms, of which 4 ms and 10 ms are parts
    for (const Moment& moment : found.moments) {
      const double before = moment.time - 0.5;
      const double law = 0.01 * (-std::expm1(-moment.time / 0.1) +
                                 (before > 0.0 ? std::expm1(-before / 0.1) : 0.0));
      EXPECT_NEAR(moment.value, law, moment.error + 1e-12) << moment.time;
    }
  }
}

// Spheres by `calibration = "force"` are one by their law; bodies in a mesh cannot be.
TEST(ChartReference, SpheresThatStandForOneHaveItsForce) {
  const auto greatest = [](const char* spheres) {
    const Asked one = asked(
        "[[step]]\nkind = \"indent\"\nto = \"0.5 mm\"\n[tissue]\nshape = { kind = \"cuboid\", "
        "size = [\"30 mm\", \"30 mm\", \"15 mm\"] }\n[contact]\nviscosity = \"none\"\n"
        "[finger]\nmaterial = \"rigid\"\nspheres = " +
        std::string(spheres) + "\n");
    return refer(one, 0).rows.back().force;
  };
  EXPECT_EQ(greatest("8"), greatest("1"));
}

// 297 mN by tests/accuracy/fast_presses.py's program, which knows large strains: a disc of 60 mm,
// on two meshes within 1 mN. Meshes of linear elasticity end 5 % below that, with 2 % between them.
TEST(ChartReference, OfAFastPressHoldsWhatLargeStrainsLeaveOpen) {
  const Reference found = refer(
      asked("[[step]]\nkind = \"indent\"\nto = \"1.5 mm\"\nrate = \"400 mm/s\"\n[tissue]\n"
            "young_modulus = \"20 kPa\"\npoisson_ratio = 0.33\ndensity = \"1100 kg/m^3\"\n"
            "viscosity = \"none\"\nshape = { kind = \"cuboid\", size = [\"60 mm\", \"60 mm\", "
            "\"30 mm\"] }\n[finger]\nmaterial = \"rigid\"\n[output]\ninterval = \"0.25 ms\"\n"),
      0);
  EXPECT_TRUE(found.moves);
  const ReferenceRow& last = found.rows.back();
  EXPECT_NEAR(1e3 * last.force, 297.0, 1e3 * last.error + 1.0);
  EXPECT_LT(last.error, 0.12 * last.force);
}

// A pillar that swings is pressed by `solid`, and what inertia adds is measured on coupled springs,
// within a few hundredths of what CalculiX has (run_inertia.cpp).
TEST(ChartReference, OfABodyThatSwingsIsTheSolidsForceAndWhatInertiaAdds) {
  const Reference found = refer(
      asked("[[step]]\nkind = \"indent\"\nto = \"0.5 mm\"\nrate = \"5 mm/s\"\n[tissue]\n"
            "young_modulus = \"10 kPa\"\npoisson_ratio = 0.33\ndensity = \"1100 kg/m^3\"\n"
            "viscosity = \"none\"\nshape = { kind = \"cuboid\", size = [\"20 mm\", \"20 mm\", "
            "\"80 mm\"] }\n[finger]\nmaterial = \"rigid\"\nradius = \"6 mm\"\n[output]\n"
            "interval = \"4 ms\"\n"),
      0);
  EXPECT_FALSE(found.moves);
  EXPECT_NE(found.how.find("what inertia adds"), std::string::npos) << found.how;
  const ReferenceRow& last = found.rows.back();
  EXPECT_LT(last.error, 0.015 * last.force);
  EXPECT_NEAR(1e3 * last.force, 8.55, 0.15);  // the static force of CalculiX, and a swing of 1 %
}

// The force at rest of both kinds of springs is the same; what they displace is not, and more cells
// help only those that are coupled.
TEST(ChartReference, TheDisplacedSurfaceTellsSpringsApart) {
  const Asked press = asked(
      "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\nrate = \"1 mm/s\"\n[tissue]\nyoung_modulus = "
      "\"20 kPa\"\npoisson_ratio = 0.45\nviscosity = \"none\"\nshape = { kind = \"cuboid\", size = "
      "[\"40 mm\", \"40 mm\", \"20 mm\"] }\n[finger]\nmaterial = \"rigid\"\n[output]\ninterval = "
      "\"100 ms\"\n");
  const run::SurfaceReference surface = refer_surface(press, 0);
  ASSERT_GT(surface.pieces.size(), 100U);
  EXPECT_LT(surface.error, 0.02);
  const auto error = [&](const char* model, const char* cells) {
    const scenario::Family family =
        with_settings(press, 0,
                      {std::string("solver.model=") + model, "solver.integrator=quasi_static",
                       std::string("tissue.mesh={kind='mirrored',cells=") + cells + "}"});
    scene::Scene scene = run::build_scene(family.cases.front(), family);
    scene.scenario.output.tissue = true;
    return run::surface_error(run::run_case(scene), surface.pieces).value();
  };
  const double coarse = error("coupled_springs", "[8,8,4]");
  const double fine = error("coupled_springs", "[12,12,6]");
  const double springs = error("mass_spring", "[12,12,6]");
  EXPECT_LT(fine, 0.75 * coarse);
  EXPECT_GT(springs, 0.95 * error("mass_spring", "[8,8,4]"));
  EXPECT_GT(springs, 1.8 * fine);
}

TEST(ChartReference, AUniformTestDisplacesNoSurfaceToCompare) {
  EXPECT_TRUE(refer_surface(asked(scenario::creep), 0).pieces.empty());
}

TEST(ChartReference, StoppedItSaysNothing) {
  const std::atomic<bool> stopped = true;
  const StopScope scope(stopped);
  EXPECT_THROW((void)find_truth(asked(scenario::creep), 0), Stopped);
}

}  // namespace
}  // namespace palpate::chart
