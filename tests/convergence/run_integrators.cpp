// Every integrator on a small real body: the order that it declares, against modal coordinates.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "run/choose.h"
#include "run/family.h"
#include "run_text.h"
#include "scenario/integrators.h"
#include "scenario/words.h"

namespace palpate {
namespace {

using Integrator = scenario::Solver::Integrator;

// 27 nodes of skin; limits of explicit steps are near 0.5 ms, the slowest mode takes 15 ms.
const std::string body =
    "schema = 1\n[tissue]\nmaterial = \"skin\"\n"
    "shape = { kind = \"cuboid\", size = [\"30 mm\", \"30 mm\", \"30 mm\"] }\n"
    "mesh = { kind = \"mirrored\", cells = [2, 2, 2] }\n[solver]\nmodel = \"mass_spring\"\n"
    "[output]\ninterval = \"2 ms\"\npressure_maps = false\n";

const std::string creep =
    "[[step]]\nkind = \"creep\"\nstress = \"1 kPa\"\nload_time = \"10 ms\"\n"
    "recovery_time = \"10 ms\"\n";
const std::string press = "[[step]]\nkind = \"indent\"\nto = \"0.4 mm\"\nrate = \"50 mm/s\"\n";

// Damping that shows within a few milliseconds.
const std::vector<std::vector<std::string>> dampings{
    {"tissue.viscosity=none"},
    {"tissue.viscosity=nodal_drag", "tissue.drag=200 1/s"},
    {"tissue.viscosity=kelvin_voigt", "tissue.retardation_time=2 ms"},
    {"tissue.viscosity=standard_linear_solid", "tissue.relaxation_time=5 ms",
     "tissue.instantaneous_ratio=2"}};

struct Programme {
  std::string steps;
  std::vector<std::string> settings;
};

// What is compared, at every row.
std::vector<double> answers(const Programme& run, const std::string& integrator, int substeps) {
  std::vector<std::string> settings = run.settings;
  settings.push_back("solver.integrator=" + integrator);
  settings.push_back("solver.substeps=" + std::to_string(substeps));
  const auto scene = test::scene_of(body + run.steps, settings);
  const record::CaseRecord record = test::run_scene(scene);
  EXPECT_EQ(record.outcome, record::Outcome::completed) << integrator << ": " << record.reason;
  std::vector<double> values;
  for (const auto& row : record.strain) values.push_back(row.strain);
  for (const auto& row : record.contact) values.push_back(row.contact_force);
  return values;
}

double size_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double difference(std::vector<double> one, const std::vector<double>& other) {
  EXPECT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i) one[i] -= other[i];
  return size_of(one);
}

// The order of convergence of the displacement in the time step, for loads that are constant or
// smooth in time; nothing for methods that are exact for loads linear in time.
std::optional<int> order_in_time(const scenario::Resolved::Solver& solver,
                                 tissue::Viscosity viscosity) {
  using Solver = scenario::Solver;
  const bool damped =
      viscosity == tissue::Viscosity::nodal_drag || viscosity == tissue::Viscosity::kelvin_voigt;
  const bool late = (damped && solver.damping == Solver::Damping::lagged) ||
                    solver.start == integrate::Start::paper;
  if (solver.integrator == Solver::Integrator::central_difference && late) return 1;
  return scenario::about(solver.integrator).order;
}

std::optional<int> declared(const Programme& run, const std::string& integrator) {
  std::vector<std::string> settings = run.settings;
  settings.push_back("solver.integrator=" + integrator);
  const auto family = scenario::parse(body + run.steps, "test.toml", settings);
  const scenario::Resolved scenario = run::choose(family.cases.front()).chosen;
  return order_in_time(scenario.solver, scenario.tissue.viscosity);
}

// Not what cannot be combined.
bool counts(const std::string& integrator, const std::string& damping) {
  return !(integrator == "quasi_static" && damping == "tissue.viscosity=nodal_drag");
}

struct Measured {
  double error = 0.0;  // at the finer step, relative
  double order = 0.0;
};

// From a step of 2 ms / `coarse` to half of it. Modal coordinates are the truth; without inertia
// the integrator itself in steps that are 8 times as fine as the finer ones.
Measured measure(const Programme& run, const std::string& integrator, int coarse,
                 const std::vector<double>& exact) {
  const std::vector<double> truth =
      integrator == "quasi_static" ? answers(run, integrator, 16 * coarse) : exact;
  const double before = difference(answers(run, integrator, coarse), truth);
  const double after = difference(answers(run, integrator, 2 * coarse), truth);
  return {after / size_of(truth), std::log2(before / after)};
}

// In an exact method there is nothing but the rounding of some hundred steps.
constexpr double rounding = 1e-12;
// Of the next term of the error at the finer step; the largest one seen is 0.11, of implicit Euler
// with branches, whose fastest modes are not resolved yet.
constexpr double next_term = 0.15;

class Integrators : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Dampings, Integrators, testing::Range(std::size_t{0}, dampings.size()));

TEST_P(Integrators, DeclaredOrdersInCreepAndRecovery) {
  const auto& damping = dampings[GetParam()];
  const Programme run{creep, damping};
  const auto exact = answers(run, "modal", 1);
  for (const auto& word : scenario::words::integrators) {
    if (!counts(word.word, damping[0])) continue;
    const auto order = declared(run, word.word);
    const Measured found = measure(run, word.word, 64, exact);
    const std::string what = std::string(word.word) + ", " + damping[0];
    // Without inertia a uniform test takes no steps: it is one solution times its law of time.
    if (!order || std::string(word.word) == "quasi_static") {
      EXPECT_LT(found.error, rounding) << what;
    } else {
      EXPECT_NEAR(found.order, *order, next_term) << what;
      EXPECT_LT(found.error, 0.02) << what;  // it is this body's motion
    }
  }
}

TEST_P(Integrators, DeclaredOrdersUnderAFinger) {
  auto damping = dampings[GetParam()];
  const std::string viscosity = damping[0];
  damping.insert(damping.end(), {"contact.coupling=series", "contact.viscosity=none"});
  const Programme run{press, damping};
  const auto exact = answers(run, "modal", 256);
  for (const auto& word : scenario::words::integrators) {
    if (!counts(word.word, viscosity)) continue;
    const Measured found = measure(run, word.word, 32, exact);
    const std::string what = std::string(word.word) + ", " + viscosity;
    const bool elastic_statics =
        std::string(word.word) == "quasi_static" && viscosity == "tissue.viscosity=none";
    if (elastic_statics) {
      EXPECT_LT(found.error, rounding) << what;
      continue;
    }
    // Explicit steps read the mesh over the patch of the step before, which is of first order
    // and small; contact forces bend within a step, so that modes are not exact either.
    const bool reads_late = std::string(word.word) == "central_difference";
    const double order = reads_late ? 1.0 : declared(run, word.word).value_or(2);
    EXPECT_NEAR(found.order, order,
                word.word == std::string("backward_difference") ? 0.2 : next_term)
        << what;  // implicit Euler's highest modes are still damped away at these steps
    EXPECT_LT(found.error, reads_late ? 1e-4 : 0.002) << what;
  }
}

// Springs that turn, at strains near a tenth; the truth is another integrator's.
TEST_P(Integrators, DeclaredOrdersOfSpringsThatTurn) {
  auto damping = dampings[GetParam()];
  damping.insert(damping.end(), {"solver.kinematics=nonlinear", "step.1.stress=5 kPa",
                                 "step.1.load_time=4 ms", "step.1.recovery_time=2 ms"});
  const Programme run{creep, damping};
  const std::vector<std::pair<std::string, std::string>> pairs{{"tr_bdf2", "central_difference"},
                                                               {"central_difference", "tr_bdf2"}};
  for (const auto& [integrator, other] : pairs) {
    const auto truth = answers(run, other, 512);
    const double before = difference(answers(run, integrator, 32), truth);
    const double after = difference(answers(run, integrator, 64), truth);
    EXPECT_NEAR(std::log2(before / after), *declared(run, integrator), next_term)
        << integrator << ", " << damping[0];
  }
}

TEST(FirstOrder, DampingThatLagsAndThePapersStartAreOfFirstOrder) {
  const std::vector<std::pair<std::string, std::size_t>> cases{
      {"solver.damping=lagged", 1}, {"solver.damping=lagged", 2}, {"solver.start=paper", 0}};
  for (const auto& [setting, damping] : cases) {
    Programme run{creep, dampings[damping]};
    const auto exact = answers(run, "modal", 1);
    run.settings.push_back(setting);
    EXPECT_EQ(declared(run, "central_difference"), 1);
    EXPECT_NEAR(measure(run, "central_difference", 64, exact).order, 1.0, next_term) << setting;
  }
}

}  // namespace
}  // namespace palpate
