// Uniform specimens against Kelvin-Voigt and the standard linear solid: groups KV, SLS, drag.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "cases.h"
#include "every.h"
#include "run/family.h"
#include "run_text.h"
#include "scenario/words.h"

namespace palpate {
namespace {

using test::expect_case;

const std::vector<std::string> specimen_integrators = test::every(scenario::words::integrators);
// Modes are those of a linear body.
const std::vector<std::string> turning_specimen_integrators =
    test::every(scenario::words::integrators, {"modal"});
const char* const meshes[] = {"{ kind = \"kuhn\", cells = [3, 4, 6] }",
                              "{ kind = \"mirrored\", cells = [2, 2, 4] }",
                              "{ kind = \"tetgen\", nodes = 160 }"};

struct Result {
  record::CaseRecord record;
  scene::Scene scene;
};

Result run_specimen(const std::string& text, const std::vector<std::string>& settings) {
  scene::Scene scene = test::scene_of(text, settings);
  return {test::run_scene(scene), std::move(scene)};
}

const std::string specimen =
    "schema = 1\n[tissue]\nmaterial = \"muscle\"\n"
    "shape = { kind = \"cuboid\", size = [\"30 mm\", \"30 mm\", \"30 mm\"] }\n"
    "[output]\ninterval = \"50 ms\"\n";
const std::string creep = specimen +
                          "[[step]]\nkind = \"creep\"\nstress = \"100 Pa\"\nload_time = \"1.5 s\"\n"
                          "recovery_time = \"0.5 s\"\n";
const std::string relax = specimen + "[[step]]\nkind = \"relax\"\nstrain = 0.02\ntime = \"2 s\"\n";

double strain_at(const record::CaseRecord& record, double time) {
  for (const auto& row : record.strain)
    if (std::abs(row.time - time) < 1e-6) return row.strain;
  ADD_FAILURE() << "no row at " << time;
  return 0.0;
}

TEST(KelvinVoigtSpecimen, CreepsAndRecoversLikeTheClosedForm) {
  const double tau = 0.5;
  for (const std::string& integrator : specimen_integrators) {
    for (const char* mesh : meshes) {
      const auto [record, scene] = run_specimen(
          creep, {"tissue.viscosity=kelvin_voigt", "tissue.retardation_time=0.5 s",
                  "solver.integrator=" + integrator, std::string("tissue.mesh=") + mesh});
      ASSERT_EQ(record.outcome, record::Outcome::completed) << integrator << mesh;
      const double settled = 100.0 / scene.specimen->measured.young_modulus;
      for (const auto& row : record.strain) {
        const double loaded = std::min(row.time, 1.5);
        double want = settled * (1.0 - std::exp(-loaded / tau));
        if (row.time > 1.5) want *= std::exp(-(row.time - 1.5) / tau);
        EXPECT_NEAR(row.strain, want, 0.01 * settled)  // the figure: 1 % of the settled
            << integrator << " " << mesh << " at " << row.time;
      }
    }
  }
}

// Springs that turn are stepped; under a small load they are the same body.
TEST(KelvinVoigtSpecimen, KeepsTheShapeOfStaticsWhereItStrainsUnevenly) {
  std::vector<std::string> settings{"tissue.viscosity=kelvin_voigt",
                                    "tissue.retardation_time=0.5 s",
                                    "solver.integrator=quasi_static",
                                    "solver.model=mass_spring",
                                    "tissue.base=bonded",
                                    "step.1.stress=0.1 Pa"};
  const auto [one, scene] = run_specimen(creep, settings);
  settings.emplace_back("solver.kinematics=nonlinear");
  const auto [stepped, other] = run_specimen(creep, settings);
  ASSERT_EQ(one.strain.size(), stepped.strain.size());
  ASSERT_GT(one.strain.size(), 40U);
  for (std::size_t i = 0; i < one.strain.size(); ++i) {
    EXPECT_DOUBLE_EQ(one.strain[i].time, stepped.strain[i].time);
    EXPECT_EQ(one.strain[i].stress, stepped.strain[i].stress);
    EXPECT_NEAR(one.strain[i].strain, stepped.strain[i].strain, 1e-4 * one.strain[30].strain) << i;
  }
}

TEST(KelvinVoigtSpecimen, QuasiStaticIsTheClosedForm) {
  const auto [record, scene] =
      run_specimen(creep, {"tissue.viscosity=kelvin_voigt", "tissue.retardation_time=0.5 s",
                           "solver.integrator=quasi_static", "output.interval=25 ms"});
  const double settled = 100.0 / scene.specimen->measured.young_modulus;
  expect_case("KV-02", strain_at(record, 0.25) / settled);
  expect_case("KV-03", strain_at(record, 0.5) / settled);
  expect_case("KV-04", strain_at(record, 1.0) / settled);
  expect_case("KV-06", strain_at(record, 2.0) / settled);  // 3 tau loaded, 1 tau after
}

TEST(KelvinVoigtSpecimen, EarlyAndLate) {
  const auto [record, scene] =
      run_specimen(creep, {"tissue.viscosity=kelvin_voigt", "tissue.retardation_time=0.2 s",
                           "solver.integrator=quasi_static", "output.interval=20 ms"});
  const double settled = 100.0 / scene.specimen->measured.young_modulus;
  expect_case("KV-01", strain_at(record, 0.02) / settled);
  expect_case("KV-05", strain_at(record, 1.0) / settled);
}

TEST(StandardLinearSolidSpecimen, Relaxes) {
  const double tau = 0.4;
  const double ratio = 2.5;
  for (const std::string& integrator : specimen_integrators) {
    for (const char* mesh : meshes) {
      const auto [record, scene] = run_specimen(
          relax, {"tissue.viscosity=standard_linear_solid", "tissue.relaxation_time=0.4 s",
                  "tissue.instantaneous_ratio=2.5", "solver.integrator=" + integrator,
                  std::string("tissue.mesh=") + mesh});
      ASSERT_EQ(record.outcome, record::Outcome::completed) << integrator << mesh;
      const double modulus = scene.specimen->measured.young_modulus;
      for (const auto& row : record.strain) {
        const double want = 0.02 * modulus * (1.0 + (ratio - 1.0) * std::exp(-row.time / tau));
        EXPECT_NEAR(row.stress, want, 0.01 * want)  // the figure: 1 %
            << integrator << " " << mesh << " at " << row.time;
      }
    }
  }
}

const std::vector<std::string> solid_settings{"tissue.viscosity=standard_linear_solid",
                                              "tissue.relaxation_time=0.4 s",
                                              "tissue.instantaneous_ratio=2.5"};

TEST(StandardLinearSolidSpecimen, CreepsWithoutInertia) {
  const double ratio = 2.5;
  const double creep_time = 0.4 * ratio;  // tau_c = tau E_0 / E_inf
  auto settings = solid_settings;
  settings.emplace_back("solver.integrator=quasi_static");
  const auto [record, scene] = run_specimen(creep, settings);
  const double settled = 100.0 / scene.specimen->measured.young_modulus;
  const auto course = [&](double t) {
    return settled * (1.0 - (1.0 - 1.0 / ratio) * std::exp(-t / creep_time));
  };
  for (const auto& row : record.strain) {
    double want = course(row.time);
    if (row.time > 1.5) want -= course(row.time - 1.5);  // superposition
    if (row.time == 1.5) continue;
    // Elongations change linearly in a step of 50 ms: (dt / tau_c)^2 / 12 of the branch.
    EXPECT_NEAR(row.strain, want, 5e-4 * settled) << "at " << row.time;
  }
}

// With inertia the solid rings after the jump, for its branch damps little at that frequency: the
// stepped answer must be the exact one, ringing and all.
TEST(StandardLinearSolidSpecimen, RingsAlikeInStepsAndInModes) {
  auto stepped = solid_settings;
  stepped.emplace_back("solver.integrator=central_difference");
  stepped.emplace_back("solver.substeps=400");
  auto exact = solid_settings;
  exact.emplace_back("solver.integrator=modal");
  const auto a = run_specimen(creep, stepped);
  const auto b = run_specimen(creep, exact);
  const double settled = 100.0 / a.scene.specimen->measured.young_modulus;
  ASSERT_EQ(a.record.strain.size(), b.record.strain.size());
  for (std::size_t i = 0; i < a.record.strain.size(); ++i)
    EXPECT_NEAR(a.record.strain[i].strain, b.record.strain[i].strain,
                0.02 * settled)  // phase error of 1.5 s of ringing at omega dt = 0.02
        << "row " << i;
}

// The slow creep time of a bar on a fixed base under drag d/m: 1 / tau is the small root of
// s^2 - (d/m) s + omega_1^2, omega_1 = pi c / (2 L).
double drag_time(double length, double drag) {
  const double c = std::sqrt(6000.0 / 1041.0);
  const double omega = std::numbers::pi * c / (2.0 * length);
  return 2.0 / (drag - std::sqrt(drag * drag - 4.0 * omega * omega));
}

// sigma(t) = int E(t - s) strain'(s) ds by the trapezoidal rule, apart from the program's formula.
double hereditary(double modulus, const std::function<double(double)>& ratio, double rate,
                  double ramp, double time) {
  const double end = std::min(time, ramp);
  constexpr int parts = 20000;
  double sum = 0.0;
  for (int k = 0; k < parts; ++k) {
    const double from = end * k / parts;
    const double to = end * (k + 1) / parts;
    sum += 0.5 * (ratio(time - from) + ratio(time - to)) * (to - from);
  }
  return modulus * rate * sum;
}

const std::string compress =
    specimen +
    "[[step]]\nkind = \"compress\"\nstrain = 0.1\nrate = \"0.2 1/s\"\nhold_time = \"1 s\"\n";

TEST(CompressedSpecimen, FollowsItsLoadingHistory) {
  for (const char* mesh : meshes) {
    std::vector<std::string> settings = solid_settings;
    settings.push_back(std::string("tissue.mesh=") + mesh);
    const auto [record, scene] = run_specimen(compress, settings);
    ASSERT_EQ(record.outcome, record::Outcome::completed);
    const double modulus = scene.specimen->measured.young_modulus;
    const auto ratio = [](double t) { return 1.0 + 1.5 * std::exp(-t / 0.4); };
    ASSERT_EQ(record.strain.size(), 31U);  // 0.5 s and 1 s in rows of 50 ms
    for (const auto& row : record.strain) {
      EXPECT_DOUBLE_EQ(row.strain, std::min(0.1, 0.2 * row.time));
      EXPECT_NEAR(row.stress, hereditary(modulus, ratio, 0.2, 0.5, row.time), 1e-7 * modulus)
          << row.time;
    }
  }
}

TEST(CompressedSpecimen, IsElasticOrAVoigtBody) {
  const auto [elastic, scene] = run_specimen(compress, {"tissue.viscosity=none"});
  const double modulus = scene.specimen->measured.young_modulus;
  for (const auto& row : elastic.strain)
    EXPECT_NEAR(row.stress, modulus * row.strain, 1e-9 * modulus);
  const record::CaseRecord voigt =
      run_specimen(compress, {"tissue.viscosity=kelvin_voigt", "tissue.retardation_time=0.3 s"})
          .record;
  for (const auto& row : voigt.strain) {
    const double rate = row.time < 0.5 + 1e-9 ? 0.2 : 0.0;  // the peak is that of the ramp's end
    EXPECT_NEAR(row.stress, modulus * (row.strain + 0.3 * rate), 1e-9 * modulus) << row.time;
  }
}

// Gent and Lindley 1959 for an incompressible cylinder between bonded platens: E (1 + 2 S^2) with
// S = radius / (2 height). Their solution is an approximation, and this body has a ratio of 0.49.
TEST(CompressedSpecimen, BondedPlatensStiffenIt) {
  const auto secant = [&](const char* base, const char* platen) {
    const record::CaseRecord record =
        run_specimen(compress,
                     {"tissue.shape={kind=\"cylinder\",radius=\"10 mm\",length=\"10 mm\"}",
                      "tissue.poisson_ratio=0.49", "tissue.viscosity=none",
                      "tissue.mesh={kind=\"tetgen\",nodes=3000}", "solver.model=coupled_springs",
                      std::string("tissue.base=") + base, std::string("step.1.platen=") + platen})
            .record;
    return record.strain.back().stress / record.strain.back().strain;
  };
  const double modulus = secant("frictionless", "frictionless");
  EXPECT_NEAR(secant("bonded", "bonded") / modulus, 1.5, 0.1);
  // The middle of a specimen between two bonded platens is a slippery platen of half of it: S / 2.
  EXPECT_NEAR(secant("bonded", "frictionless") / modulus, 1.125, 0.1);
}

// The stated error against the same body by twenty times as many nodes.
TEST(CompressedSpecimen, BondedPlatensCostWhatIsStated) {
  for (const char* ratio : {"0.3", "0.45", "0.49"})
    for (const char* height : {"10 mm", "30 mm"}) {
      const auto run = [&](const std::string& mesh) {
        return run_specimen(
            compress, {std::string("tissue.poisson_ratio=") + ratio, "tissue.viscosity=none",
                       "tissue.base=bonded", "step.1.platen=bonded", "tissue.mesh=" + mesh,
                       std::string("tissue.shape.size=[\"30 mm\", \"30 mm\", \"") + height + "\"]",
                       "solver.model=coupled_springs"});
      };
      const auto [coarse, scene] = run(meshes[0]);
      const auto [fine, other] = run("{ kind = \"mirrored\", cells = [14, 14, 14] }");
      const double off = coarse.strain.back().stress / fine.strain.back().stress - 1.0;
      const double stated = scene.choice.taken()->error;
      EXPECT_LT(off, stated) << ratio << " " << height;
      EXPECT_LT(stated, 4.0 * off + 0.02) << ratio << " " << height;
    }
}

TEST(NodalDragSpecimen, CreepTimeGrowsWithTheLengthSquared) {
  expect_case("drag-01", drag_time(0.030, 1000.0));
  for (const double length : {30.0, 60.0}) {
    const std::string mm = std::to_string(static_cast<int>(length)) + " mm";
    const auto [record, scene] = run_specimen(
        creep, {"tissue.viscosity=nodal_drag", "tissue.drag=1000 1/s",
                "tissue.shape={ kind = \"cuboid\", size = [\"8 mm\", \"8 mm\", \"" + mm + "\"] }",
                "tissue.mesh={ kind = \"mirrored\", cells = [2, 2, 10] }", "step.1.load_time=2 s",
                "output.interval=10 ms"});
    // Recovery, when the faster modes have gone: the ratio of two strains tells the time.
    const double want = drag_time(1e-3 * length, 1000.0);
    const double early = strain_at(record, 2.0 + 0.1);
    const double late = strain_at(record, 2.0 + 0.3);
    EXPECT_NEAR(0.2 / std::log(early / late), want, 0.02 * want)  // ten cells, sides that move
        << length;
  }
}

TEST(KelvinVoigtSpecimen, DoesNotRelaxAndSaysSo) {
  const auto [record, scene] =
      run_specimen(relax, {"tissue.viscosity=kelvin_voigt", "tissue.retardation_time=0.5 s",
                           "solver.integrator=quasi_static"});
  const double want = 0.02 * scene.specimen->measured.young_modulus;
  for (const auto& row : record.strain) EXPECT_NEAR(row.stress, want, 1e-9 * want);  // rounding
  ASSERT_FALSE(record.warnings.empty());
  EXPECT_NE(record.warnings.back().find("does not relax"), std::string::npos);
}

TEST(UniformSpecimen, NonlinearAgreesWithLinearForSmallLoads) {
  for (const std::string& integrator : turning_specimen_integrators) {
    const std::vector<std::string> common{"tissue.viscosity=kelvin_voigt",
                                          "tissue.retardation_time=0.5 s",
                                          "solver.integrator=" + integrator, "step.1.stress=1 Pa"};
    auto turned = common;
    turned.emplace_back("solver.kinematics=nonlinear");
    const auto linear = run_specimen(creep, common);
    const auto nonlinear = run_specimen(creep, turned);
    ASSERT_EQ(nonlinear.record.outcome, record::Outcome::completed) << integrator;
    ASSERT_EQ(linear.record.strain.size(), nonlinear.record.strain.size());
    for (std::size_t i = 0; i < linear.record.strain.size(); ++i)
      EXPECT_NEAR(nonlinear.record.strain[i].strain, linear.record.strain[i].strain,
                  2e-3 * 1.0 / 6000.0)  // strain 2e-4: the second order is of that size
          << integrator << " row " << i;
  }
}

// Dashpots that turn with the springs, under a load where they turn by some hundredths: the
// explicit step, whose damping is tens of times its mass, against the implicit one.
TEST(UniformSpecimen, TurnedDashpotsKeepTheExplicitStepStable) {
  const auto settings = [](const std::string& integrator) {
    return std::vector<std::string>{
        "tissue.viscosity=kelvin_voigt", "tissue.retardation_time=0.5 s",
        "solver.kinematics=nonlinear",   "tissue.mesh={ kind = \"tetgen\", nodes = 160 }",
        "step.1.stress=500 Pa",          "solver.integrator=" + integrator};
  };
  const auto explicit_one = run_specimen(creep, settings("central_difference")).record;
  const auto implicit_one = run_specimen(creep, settings("backward_difference")).record;
  ASSERT_EQ(explicit_one.outcome, record::Outcome::completed) << explicit_one.reason;
  ASSERT_EQ(explicit_one.strain.size(), implicit_one.strain.size());
  double largest = 0.0;
  for (const auto& row : implicit_one.strain) largest = std::max(largest, row.strain);
  EXPECT_GT(largest, 0.05);
  for (std::size_t i = 0; i < implicit_one.strain.size(); ++i)
    EXPECT_NEAR(explicit_one.strain[i].strain, implicit_one.strain[i].strain,
                0.01 * largest)  // implicit Euler at tau / 50
        << "row " << i;
}

TEST(UniformSpecimen, EnergyIsAccountedFor) {
  for (const std::string& integrator : specimen_integrators) {
    const auto [record, scene] =
        run_specimen(creep, {"tissue.viscosity=kelvin_voigt", "tissue.retardation_time=0.5 s",
                             "solver.integrator=" + integrator, "output.interval=5 ms"});
    if (integrator == "quasi_static") {
      EXPECT_FALSE(test::has_finding(record, "energy_imbalance")) << "it takes no steps";
      continue;
    }
    double imbalance = 1.0;
    for (const auto& finding : record.findings)
      if (finding.name == "energy_imbalance") imbalance = std::get<double>(finding.value);
    // Implicit Euler damps numerically by about dt / tau of what is dissipated.
    EXPECT_LT(imbalance, 0.02) << integrator;
  }
}

}  // namespace
}  // namespace palpate
