// A finger on a mesh: forces of the five tissues, couplings, integrators, instability.
#include <gtest/gtest.h>

#include <cmath>

#include "cases.h"
#include "contact/hertz.h"
#include "every.h"
#include "geometry/cuboid.h"
#include "run/family.h"
#include "run_text.h"
#include "scenario/words.h"

namespace palpate {
namespace {

using test::expect_case;
using test::found;
using test::run_text;

const std::vector<std::string> integrators = test::every(scenario::words::integrators);
// Modes are those of a linear body.
const std::vector<std::string> turning_integrators =
    test::every(scenario::words::integrators, {"modal"});
// `resolved` wants finer meshes: run_resolved.cpp.
const std::vector<std::string> press_couplings =
    test::every(scenario::words::couplings, {"resolved"});

const std::string press =
    "schema = 1\n[tissue]\nmaterial = \"skin\"\n[solver]\nmodel = \"mass_spring\"\n"
    "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\nrate = \"5 mm/s\"\n";

double force_at_travel(const record::CaseRecord& record, double travel) {
  for (const auto& row : record.contact)
    if (std::abs(row.travel - travel) < 1e-9) return row.force;
  ADD_FAILURE() << "no row at travel " << travel;
  return 0.0;
}

// The travel at which the force is this, between two rows.
double travel_at_force(const record::CaseRecord& record, double force) {
  for (std::size_t i = 1; i < record.contact.size(); ++i) {
    const auto& a = record.contact[i - 1];
    const auto& b = record.contact[i];
    if (a.force <= force && b.force >= force)
      return a.travel + (b.travel - a.travel) * (force - a.force) / (b.force - a.force);
  }
  ADD_FAILURE() << force << " N was not reached";
  return 0.0;
}

TEST(Press, FigureSixForcesInEveryIntegrator) {
  for (const std::string& integrator : integrators) {
    const auto skin = run_text(
        press, {"contact.coupling=one_way", "step.1.to=2 mm", "solver.integrator=" + integrator});
    expect_case("hertz-02", force_at_travel(skin, 0.5e-3));
    expect_case("hertz-07", force_at_travel(skin, 2e-3));
  }
  const auto bone = run_text(press, {"contact.coupling=one_way", "tissue.material=bone",
                                     "solver.integrator=quasi_static"});
  expect_case("hertz-21", force_at_travel(bone, 1e-3));
}

TEST(Press, HertzModelNeedsNoMesh) {
  const auto record = run_text(press, {"solver.model=hertz", "tissue.material=ligament"});
  expect_case("hertz-30", force_at_travel(record, 1e-3));
}

TEST(Press, IntegratorsAgree) {
  for (const std::string& coupling : press_couplings) {
    const auto exact = run_text(press, {"contact.coupling=" + coupling, "solver.integrator=modal"});
    for (const std::string& integrator : integrators) {
      const auto record =
          run_text(press, {"contact.coupling=" + coupling, "solver.integrator=" + integrator});
      for (const double travel : {0.5e-3, 1e-3})
        // Implicit Euler at tau / 50 is the coarsest: its lag moves u by a part in a hundred of
        // what u takes part in h.
        EXPECT_NEAR(force_at_travel(record, travel) / force_at_travel(exact, travel), 1.0, 1e-3)
            << coupling << " " << integrator;
      // Statics keep no energies where the mesh's motion cannot reach the force.
      if (integrator == "quasi_static" && coupling != "series")
        EXPECT_FALSE(test::has_finding(record, "energy_imbalance")) << coupling;
      else
        EXPECT_LT(found(record, "energy_imbalance"), 5e-3) << coupling << " " << integrator;
    }
  }
}

TEST(Press, NonlinearAgreesWithLinearForShallowPresses) {
  for (const std::string& integrator : turning_integrators) {
    const std::vector<std::string> common{"solver.integrator=" + integrator, "step.1.to=0.05 mm",
                                          "contact.coupling=series"};
    auto turned = common;
    turned.emplace_back("solver.kinematics=nonlinear");
    const double linear = run_text(press, common).contact.back().force;
    const double nonlinear = run_text(press, turned).contact.back().force;
    EXPECT_NEAR(nonlinear / linear, 1.0, 2e-3) << integrator;  // strains of 1e-3
    EXPECT_NE(nonlinear, linear);
  }
}

// Travel at the Hertz force of 1 mm, rigid sphere of 11 mm on 60x60x30 mm at nu 0.33: converged
// elasticity gives 0.926 to 0.945 mm (the design's brief); the mesh models may leave 5 %.
TEST(Press, ConsistentCouplingDoesNotDependOnTheMesh) {
  for (const char* mesh :
       {"{ kind = \"kuhn\", cells = [3, 4, 6] }", "{ kind = \"mirrored\", cells = [3, 4, 6] }",
        "{ kind = \"mirrored\", cells = [10, 10, 5] }", "{ kind = \"tetgen\", nodes = 160 }",
        "{ kind = \"tetgen\", nodes = 728 }"}) {
    for (const char* rule : {"fitted", "van_gelder"}) {
      const auto record = run_text(
          press, {std::string("tissue.mesh=") + mesh, std::string("solver.stiffness=") + rule,
                  "finger.material=rigid", "tissue.viscosity=none", "step.1.to=1.2 mm",
                  "solver.integrator=quasi_static", "output.interval=4 ms"});
      const double travel =
          travel_at_force(record, contact::hertz::force(1e-3, 0.011, 72.4e3 / (1 - 0.33 * 0.33)));
      EXPECT_GT(travel, 0.95 * 0.926e-3) << mesh << rule;
      EXPECT_LT(travel, 1.05 * 0.945e-3) << mesh << rule;
    }
  }
}

TEST(Press, SeriesLosesForceAndSaysSo) {
  const auto series = run_text(press, {"contact.coupling=series", "tissue.viscosity=none",
                                       "solver.integrator=quasi_static"});
  const auto one_way = run_text(press, {"contact.coupling=one_way", "tissue.viscosity=none",
                                        "solver.integrator=quasi_static"});
  EXPECT_LT(force_at_travel(series, 1e-3), 0.9 * force_at_travel(one_way, 1e-3));
  bool warned = false;
  for (const auto& warning : series.warnings)
    warned = warned || warning.find("counts the tissue's compliance twice") != std::string::npos;
  EXPECT_TRUE(warned);
}

// The force rises with every step of travel and falls with every step back, without jumps.
TEST(Press, ForceIsMonotoneAndContinuous) {
  for (const char* mesh :
       {"{ kind = \"mirrored\", cells = [3, 4, 6] }",
        "{ kind = \"mirrored\", cells = [12, 12, 6] }", "{ kind = \"tetgen\", nodes = 400 }"}) {
    for (const std::string& coupling : press_couplings) {
      const auto record =
          run_text(press + "[[step]]\nkind = \"retract\"\nto = \"-0.2 mm\"\nrate = \"5 mm/s\"\n",
                   {std::string("tissue.mesh=") + mesh, "contact.coupling=" + coupling,
                    "tissue.viscosity=none", "solver.integrator=quasi_static", "step.1.to=2 mm"});
      ASSERT_EQ(record.outcome, record::Outcome::completed);
      for (std::size_t i = 1; i < record.contact.size(); ++i) {
        const auto& a = record.contact[i - 1];
        const auto& b = record.contact[i];
        const double change = b.force - a.force;
        if (b.travel > a.travel) {
          EXPECT_GT(change, 0.0) << mesh << coupling << " at " << b.travel;
        }
        // dF <= 2 E* a dh, and dh is at most 1.5 of the travel's step on a specimen this thick
        const double slope = 2.0 * 78902.53 * std::max(a.contact_radius, b.contact_radius);
        EXPECT_LE(std::abs(change), 1.5 * slope * std::abs(b.travel - a.travel) + 1e-12)
            << mesh << coupling << " at " << b.travel;
      }
      EXPECT_EQ(record.contact.back().force, 0.0);
      EXPECT_EQ(record.contact.back().contacts, 0);
    }
  }
}

TEST(Press, IndentsUntilAForce) {
  for (const char* model : {"hertz", "mass_spring"}) {
    const auto record = run_text(press, {"step.1.to=0.5 N", std::string("solver.model=") + model});
    ASSERT_EQ(record.outcome, record::Outcome::completed) << model;
    EXPECT_GE(record.contact.back().force, 0.5);
    // One solver step of up to 5 um of travel at about 600 N/m.
    EXPECT_LT(record.contact.back().force, 0.5 + 5e-6 * 700.0) << model;
  }
}

TEST(Press, RetractThatIsThereAlreadyDoesNothing) {
  const auto record = run_text(press + "[[step]]\nkind = \"retract\"\nto = \"5 mm\"\n",
                               {"step.1.to=0.1 N", "solver.model=hertz"});
  EXPECT_EQ(record.outcome, record::Outcome::completed);
  EXPECT_EQ(record.contact.back().step, 1);
  ASSERT_FALSE(record.warnings.empty());
  EXPECT_NE(record.warnings.front().find("there already"), std::string::npos);
}

// Contact and mesh must not feed each other: with no damping at all, what waves the press has made
// stay small about the force of statics for a second, and the energy is accounted for.
TEST(Press, ConsistentIsStableWithoutDamping) {
  const std::string held = press + "[[step]]\nkind = \"hold\"\ntime = \"1 s\"\n";
  const double still = run_text(press, {"tissue.viscosity=none", "solver.integrator=quasi_static"})
                           .contact.back()
                           .force;
  for (const std::string integrator : {"central_difference", "modal"}) {
    const auto record = run_text(
        held, {"tissue.viscosity=none", "step.1.rate=100 mm/s", "solver.integrator=" + integrator});
    ASSERT_EQ(record.outcome, record::Outcome::completed) << integrator;
    for (const auto& row : record.contact)
      if (row.time > 0.5) {
        EXPECT_NEAR(row.force, still, 0.15 * still) << integrator << " at " << row.time;
      }
    EXPECT_LT(found(record, "energy_imbalance"), 0.02) << integrator;
  }
}

TEST(Press, QuasiStaticsHasNoKineticEnergy) {
  // Rows far shorter than a wave takes: a velocity would count as energy from nowhere.
  const auto record =
      run_text(press, {"solver.integrator=quasi_static", "tissue.viscosity=none",
                       "contact.coupling=series", "step.1.to=0.1 mm", "output.interval=0.1 ms"});
  EXPECT_EQ(record.outcome, record::Outcome::completed);
  EXPECT_LT(found(record, "energy_imbalance"), 1e-3);  // the trapezoid of the first rows
}

TEST(Press, ForceThatIsNeverReachedEndsTheCase) {
  const auto record = run_text(press, {"step.1.to=1 kN", "solver.model=hertz"});
  EXPECT_EQ(record.outcome, record::Outcome::diverged);
  EXPECT_NE(record.reason.find("not reached"), std::string::npos);
}

TEST(Press, RelaxesUnderAHold) {
  // The tissue gives way behind the contact while the travel is held: the force falls and settles
  // at what statics gives.
  const std::string held = press + "[[step]]\nkind = \"hold\"\ntime = \"1 s\"\n";
  for (const std::string& integrator : integrators) {
    const auto record = run_text(held, {"solver.integrator=" + integrator, "step.1.rate=100 mm/s",
                                        "contact.coupling=series", "output.interval=2 ms"});
    const auto still = run_text(press, {"tissue.viscosity=none", "contact.coupling=series",
                                        "solver.integrator=quasi_static"});
    EXPECT_GT(force_at_travel(record, 1e-3), 1.01 * record.contact.back().force) << integrator;
    EXPECT_NEAR(record.contact.back().force / still.contact.back().force, 1.0, 1e-3)
        << integrator;  // e^-10 of the lag is left
  }
}

TEST(Press, UnstableStepIsDetectedAndTheRestKept) {
  const auto record =
      run_text(press, {"output.interval=10 ms", "solver.substeps=1", "tissue.viscosity=none",
                       "solver.allow_unstable=true", "step.1.to=3 mm"});
  EXPECT_EQ(record.outcome, record::Outcome::diverged);
  EXPECT_GT(record.last_stable_time, 0.0);
  EXPECT_LT(record.last_stable_time, 0.6);
  for (const auto& row : record.contact) EXPECT_TRUE(std::isfinite(row.force));
  EXPECT_LE(record.contact.back().time, record.last_stable_time + 1e-9);
}

TEST(Press, StableJustBelowTheLimitAndNotAbove) {
  // 0.95 and 1.05 of 2 / omega_max by the output interval, one substep.
  const double limit = test::scene_of(press, {"tissue.viscosity=none", "contact.coupling=one_way",
                                              "solver.integrator=central_difference"})
                           .specimen->plan.limit.value();
  for (const double part : {0.95, 1.05}) {
    const auto record =
        run_text(press, {"tissue.viscosity=none", "contact.coupling=one_way", "solver.substeps=1",
                         "solver.integrator=central_difference", "solver.allow_unstable=true",
                         "step.1.to=5 mm", "step.1.rate=2 mm/s",
                         "output.interval=" + std::to_string(1e3 * part * limit) + " ms"});
    EXPECT_EQ(record.outcome == record::Outcome::completed, part < 1.0) << part;
  }
}

TEST(Press, StepAboveTheLimitIsRefused) {
  EXPECT_THROW((void)run_text(press, {"output.interval=10 ms", "solver.substeps=1"}), InputError);
}

TEST(Press, PaperStartIsNearTheConsistentOne) {
  const auto paper = run_text(press, {"solver.start=paper"});
  const auto consistent = run_text(press, {});
  // Contact starts without force, so that the starts differ little here.
  EXPECT_NEAR(force_at_travel(paper, 1e-3) / force_at_travel(consistent, 1e-3), 1.0, 1e-3);
}

TEST(Press, FrictionCountsTheWeightOnce) {
  const auto within = run_text(press, {"contact.friction=0.3"});
  const auto apart = run_text(
      press, {"contact.friction=0.3", "finger.weight=apart", "contact.ambient_force=0.2 N"});
  const auto& a = within.contact.back();
  const auto& b = apart.contact.back();
  EXPECT_DOUBLE_EQ(a.friction, 0.3 * a.contact_force);
  // 1370 kg/m^3 in a sphere of 11 mm, g = 9.80665 m/s^2
  const double weight = 1370.0 * 4.0 / 3.0 * 3.14159265358979324 * std::pow(0.011, 3) * 9.80665;
  EXPECT_NEAR(b.friction, 0.3 * (b.contact_force + weight), 1e-15);  // rounding
  EXPECT_DOUBLE_EQ(b.force, b.contact_force + 0.2);
  EXPECT_LT(found(within, "friction_imbalance"), 1e-3);
  EXPECT_LT(found(apart, "friction_imbalance"), 1e-3);
}

TEST(Press, PressureMapIntegratesToTheForce) {
  const auto record = run_text(press, {});
  ASSERT_EQ(record.maps.size(), 1U);
  EXPECT_NEAR(record::integral(record.maps[0]) / record.contact.back().contact_force, 1.0,
              1e-4);  // 64 samples a pixel along the rim
}

}  // namespace
}  // namespace palpate
