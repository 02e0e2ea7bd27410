// What `auto` chooses, and by which numbers. Whether it is right: docs/accuracy.md.
#include "run/choose.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "auto_scenes.h"
#include "base/index.h"
#include "base/text.h"
#include "geometry/cuboid.h"
#include "geometry/shapes.h"
#include "meshing/mesh_files.h"
#include "meshing/surface_files.h"
#include "part_of_mesh.h"
#include "revolved_bodies.h"
#include "run/answer.h"
#include "run/refined_mesh.h"
#include "scenario/family.h"
#include "scene/estimates.h"
#include "scene/scene.h"
#include "scene/specimen_shape.h"

namespace palpate::run {
namespace {

using scenario::Model;
using scene::Choice;
using scene::Estimates;
using scene::Forecast;
using Integrator = scenario::Solver::Integrator;

scenario::Case read(const std::string& text) {
  return scenario::parse(text, "scene.toml", {}).cases.front();
}

const std::string press = "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n";

TEST(Choose, TwentyScenesEachItsModel) {
  const std::map<std::string, Model> expected{
      {"bone under a silicone finger", Model::solid},
      {"muscle without end", Model::hertz},
      {"thick muscle", Model::hertz},
      {"skin 30 mm thick", Model::layer},
      {"skin 10 mm thick", Model::layer},
      {"thin skin", Model::solid},
      {"ligament that slides on its base", Model::coupled_springs},
      {"a narrow block", Model::coupled_springs},
      {"beside a side", Model::solid},
      {"a thin cylinder", Model::solid},
      {"an ellipsoid", Model::solid},
      {"a curved ligament", Model::solid},
      {"a lump under the skin", Model::solid},
      {"a layered limb", Model::solid},
      {"a fast tap", Model::coupled_springs},
      {"a slow press of a solid that relaxes", Model::hertz},
      {"a quick press of a solid that relaxes", Model::layer},
      {"a deep press", Model::hertz},
      {"slow creep of a block on a bonded base", Model::coupled_springs},
      {"slow creep between slippery platens", Model::mass_spring}};
  for (const test::AutoScene& scene : test::auto_scenes()) {
    const Choice choice = choose(read(scene.text));
    EXPECT_FALSE(choice.given) << scene.name;
    const auto found = expected.find(scene.name);
    if (found != expected.end()) {
      EXPECT_STREQ(scenario::traits(choice.chosen.solver.model).word,
                   scenario::traits(found->second).word)
          << scene.name;
    }
    // What is taken is predicted to serve, or nothing is.
    double least = 1.0;
    double taken = 1.0;
    for (const Forecast& forecast : choice.forecasts) {
      if (!forecast.cannot.empty()) continue;
      least = std::min(least, forecast.error);
      if (forecast.model == choice.chosen.solver.model) taken = forecast.error;
    }
    EXPECT_TRUE(taken <= 0.05 || taken == least) << scene.name;
  }
}

TEST(Choose, TheToleranceDecides) {
  const auto model = [](double tolerance) {
    scenario::Case one = read(press);
    one.scenario.solver.tolerance = tolerance;
    return choose(one).chosen.solver.model;
  };
  EXPECT_EQ(model(0.2), Model::hertz);   // the thickness and the sides make 9 %
  EXPECT_EQ(model(0.05), Model::layer);  // the sides take 1.6 %
  // Nothing is that good: the least error, of three meshes of the solid, is said.
  EXPECT_EQ(model(0.001), Model::solid);
  scenario::Case one = read(press);
  EXPECT_EQ(choose(one).shortfall(), "");
  one.scenario.solver.tolerance = 0.001;
  EXPECT_EQ(choose(one).shortfall().substr(0, 62),
            "no model is expected to be within the tolerance of 0.1 %: `sol");
}

// On 60 x 60 x 8 mm `layer` and the solid have one force (0.0224 N); 140 nodes see 2.5 % by the
// sides and state 5 % themselves.
TEST(Choose, SidesChangeNoMoreThanTheirFieldReaches) {
  const Choice found = choose(
      read("[tissue]\nyoung_modulus = \"10 kPa\"\npoisson_ratio = 0.45\nviscosity = \"none\"\n"
           "shape = { size = [\"60 mm\", \"60 mm\", \"8 mm\"] }\n[finger]\nradius = \"8 mm\"\n"
           "[[step]]\nto = \"0.5 mm\"\nrate = \"1 mm/s\"\n"));
  EXPECT_LE(std::abs(found.expected.sides), std::exp(-1.2 * (30.0 / 8.0 - 0.25)) + 1e-9);
  EXPECT_EQ(found.chosen.solver.model, Model::layer);
  EXPECT_LT(found.forecast(Model::layer)->error, 0.03);
}

TEST(Choose, ARefinedMeshIsForecastByItsTolerance) {
  const std::string strap = "[tissue]\nshape = { kind = \"ligament\" }\n";
  const auto forecast = [&](const std::string& mesh, double tolerance) {
    scenario::Case one = read(press + strap + mesh);
    one.scenario.solver.tolerance = tolerance;
    return choose(one).forecast(Model::coupled_springs)->error;
  };
  const std::string coarse = "mesh = { kind = \"tetgen\", nodes = 200 }\n";
  EXPECT_GT(forecast(coarse, 0.02), forecast("", 0.02) + 0.004);
  EXPECT_NEAR(forecast("", 0.02) - forecast("", 0.01), 0.5 * 0.01, 1e-9);
}

TEST(Choose, AUniformTestIsItsLawOfTimeUnlessItNamesInertia) {
  const std::string creep =
      "[tissue]\nviscosity = \"kelvin_voigt\"\nyoung_modulus = \"10 kPa\"\n[[step]]\nkind = "
      "\"creep\"\n";
  scenario::Case slow = read(creep);
  slow.scenario.tissue.retardation_time = 0.1;
  EXPECT_EQ(choose(slow).chosen.solver.integrator, Integrator::quasi_static);
  slow.scenario.tissue.retardation_time = 0.005;
  EXPECT_EQ(choose(slow).chosen.solver.integrator, Integrator::quasi_static);
  const double still = choose(slow).taken()->error;
  slow.scenario.tissue.viscosity = tissue::Viscosity::none;
  EXPECT_EQ(choose(slow).chosen.solver.integrator, Integrator::quasi_static);
  EXPECT_EQ(choose(slow).taken()->error, still);
  // What an elastic body rings is all of its strain.
  slow.scenario.solver.integrator = Integrator::central_difference;
  EXPECT_NEAR(choose(slow).taken()->error, still + 1.0, 1e-12);
  // Drag moves by nothing but motion, and keys of explicit steps ask for these.
  slow.scenario.solver.integrator.reset();
  slow.scenario.solver.substeps = 4;
  EXPECT_EQ(choose(slow).chosen.solver.integrator, Integrator::central_difference);
  const Choice drag =
      choose(read("[tissue]\nviscosity = \"nodal_drag\"\n[[step]]\nkind = \"creep\"\n"));
  EXPECT_EQ(drag.chosen.solver.integrator, Integrator::central_difference);
}

// Of 2 mm of 0.5 kPa in 20 kPa, 140 nodes have 0.138 kPa at 2 %, 11 000 have 0.134 and 25 000
// 0.133. (2.1 % had been stated.) A layer of the block's own modulus leaves it even.
TEST(Choose, AMeshOfSeveralTissuesBetweenPlatensIsMeasuredByAnother) {
  const auto error = [](const char* modulus, double ratio) {
    const Choice found = choose(
        read("[tissue]\nyoung_modulus = \"20 kPa\"\npoisson_ratio = 0.45\nviscosity = \"none\"\n"
             "base = \"frictionless\"\nshape = { size = [\"40 mm\", \"40 mm\", \"20 mm\"] }\n"
             "[[region]]\nkind = \"slab\"\nbottom = \"9 mm\"\ntop = \"11 mm\"\nyoung_modulus = \"" +
             std::string(modulus) + "\"\npoisson_ratio = " + std::to_string(ratio) +
             "\n[[step]]\nkind = \"compress\"\nstrain = 0.02\nrate = \"0.02 1/s\"\n"));
    return std::array{found.forecast(Model::coupled_springs)->error,
                      found.forecast(Model::mass_spring)->error};
  };
  EXPECT_GT(error("0.5 kPa", 0.45)[0], 0.138 / 0.132 - 1.0);
  EXPECT_LT(error("0.5 kPa", 0.45)[0], 0.1);
  EXPECT_LT(error("20 kPa", 0.45)[0], 0.025);
  EXPECT_GT(error("19 kPa", 0.1)[1], 0.07);  // half of the distance to 1/4
}

// Discs of 40 x 10 mm between bonded platens have 1.930 times E at nu 0.45 and 2.634 times at 0.49
// by CalculiX 2.20 (60 x 30 elements CAX8 of a quarter, which differ from 40 x 20 by less than
// 3e-4), and 2.102 and 3.136 times on the default mesh.
TEST(Choose, AMeshBetweenBondedPlatensIsMeasuredByAnother) {
  const auto error = [](double ratio, const char* platen) {
    return choose(read("[tissue]\nyoung_modulus = \"15 kPa\"\npoisson_ratio = " +
                       std::to_string(ratio) + "\nviscosity = \"none\"\nbase = \"" +
                       std::string(platen) +
                       "\"\nshape = { kind = \"cylinder\", radius = \"20 mm\", length = \"10 mm\" "
                       "}\n[[step]]\nkind = \"compress\"\nstrain = 0.01\nrate = \"0.1 "
                       "1/s\"\nplaten = \"" +
                       platen + "\"\n"))
        .forecast(Model::coupled_springs)
        ->error;
  };
  EXPECT_GT(error(0.45, "bonded"), 2.102 / 1.930 - 1.0);
  EXPECT_LT(error(0.45, "bonded"), 2.0 * (2.102 / 1.930 - 1.0));
  EXPECT_GT(error(0.49, "bonded"), 3.136 / 2.634 - 1.0);
  EXPECT_LT(error(0.49, "bonded"), 2.0 * (3.136 / 2.634 - 1.0));
  EXPECT_LT(error(0.49, "frictionless"), 0.005);
}

TEST(Choose, ASlowPressByNamedSpringsWithoutViscosityRests) {
  const std::string named = "[solver]\nmodel = \"mass_spring\"\n";
  const std::string elastic = "[tissue]\nviscosity = \"none\"\n";
  const auto integrator = [](const std::string& text) {
    return choose(read(text)).chosen.solver.integrator;
  };
  EXPECT_EQ(integrator(elastic + press + "rate = \"1 mm/s\"\n" + named), Integrator::quasi_static);
  for (const char* key : {"substeps = 2", "rings = 3", "kinematics = \"nonlinear\""})
    EXPECT_EQ(integrator(elastic + press + "rate = \"1 mm/s\"\n" + named + key + "\n"),
              Integrator::central_difference)
        << key;
  EXPECT_EQ(integrator(elastic + press + "rate = \"500 mm/s\"\n" + named),
            Integrator::central_difference);
}

TEST(Choose, IndependentSpringsAreNotTakenForAShapeThatIsNoPrism) {
  const std::string creep = "[[step]]\nkind = \"creep\"\n";
  EXPECT_EQ(choose(read(creep)).chosen.solver.model, Model::mass_spring);
  const Choice bent = choose(read("[tissue]\nshape = { kind = \"ligament\" }\n" + creep));
  EXPECT_EQ(bent.chosen.solver.model, Model::coupled_springs);
}

TEST(Choose, AGivenModelIsKeptAndStillAsked) {
  const Choice choice = choose(read(press + "[solver]\nmodel = \"mass_spring\"\n"));
  EXPECT_TRUE(choice.given);
  EXPECT_EQ(choice.chosen.solver.model, Model::mass_spring);
  // Its Kelvin-Voigt springs move for show; keys of explicit steps ask for such steps.
  EXPECT_EQ(choice.chosen.solver.integrator, Integrator::quasi_static);
  for (const char* key : {"substeps = 2", "start = \"paper\"", "damping = \"lagged\"",
                          "allow_unstable = true", "rings = 3", "kinematics = \"nonlinear\""})
    EXPECT_EQ(choose(read(press + "[solver]\nmodel = \"mass_spring\"\n" + key + "\n"))
                  .chosen.solver.integrator,
              Integrator::central_difference)
        << key;
  EXPECT_GE(choice.questions.size(), 8U);
  EXPECT_EQ(choice.forecasts.size(), scenario::model_table.size());
}

// The error of the springs' mesh says nothing of the mesh of `solid`, and a depth that the scenario
// names is that of every model.
TEST(Choose, AMeshIsKnownToItsOwnModelsOnly) {
  const Choice choice = choose(read(press + "[solver]\nmodel = \"coupled_springs\"\n"));
  const scene::Forecast* solid = choice.forecast(Model::solid);
  const scene::Forecast* springs = choice.forecast(Model::mass_spring);
  ASSERT_TRUE(solid != nullptr && springs != nullptr);
  EXPECT_EQ(solid->known(1e-3, Model::coupled_springs), solid->error);
  EXPECT_EQ(solid->known(1e-3, Model::solid), solid->error - solid->of_mesh + 1e-3);
  EXPECT_EQ(springs->known(1e-3, Model::coupled_springs), springs->error - springs->of_mesh + 1e-3);
  EXPECT_EQ(springs->known(1e-3, Model::solid), springs->error);
  const Choice named =
      choose(read(press + "[solver]\nmodel = \"hertz\"\n[contact]\ndepth = \"hertz\"\n"));
  EXPECT_FALSE(named.otherwise_found.depth_matters);
}

// What stands beside a named model is what would be chosen without it, large strains included.
TEST(Choose, OthersAreForeseenAsIfNoModelWereNamed) {
  const Choice open = choose(read(press));
  ASSERT_EQ(open.chosen.solver.model, Model::layer);
  ASSERT_EQ(open.chosen.contact.depth, scenario::Contact::Depth::neo_hookean);
  const Choice named = choose(read(press + "[solver]\nmodel = \"hertz\"\n"));
  EXPECT_EQ(named.otherwise.model, Model::layer);
  EXPECT_TRUE(named.otherwise_found.depth_matters);
  EXPECT_DOUBLE_EQ(named.forecast(Model::layer)->error, open.forecast(Model::layer)->error);
  EXPECT_GT(named.forecast(Model::hertz)->error, open.forecast(Model::hertz)->error);
}

TEST(Choose, WithoutInertiaAMeshIsQuasiStatic) {
  const std::string narrow =
      "[tissue]\nviscosity = \"none\"\nshape = { kind = \"cuboid\", size = [\"25 mm\", \"25 mm\", "
      "\"30 mm\"] }\n";
  const std::string named = "[solver]\nmodel = \"coupled_springs\"\n";
  EXPECT_EQ(choose(read(press + narrow + named)).chosen.solver.integrator,
            Integrator::quasi_static);
  EXPECT_EQ(choose(read(press + "rate = \"300 mm/s\"\n" + narrow)).chosen.solver.integrator,
            Integrator::central_difference);
}

// Waves count from a fifth of the tolerance on as an error of what does not move, and are computed
// from the tolerance on.
TEST(Choose, InertiaBelowTheToleranceIsStated) {
  constexpr double limit = 0.05;
  const auto at = [&](double rate) {
    return choose(read(press + "rate = \"" + std::to_string(rate) +
                       " mm/s\"\n[tissue]\nviscosity = \"none\"\n"));
  };
  const Choice slow = at(1.0);
  ASSERT_LT(slow.expected.inertia, 0.2 * limit);
  const double still = slow.taken()->error;
  ASSERT_LT(still, 0.6 * limit);
  const Choice quick = at(0.5 * (limit - still) / slow.expected.inertia);  // mm/s; linear in it
  EXPECT_FALSE(quick.chosen.meshed());
  EXPECT_DOUBLE_EQ(quick.taken()->error, still + quick.expected.inertia);
  EXPECT_DOUBLE_EQ(quick.waves, quick.expected.inertia);
  const Choice moving = at(1.2 * limit / slow.expected.inertia);
  EXPECT_EQ(moving.chosen.solver.model, Model::coupled_springs);
  EXPECT_EQ(moving.chosen.solver.integrator, Integrator::central_difference);
  EXPECT_EQ(moving.waves, 0.0);
}

// A mesh that the scenario gives is not refined for waves: one of coarse cells states all of them.
// The largest change of the force by inertia, over the last force, as a finger presses a slender
// rod at its upper end: masses in a line under Hertz's force, stepped explicitly.
double rod_swings(double radius, double height, double modulus, double nu, double density,
                  double ball, double depth, double rate) {
  constexpr int cells = 100;
  constexpr double dt = 1e-5;
  const double area = 3.14159265 * radius * radius;
  const double spring = modulus * area * cells / height;
  const double mass = density * area * height / cells;
  const double law = 4.0 / 3.0 * modulus / (1.0 - nu * nu) * std::sqrt(ball);
  const auto force = [&](double way, double end) {
    return law * std::pow(std::max(0.0, way - end), 1.5);
  };
  std::vector<double> place(cells + 1, 0.0), speed(cells + 1, 0.0);  // downwards, 0 is held
  double largest = 0.0, at_rest = 0.0;
  for (double time = 0.0; time < depth / rate; time += dt) {
    const double way = rate * time;
    for (int i = 1; i <= cells; ++i) {
      const double above = i < cells ? spring * (place[as_index(i + 1)] - place[as_index(i)])
                                     : force(way, place.back());
      const double below = spring * (place[as_index(i)] - place[as_index(i - 1)]);
      speed[as_index(i)] += dt / (i < cells ? mass : 0.5 * mass) * (above - below);
    }
    for (int i = 1; i <= cells; ++i) place[as_index(i)] += dt * speed[as_index(i)];
    double low = 0.0, high = way;  // of the end at rest
    while (high - low > 1e-9 * way) {
      const double middle = 0.5 * (low + high);
      (force(way, middle) * cells > spring * middle ? low : high) = middle;
    }
    at_rest = force(way, low);
    largest = std::max(largest, std::abs(force(way, place.back()) - at_rest));
  }
  return largest / at_rest;
}

TEST(Choose, APillarSwings) {
  const Choice choice =
      choose(read("[tissue]\nyoung_modulus = \"10 kPa\"\npoisson_ratio = 0.3\ndensity = \"1100 "
                  "kg/m^3\"\nviscosity = \"none\"\nshape = { kind = \"disc\", radius = \"10 mm\", "
                  "height = \"100 mm\" }\n[finger]\nmaterial = \"rigid\"\nradius = \"6 "
                  "mm\"\n[[step]]\nkind = \"indent\"\nto = \"0.5 mm\"\nrate = \"5 mm/s\"\n"));
  const double truth = rod_swings(0.010, 0.100, 1e4, 0.3, 1100.0, 0.006, 5e-4, 5e-3);
  // A bound: the contact is softer at first than it is counted.
  EXPECT_GT(choice.expected.inertia, truth);
  EXPECT_LT(choice.expected.inertia, 3.0 * truth);
  EXPECT_EQ(choice.chosen.solver.model, Model::coupled_springs);  // not `solid`, which rests
}

// Hertz's force does not apply on the rim; there the pillar bends besides.
TEST(Choose, APillarOfAFileSwingsWhereNoFormulaApplies) {
  const std::string folder = testing::TempDir() + "palpate_pillar" + std::to_string(::getpid());
  std::filesystem::create_directories(folder);
  meshing::write_surface(
      folder + "/pillar.off",
      geometry::sampled(geometry::Disc{0.010, 0.100}, {0.005, 0.005}).parts.front().surface, 1.0);
  const scenario::Family family = scenario::parse(
      "[tissue]\nyoung_modulus = \"10 kPa\"\npoisson_ratio = 0.3\ndensity = \"1100 kg/m^3\"\n"
      "viscosity = \"none\"\nshape = { file = \"pillar.off\", unit = \"m\" }\n[finger]\n"
      "material = \"rigid\"\nradius = \"6 mm\"\nx = \"19.9 mm\"\ny = \"10 mm\"\n[[step]]\n"
      "kind = \"indent\"\nto = \"0.5 mm\"\nrate = \"5 mm/s\"\n",
      folder + "/press.toml", {});
  const Choice choice = run::choose(family.cases.front());
  std::filesystem::remove_all(folder);
  EXPECT_FALSE(choice.touch.known());
  EXPECT_GT(choice.expected.swing, rod_swings(0.010, 0.100, 1e4, 0.3, 1100.0, 0.006, 5e-4, 5e-3));
}

// The same where the finger slides down a slender rod's round end, whose normal is inclined: the
// rod bends. Euler's and Bernoulli's beam in a line of masses, pressed by the normal's horizontal
// share of Hertz's force.
double rod_bends(double radius, double height, double modulus, double nu, double density,
                 double ball, double depth, double rate, double inclination) {
  constexpr int cells = 20;
  constexpr double dt = 5e-5;
  const double dx = height / cells;
  const double bending = modulus * 3.14159265 / 4.0 * std::pow(radius, 4);
  const double mass = density * 3.14159265 * radius * radius * dx;
  const double law =
      4.0 / 3.0 * modulus / (1.0 - nu * nu) * std::sqrt(1.0 / (1.0 / ball + 1.0 / radius));
  const double across = std::sin(inclination);
  const double down = std::cos(inclination);
  const auto force = [&](double way, double end) {
    return law * std::pow(std::max(0.0, down * way - across * end), 1.5);
  };
  std::vector<double> place(cells + 1, 0.0), speed(cells + 1, 0.0);  // sideways, 0 is held
  double largest = 0.0, at_rest = 0.0;
  for (double time = 0.0; time < depth / rate; time += dt) {
    const double way = rate * time;
    std::vector<double> moment(cells + 2, 0.0);  // none at the free end
    for (int i = 0; i < cells; ++i)
      moment[as_index(i)] = bending / (dx * dx) *
                            (place[as_index(std::abs(i - 1))] - 2.0 * place[as_index(i)] +
                             place[as_index(i + 1)]);  // clamped: as if mirrored
    for (int i = 1; i <= cells; ++i) {
      const double bent =
          (moment[as_index(i - 1)] - 2.0 * moment[as_index(i)] + moment[as_index(i + 1)]) / dx;
      const double pushed = i < cells ? 0.0 : across * force(way, place.back());
      speed[as_index(i)] += dt / (i < cells ? mass : 0.5 * mass) * (pushed - bent);
    }
    for (int i = 1; i <= cells; ++i) place[as_index(i)] += dt * speed[as_index(i)];
    double low = 0.0, high = down * way / across;  // of the end at rest
    const double spring = 3.0 * bending / std::pow(height, 3);
    while (high - low > 1e-9 * way) {
      const double middle = 0.5 * (low + high);
      (across * force(way, middle) > spring * middle ? low : high) = middle;
    }
    at_rest = force(way, low);
    largest = std::max(largest, std::abs(force(way, place.back()) - at_rest));
  }
  return largest / at_rest;
}

TEST(Choose, ARodThatIsPressedOnASteepPlaceSwings) {
  const test::TemporaryFolder folder;
  test::Profile profile;
  for (int i = 0; i < 6; ++i)
    profile.push_back({10.0 * std::sin(0.2618 * i), 90.0 + 10.0 * std::cos(0.2618 * i)});
  test::add_line(profile, {10.0, 90.0}, {10.0, 0.0}, 4.5);
  test::add_base(profile, 10.0, 5.0);
  test::write_surface(profile, 4.5, folder / "rod.off");
  for (const double inclination : {0.785, 1.08}) {
    const scenario::Family family = scenario::parse(
        "[tissue]\nyoung_modulus = \"10 kPa\"\npoisson_ratio = 0.4\ndensity = \"1041 kg/m^3\"\n"
        "viscosity = \"none\"\nshape = { file = \"rod.off\", unit = \"mm\" }\n[finger]\n"
        "material = \"rigid\"\nradius = \"6 mm\"\nx = \"" +
            number_text(16.0 * std::sin(inclination)) +
            " mm\"\ny = \"0 mm\"\n[[step]]\nkind = \"indent\"\nto = \"0.6 mm\"\n"
            "rate = \"5 mm/s\"\n",
        folder / "press.toml", {});
    const Choice choice = run::choose(family.cases.front());
    const double truth = rod_bends(0.010, 0.095, 1e4, 0.4, 1041.0, 0.006, 6e-4, 5e-3, inclination);
    EXPECT_GT(truth, 2.0);  // the static force is small, as the rod bends away
    EXPECT_GT(choice.expected.swing, truth);
    EXPECT_LT(choice.expected.swing, 3.0 * truth);
  }
}

// A rod on a heavy block on a thin stalk: the rod yields at once, the block hardly moves during the
// press. A mass on a spring under Hertz's contact and the rod, in a line.
TEST(Choose, WhatYieldsAtOnceDoesNotSwing) {
  const geometry::TetMesh lattice =
      geometry::cuboid({0.060, 0.060, 0.100}, {12, 12, 20}, geometry::CellPattern::mirrored);
  const geometry::TetMesh body = test::part_of(lattice, [](const Vec3& middle) {
    const bool thin = (middle - Vec3(0.030, 0.030, middle.z())).lpNorm<Eigen::Infinity>() < 0.005;
    return thin || (middle.z() > 0.040 && middle.z() < 0.070);
  });
  const test::TemporaryFolder folder;
  meshing::write_node_ele(folder / "body.node", body);
  const scenario::Family family = scenario::parse(
      "[tissue]\nyoung_modulus = \"10 kPa\"\npoisson_ratio = 0.3\ndensity = \"1000 kg/m^3\"\n"
      "viscosity = \"none\"\nbase_height = \"5 mm\"\nshape = { kind = \"as_meshed\" }\nmesh = { "
      "file = "
      "\"body.node\", unit = \"m\" }\n[finger]\nmaterial = \"rigid\"\nradius = \"4 mm\"\n"
      "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\nrate = \"20 mm/s\"\n",
      folder / "press.toml", {});
  const Choice choice = run::choose(family.cases.front());

  constexpr double modulus = 1e4, area = 1e-4, mass = 1000.0 * 0.060 * 0.060 * 0.030;
  constexpr double stalk = modulus * area / 0.035, rod = modulus * area / 0.030;  // N/m
  const double law = 4.0 / 3.0 * modulus / (1.0 - 0.3 * 0.3) * std::sqrt(0.004);
  const auto force_at = [&](double depth, double compliance) {  // of contact and compliance
    double low = 0.0, high = law * std::pow(depth, 1.5);
    for (int i = 0; i < 60; ++i) {
      const double force = 0.5 * (low + high);
      (std::pow(force / law, 2.0 / 3.0) + compliance * force < depth ? low : high) = force;
    }
    return low;
  };
  constexpr double dt = 1e-4;
  double place = 0.0, speed = 0.0, largest = 0.0;
  for (double way = 0.0; way < 1e-3; way += 0.020 * dt) {
    const double force = force_at(std::max(0.0, way - place), 1.0 / rod);
    largest = std::max(largest, std::abs(force - force_at(way, 1.0 / rod + 1.0 / stalk)));
    speed += dt / mass * (force - stalk * place);
    place += dt * speed;
  }
  const double truth = largest / force_at(1e-3, 1.0 / rod + 1.0 / stalk);
  EXPECT_GT(choice.expected.swing, truth);
  EXPECT_LT(choice.expected.swing, 2.5 * truth);  // 4 where the rod is thought to lag behind, too
}

TEST(Choose, ACoarseLatticeDoesNotCarryWaves) {
  const auto stated = [](const std::string& kind, const char* cells) {
    return choose(read(press +
                       "rate = \"300 mm/s\"\n[tissue]\nviscosity = \"none\"\nmesh = { kind = \"" +
                       kind + "\", cells = " + cells +
                       " }\n[solver]\nmodel = \"coupled_springs\"\n"))
        .taken()
        ->error;
  };
  for (const char* kind : {"kuhn", "mirrored"})
    EXPECT_GT(stated(kind, "[2, 2, 2]"), 3.0 * stated(kind, "[24, 24, 12]")) << kind;
}

// A slow press leaves viscosity out, a quick one keeps it.
TEST(Choose, ViscosityBelowAFifthOfTheToleranceIsDropped) {
  const std::string solid =
      "[tissue]\nviscosity = \"standard_linear_solid\"\n[output]\ninterval = \"100 ms\"\n";
  using Viscosity = scenario::Contact::Viscosity;
  EXPECT_EQ(choose(read(press + "rate = \"0.002 mm/s\"\n" + solid)).chosen.contact.viscosity,
            Viscosity::none);
  EXPECT_EQ(choose(read(press + "rate = \"5 mm/s\"\n" + solid)).chosen.contact.viscosity,
            Viscosity::tissue);
}

// 60 x 60 x 30 mm, R 11 mm, 1 mm, rigid finger, nu 0.33: the layer's own factor, and by the mesh
// the sides, which are nine contact radii away.
TEST(Estimates, OfTheDefaultBlock) {
  const Estimates found = choose(read(press + "[finger]\nmaterial = \"rigid\"\n")).expected;
  EXPECT_NEAR(found.chi, 3.3166248e-3 / 0.030, 1e-9);
  EXPECT_TRUE(found.measured);
  EXPECT_LT(found.sides, 0.0);
  // The solid on three meshes is 0.9 % below the layer with its factor, and states 0.9 %.
  EXPECT_NEAR(found.sides, -0.009, 0.009);
  const contact::LayerLaw law({.poisson_ratio = 0.33});
  EXPECT_NEAR(found.thickness, law.force_factor(found.chi) - 1.0, 1e-6);
  EXPECT_NEAR(found.size, (1.0 + found.thickness) * (1.0 + found.sides) - 1.0, 1e-12);
  EXPECT_EQ(found.tissue_share, 1.0);
  EXPECT_EQ(found.curvature_ratio, 1.0);
  EXPECT_EQ(found.edge, 0.0);
  ASSERT_TRUE(found.depth_ratio.has_value());
  const auto ratio = contact::depth_ratio(
      {.radius = 0.011, .thickness = 0.030, .poisson_ratio = 0.33, .half_width = 0.030});
  EXPECT_DOUBLE_EQ(found.deep, ratio.value().value(1e-3) - 1.0);
  EXPECT_DOUBLE_EQ(found.deep_error, ratio.value().error(1e-3));
}

// The bodies of cases/bodies and their kind: a hollow one is no half-space, whatever its box.
// A skin that bends on a soft base: the linear stack is 18 % too soft beside `solid`, and had
// stated 9 %. One that is hardly stiffer is hardly stretched.
TEST(Choose, TheStretchOfAStiffLayerOnASofterOneIsBounded) {
  const auto error = [](const char* above, const char* below) {
    return choose(
               read(std::string("[tissue]\nyoung_modulus = \"") + above +
                    "\"\npoisson_ratio = 0.45\nviscosity = \"none\"\nshape = { size = [\"100 mm\", "
                    "\"100 mm\", \"20 mm\"] }\n[[region]]\nkind = \"slab\"\nbottom = \"0 mm\"\ntop "
                    "= "
                    "\"19.5 mm\"\npoisson_ratio = 0.45\nyoung_modulus = \"" +
                    below +
                    "\"\n[finger]\nmaterial = \"rigid\"\nradius = \"8 mm\"\n[[step]]\nto = \"1.2 "
                    "mm\"\nrate = \"1 mm/s\"\n"))
        .forecast(Model::layer)
        ->error;
  };
  EXPECT_GT(error("600 kPa", "4 kPa"), 0.044365 / 0.036445 - 1.0);
  EXPECT_LT(error("600 kPa", "500 kPa"), 0.12);
}

// A region of chen2007's muscle has another retardation time than skin.
TEST(Choose, ARegionsOwnLawOfTimeIsKnownNotToBeUsed) {
  const auto other = [](const std::string& viscosity, const std::string& region) {
    return scenario::resolve(
               read("[tissue]\nmaterial = \"skin\"\nviscosity = \"" + viscosity +
                    "\"\n[[region]]\nkind = \"slab\"\nbottom = \"0 mm\"\ntop = \"3 mm\"\n" +
                    region + press),
               Model::solid)
        .regions.front()
        .other_law;
  };
  EXPECT_TRUE(other("kelvin_voigt", "material = \"muscle\"\n"));
  EXPECT_FALSE(other("kelvin_voigt", "material = \"skin\"\n"));
  EXPECT_FALSE(other("kelvin_voigt", "young_modulus = \"5 kPa\"\n"));  // a tissue of its own
  EXPECT_FALSE(other("none", "material = \"muscle\"\n"));
}

// The surface of a limb of three parts has more nodes than the coarse mesh of other bodies: it is
// measured on a finer one. (Nothing had been, and Hertz's formula taken with 100 % of error.)
TEST(Choose, ABodyOfSeveralPartsIsMeasured) {
  const Choice found = choose(read(
      "[tissue]\nmaterial = \"upper_leg\"\nshape = { kind = \"layered_limb\" }\n[[region]]\nkind = "
      "\"tagged\"\ntag = 1\nmaterial = \"upper_leg\"\n[[step]]\nto = \"1 mm\"\nrate = \"1 "
      "mm/s\"\n"));
  EXPECT_TRUE(found.expected.measured);
  EXPECT_LT(found.forecast(Model::coupled_springs)->error, 0.2);
}

TEST(Choose, AHollowBodyIsNoHalfSpace) {
  const auto wall = [](const std::string& to) {
    return choose(read(
        "[tissue]\nviscosity = \"none\"\nshape = { file = \"" PALPATE_SOURCE_DIR
        "/tests/cases/shell12.off\", unit = \"mm\" }\n[finger]\nmaterial = \"rigid\"\nradius = "
        "\"6 mm\"\n[[step]]\nkind = \"indent\"\nto = \"" +
        to + "\"\n"));
  };
  const Choice hollow = wall("0.5 mm");
  EXPECT_LT(hollow.expected.size, -0.1);
  EXPECT_NEAR(hollow.touch.thickness, 0.012, 0.0005);
  EXPECT_NE(hollow.chosen.solver.model, Model::hertz);

  // A press to the force of that displacement takes the same way, which Hertz's depth is not.
  const contact::SphereLaw law = scene::make_finger(hollow.chosen).whole;
  const double force =
      (1.0 + hollow.expected.size) * contact::hertz::force(0.5e-3, law.radius, law.modulus);
  const Choice pressed = wall(std::to_string(1e6 * force) + " uN");
  EXPECT_LT(contact::hertz::depth(force, law.radius, law.modulus), 0.45e-3);
  EXPECT_NEAR(pressed.expected.travel, 0.5e-3, 0.05 * 0.5e-3);
}

// The ends of a lying cylinder within two contact radii are the solid's; a search leaves it out.
TEST(Choose, AnEdgeIsForTheSolid) {
  const auto at = [](const char* y, Models models = Models::all) {
    scene::SpecimenShapes shapes;
    return choose(read(std::string("[tissue]\nviscosity = \"none\"\nshape = { kind = \"cylinder\" "
                                   "}\n[finger]\nmaterial = \"rigid\"\ny = \"") +
                       y + "\"\n[[step]]\nkind = \"indent\"\nto = \"0.5 mm\"\n"),
                  shapes, models);
  };
  const Choice near = at("3 mm");
  EXPECT_GT(near.expected.edge, 0.1);
  EXPECT_EQ(near.chosen.solver.model, Model::solid);
  EXPECT_NE(at("3 mm", Models::quick).chosen.solver.model, Model::solid);
  EXPECT_EQ(at("60 mm").expected.edge, 0.0);
}

// A place beside an edge is for the solid; cases that are compared with it are as well.
TEST(Choose, CasesOfAFamilyTakeOneModel) {
  const auto family = [](const std::string& solver) {
    return scenario::parse("[tissue]\nviscosity = \"none\"\n[finger]\nmaterial = \"rigid\"\n" +
                               press + solver + "[sweep]\n\"finger.x\" = [\"3 mm\", \"30 mm\"]\n",
                           "scene.toml", {});
  };
  scene::SpecimenShapes shapes;
  const scenario::Family open = family("");
  const OneModel one = one_model(open, shapes, 1);
  EXPECT_EQ(one.model, Model::solid);
  ASSERT_EQ(one.choices.size(), 2U);
  EXPECT_EQ(one.choices.at(1).chosen.solver.model, Model::layer);
  scenario::Case middle = open.cases.back();
  middle.at_least = one.model;
  const Choice taken = choose(middle, shapes);
  EXPECT_EQ(taken.chosen.solver.model, Model::solid);
  EXPECT_EQ(taken.otherwise.model, Model::layer);
  EXPECT_EQ(taken.questions.back().asked, "family");
  const std::string why = expect(build_scene(middle, open, shapes)).answer.model;
  EXPECT_NE(why.find("Another case of the sweep needs it; alone, this one would take layer."),
            std::string::npos)
      << why;
  EXPECT_EQ(why.find("with large strains"), std::string::npos) << why;

  EXPECT_FALSE(one_model(family("[solver]\nmodel = \"layer\"\n"), shapes, 1).model);
  middle.scenario.solver.model = Model::layer;
  EXPECT_EQ(choose(middle, shapes).chosen.solver.model, Model::layer) << "named";
}

}  // namespace
}  // namespace palpate::run
