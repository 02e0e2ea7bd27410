// Every scenario of scenarios/failures: it fails as theory says, is named, and its defaults do not.
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "base/cholesky.h"
#include "contact/hertz.h"
#include "program.h"
#include "record/csv.h"
#include "scenario/family.h"
#include "scene/scene.h"
#include "scene_text.h"
#include "tissue/network.h"

namespace palpate::test {
namespace {

// A scenario as it stands, and without the lines that are marked as its fault.
class Failure : public testing::Test {
 protected:
  Ended run(const std::string& name, const std::vector<std::string>& settings = {}) {
    write_file(folder_ / (name + ".toml"), text(name));
    return start(name, settings);
  }
  Ended run_without_fault(const std::string& name, const std::vector<std::string>& settings = {}) {
    std::istringstream lines(text(name));
    std::string kept;
    for (std::string line; std::getline(lines, line);)
      if (line.find("# fault") == std::string::npos) kept += line + "\n";
    EXPECT_NE(kept, text(name)) << "no line is marked as the fault";
    write_file(folder_ / (name + ".toml"), kept);
    return start(name, settings);
  }

  [[nodiscard]] record::Cell cell(const std::string& name, const std::string& finding) const {
    const record::Table table = record::read_csv(folder_ / "out" / name / "findings.csv");
    const int column = table.find(finding);
    if (column < 0 || table.rows.empty()) return std::string("no ") + finding;
    return table.rows.front()[static_cast<std::size_t>(column)];
  }
  [[nodiscard]] double found(const std::string& name, const std::string& finding) const {
    const record::Cell value = cell(name, finding);
    if (const auto* number = std::get_if<double>(&value)) return *number;
    ADD_FAILURE() << name << ": no number `" << finding << "`";
    return 0.0;
  }

  // Ends with `code` and says `sentence`; without its fault it is good and does not say it.
  void expect_failure(const std::string& name, int code, const std::string& sentence) {
    const Ended good = run_without_fault(name);
    EXPECT_EQ(good.code, 0) << good.err;
    EXPECT_EQ(good.err.find(sentence), std::string::npos) << good.err;
    const Ended bad = run(name);
    EXPECT_EQ(bad.code, code) << bad.err;
    EXPECT_NE(bad.err.find(sentence), std::string::npos) << bad.err;
  }

  TemporaryFolder folder_;

 private:
  [[nodiscard]] static std::string text(const std::string& name) {
    return read_file(project_file("scenarios/failures/" + name + ".toml"));
  }
  Ended start(const std::string& name, const std::vector<std::string>& settings) {
    std::vector<std::string> arguments{"run", name + ".toml", "--force"};
    for (const std::string& one : settings) arguments.insert(arguments.end(), {"--set", one});
    return palpate(folder_.path(), arguments);
  }
};

constexpr double radius = 11e-3;                            // m, of the finger
const double skin_on_rigid = 72.4e3 / (1.0 - 0.33 * 0.33);  // Pa, E*

TEST_F(Failure, StepAboveTheLimit) {
  const std::string name = "01_step_above_limit";
  expect_failure(name, 4, "energy grew without input");
  // 2 / omega_max of the paper's cube of muscle: tests/cases/physics.csv, dt-10.
  EXPECT_NEAR(found(name, "stable_time_step_ms"), 3.233649, 1e-6 * 3.2);  // its own tolerance
  EXPECT_NEAR(found(name, "time_step_ms") / 3.233649, 1.05, 1e-6);
  EXPECT_LT(found(name, "last_stable_time_s"), 0.5);
  const Ended below = run(name, {"output.interval=3.0719665 ms"});  // 0.95 of it
  EXPECT_EQ(below.code, 0) << below.err;
  EXPECT_NEAR(found(name, "time_step_ms") / 3.233649, 0.95, 1e-6);
  EXPECT_LT(found(name, "energy_imbalance"), 0.01);
  const Ended refused = run(name, {"solver.allow_unstable=false"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("above the stability limit of 3.234 ms"), std::string::npos)
      << refused.err;
}

TEST_F(Failure, ThePapersLiteralStep) {
  const std::string name = "02_paper_literal_step";
  expect_failure(name, 4, "energy grew without input");
  EXPECT_NEAR(found(name, "stable_time_step_ms"), 0.95690802, 1e-6);  // dt-08
  EXPECT_EQ(run(name, {"tissue.material=muscle", "output.interval=50 ms"}).code, 4);
  EXPECT_EQ(run_without_fault(name, {"tissue.material=muscle", "output.interval=50 ms"}).code, 0);
}

TEST_F(Failure, DampingThatLags) {
  const std::string name = "03_lagged_damping";
  expect_failure(name, 4, "times the stability limit");
  // -beta + sqrt(beta^2 + 4 / omega^2) with 2 / omega of dt-08
  const double beta = 2.0;  // ms
  EXPECT_NEAR(found(name, "stable_time_step_ms"),
              -beta + std::sqrt(beta * beta + 0.95690802 * 0.95690802), 1e-6);  // dt-08's digits
  EXPECT_EQ(run(name, {"output.interval=0.21 ms"}).code, 0) << "just below it";
}

TEST_F(Failure, Locking) {
  const std::string name = "04_locking";
  expect_failure(name, 0, "volumes of single tetrahedra lock at nu 0.499");
  const double locked = found(name, "locking");
  // Locked stiffness follows the bulk modulus: ten times it from 0.45 to 0.495.
  ASSERT_EQ(run(name, {"tissue.poisson_ratio=0.45"}).code, 0);
  const double less = found(name, "locking");
  ASSERT_EQ(run(name, {"tissue.poisson_ratio=0.4995"}).code, 0);
  const double more = found(name, "locking");
  EXPECT_GT(locked, 4.0 * less);
  // K doubles from 0.499 to 0.4995; most of the mesh's stiffness is that of locked volumes.
  EXPECT_GT(more, 1.5 * locked);
  EXPECT_LT(more, 2.0 * locked);
}

TEST_F(Failure, Conforming) {
  const std::string name = "05_conforming";
  expect_failure(name, 4, "the tissue is hollow and conforms to the finger (curvature -95 1/m)");
  // The limit is -1/R_1 = -90.909 1/m.
  EXPECT_EQ(run(name, {"tissue.shape.curvature=-90.91 1/m"}).code, 4);
  const Ended nearly = run(name, {"tissue.shape.curvature=-90.8 1/m"});
  EXPECT_EQ(nearly.code, 0) << nearly.err;
  EXPECT_NE(nearly.err.find("hollow beyond half the finger's curvature"), std::string::npos);
}

TEST_F(Failure, UnsignedCurvature) {
  const std::string name = "06_unsigned_curvature";
  expect_failure(name, 0, "curvature without its sign is");
  // With k_1 = 40 1/m the signed mean H gives k_2, and the vote without signs is the mean of
  // |k(t)| over the directions t.
  const double mean = found(name, "signed_curvature_per_m");
  const double swing = 40.0 - mean;  // k(t) = H + swing cos 2t
  double voted = 0.0;
  constexpr int directions = 10000;
  for (int i = 0; i < directions; ++i)
    voted +=
        std::abs(mean + swing * std::cos(2.0 * std::numbers::pi * i / directions)) / directions;
  // Stars of an unstructured mesh err by some per cent (docs/theory.md, curved tissue).
  EXPECT_NEAR(found(name, "local_curvature_per_m") / voted, 1.0, 0.1);
  EXPECT_GT(voted / mean, 1.5);
}

TEST_F(Failure, LogarithmOfZero) {
  const std::string name = "07_logarithm_of_zero";
  ASSERT_EQ(run(name).code, 0);
  const auto fit = [&](const char* model) {
    return palpate(folder_.path(), {"fit", "out/" + name + "/force_indentation.csv", "--x",
                                    "indentation_mm", "--y", "force_N", "--model", model});
  };
  const Ended logarithmic = fit("logarithmic");
  EXPECT_EQ(logarithmic.code, 0);
  EXPECT_NE(logarithmic.err.find("1 point is excluded"), std::string::npos) << logarithmic.err;
  EXPECT_EQ(logarithmic.out.find("nan"), std::string::npos);
  EXPECT_NE(logarithmic.out.find(",0.7459"), std::string::npos) << "R^2 = 0.746 of the brief";
  const Ended exponential = fit("exponential");
  EXPECT_EQ(exponential.code, 0);
  EXPECT_EQ(exponential.err.find("excluded"), std::string::npos) << exponential.err;
}

TEST_F(Failure, DeepPress) {
  const std::string name = "08_deep_press";
  expect_failure(name, 0, "and the factor for deep presses is known up to");
  EXPECT_NEAR(found(name, "depth_ratio"), 0.9, 1e-12);  // rounding
}

TEST_F(Failure, ThinLayer) {
  const std::string name = "09_thin_layer";
  ASSERT_EQ(run_without_fault(name).code, 0);
  EXPECT_EQ(cell(name, "model"), record::Cell("solid"));
  expect_failure(name, 0, "Neglected: the size of the body, which would add 420 % to the force");
  EXPECT_NEAR(found(name, "thickness_ratio"), 2.0, 1e-9);  // of the travel's digits
  // The layer's integral equation gives 5.209.
  EXPECT_NEAR(1.0 + found(name, "thickness_effect"), 5.209, 1e-3);
}

TEST_F(Failure, LoadOnOneNode) {
  const std::string name = "10_load_on_one_node";
  expect_failure(name, 0, "all of the force is on one node");
  const double coarse = found(name, "surface_displacement_mm");
  // All of the force on the node in the middle of the top, in statics.
  const auto scene =
      first_scene(scenario::read(project_file("scenarios/failures/" + name + ".toml"), {}));
  const tissue::Network& network = scene.specimen->network;
  int middle = 0;
  const Vec3 top(0.03, 0.03, 0.03);
  for (int n = 0; n < network.nodes(); ++n)
    if ((network.rest[static_cast<std::size_t>(n)] - top).norm() < 1e-9) middle = n;
  Eigen::VectorXd load = Eigen::VectorXd::Zero(3 * network.nodes());
  load[3 * middle + 2] = -found(name, "peak_force_N");
  Cholesky factors;
  ASSERT_TRUE(factors.factor(tissue::stiffness_matrix(network).split(scene.specimen->held)));
  EXPECT_NEAR(-1e3 * factors.solve(load)[3 * middle + 2] / coarse, 1.0, 1e-9);  // rounding
  ASSERT_EQ(run(name, {"tissue.mesh.cells=[12, 12, 6]"}).code, 0);
  // u ~ F / (E l), from the second mesh on; what the specimen itself sinks is a part of both.
  EXPECT_NEAR(found(name, "surface_displacement_mm") / coarse, 2.0, 0.3);
}

TEST_F(Failure, InvertedTetrahedron) {
  const std::string name = "11_inverted_tetrahedron";
  expect_failure(name, 4, "a tetrahedron has turned inside out");
  // strain s/E (1 - exp(-t / tau)) = 1; checked at every row, 1 ms
  EXPECT_NEAR(found(name, "last_stable_time_s"), -0.1 * std::log(1.0 - 72.4 / 100.0), 1.5e-3);
}

TEST_F(Failure, FewRings) {
  const std::string name = "12_few_rings";
  ASSERT_EQ(run_without_fault(name).code, 0);
  const double whole = found(name, "peak_force_N");
  expect_failure(name, 0, "give more `solver.rings`");
  EXPECT_GT(found(name, "edge_reaction_over_force"), 0.5);
  const double stiffened = found(name, "peak_force_N") / whole - 1.0;
  // A base as near as the edge, 15 mm, F/F_H = 1 + 0.9 chi + 0.94 chi^2 at nu = 0.33, of which
  // cells of three contact radii read some half.
  const double chi = std::sqrt(radius * 1e-3) / 15e-3;
  EXPECT_LT(stiffened, 0.9 * chi + 0.94 * chi * chi);
  EXPECT_GT(stiffened, 0.5 * 0.9 * chi);
}

TEST_F(Failure, BoneInExplicitSteps) {
  const std::string name = "13_bone_explicit";
  expect_failure(name, 2, "above the stability limit of 0.002656 ms");  // dt-12
  ASSERT_EQ(run_without_fault(name).code, 0);
  EXPECT_EQ(cell(name, "model"), record::Cell("hertz"));
  // 1 ms / (0.9 x 2.656 us), rounded up
  const Ended refused = run(name);
  EXPECT_NE(refused.err.find("(419 here)"), std::string::npos) << refused.err;
  const Ended explained =
      palpate(folder_.path(), {"explain", name + ".toml", "--set", "solver.substeps=\"auto\""});
  EXPECT_NE(explained.out.find("in 419 substeps of"), std::string::npos) << explained.out;
  EXPECT_NE(explained.out.find("spring updates a second of motion"), std::string::npos);
}

TEST_F(Failure, FrictionAtRest) {
  const std::string name = "14_friction_at_rest";
  expect_failure(name, 0, "friction jumped by");
  EXPECT_NEAR(found(name, "friction_jump_N"), 0.5 * 0.34892, 1e-5);  // mu F, F of case hertz-05
  // However slow: nothing is out of the finite, and still it jumps.
  const Ended slow = run(name, {"step.2.by=1e-9 mm", "step.2.rate=1e-8 mm/s"});
  EXPECT_EQ(slow.code, 0) << slow.err;
  EXPECT_NEAR(found(name, "friction_jump_N"), 0.5 * 0.34892, 1e-5);
}

TEST_F(Failure, KelvinVoigtTurnsBack) {
  const std::string name = "15_unloading_kelvin_voigt";
  expect_failure(name, 0, "when the finger turned back the force fell from");
  // F(h) + tau v F'(h) before, F(h - tau v) after, tau v = 0.1 mm. The rates are a row's mean: the
  // rows of 5 um are half a row late on both sides.
  const auto force = [](double h) { return contact::hertz::force(h, radius, skin_on_rigid); };
  const double slope = contact::hertz::stiffness(1e-3, radius, skin_on_rigid);
  const double drop = 1.0 - force(0.9e-3) / (force(1e-3) + 1e-4 * slope);
  EXPECT_NEAR(found(name, "turning_drop"), drop, 0.01);
  // It stays with finer rows; the standard linear solid's goes with them.
  ASSERT_EQ(run(name, {"output.interval=1 ms"}).code, 0);
  EXPECT_NEAR(found(name, "turning_drop"), drop, 0.002);
  const Ended solid = run(name, {"tissue.viscosity=standard_linear_solid"});
  EXPECT_EQ(solid.code, 0);
  EXPECT_EQ(solid.err.find("turned back"), std::string::npos) << solid.err;
}

TEST_F(Failure, StifferThanPassive) {
  const std::string name = "16_stiffer_than_passive";
  expect_failure(name, 0, "generates energy below");
  EXPECT_NEAR(found(name, "needed_device_damping_N_s_per_m"), 10 * 0.26169009,
              1e-7);  // passivity-01
  // b = K T / 2 at K = 2 E* sqrt(R h), so h goes as (b / T)^2: (0.3 / 2.6169)^2 of 1 mm
  EXPECT_NEAR(found(name, "passive_depth_mm"), std::pow(0.3 / 2.6169009, 2), 1e-8);
}

}  // namespace
}  // namespace palpate::test
