// The stability limit of every explicit method with every form of damping, on a free body.
#include <gtest/gtest.h>

#include <cmath>

#include "every.h"
#include "integrate/central_difference.h"
#include "scenario/family.h"
#include "scenario/integrators.h"
#include "scenario/words.h"
#include "scene/scene.h"
#include "scene_text.h"

namespace palpate {
namespace {

using integrate::DampingVelocity;

const std::string specimen_of_skin =
    "schema = 1\n[tissue]\nmaterial = \"skin\"\n"
    "shape = { kind = \"cuboid\", size = [\"30 mm\", \"30 mm\", \"30 mm\"] }\n"
    "mesh = { kind = \"mirrored\", cells = [2, 2, 2] }\n"
    "[[step]]\nkind = \"creep\"\nstress = \"1 kPa\"\n";

// zeta of the highest mode, omega_max near 4200 1/s: 0.3 of the drag, 0.4 of the dashpots. The
// solid relaxes in more than a hundred steps: its springs act as at once.
const std::vector<std::vector<std::string>> dampings{
    {"tissue.viscosity=none"},
    {"tissue.viscosity=nodal_drag", "tissue.drag=2500 1/s"},
    {"tissue.viscosity=kelvin_voigt", "tissue.retardation_time=0.2 ms"},
    {"tissue.viscosity=standard_linear_solid", "tissue.relaxation_time=50 ms",
     "tissue.instantaneous_ratio=2"}};

template <class Method>
double growth(Method method, const scene::SpringBody& body) {
  integrate::State state;
  const Eigen::Index size = body.mass().size();
  state.displacement = integrate::Vector::Zero(size);
  state.velocity = integrate::Vector::Zero(size);
  for (Eigen::Index d = 0; d < size; ++d)  // a little of every mode
    if (body.held()[static_cast<std::size_t>(d)] == 0)
      state.displacement[d] = 1e-6 * std::sin(1.0 + 7.0 * static_cast<double>(d));
  state.memory = body.memory_at(state.displacement);
  const double before = body.stored(state);
  const integrate::Vector none = integrate::Vector::Zero(size);
  for (int i = 0; i < 600; ++i) method.step(state, none);
  const double after = body.stored(state) + body.kinetic(state);
  return std::isfinite(after) ? after / before : 1e300;
}

void expect_limit(const std::vector<std::string>& settings, const std::string& what) {
  const auto scene = test::scene_of(specimen_of_skin, settings);
  const scene::Specimen& specimen = *scene.specimen;
  const scene::SpringBody springs(specimen.network, specimen.kinematics, specimen.law,
                                  specimen.held);
  const scenario::Resolved::Solver& solver = scene.scenario.solver;
  // Within 2 % on both sides: there is no more to choose than where in the bracket the limit is.
  for (const double part : {0.98, 1.02}) {
    const double dt = part * specimen.plan.limit.value();
    const double grown = growth(
        integrate::CentralDifference(springs, dt, solver.start, scenario::damping_velocity(solver)),
        springs);
    if (part < 1.0)
      EXPECT_LT(grown, 100.0) << what;  // the highest mode swings by 1 / (1 - 0.98^2) = 25
    else
      EXPECT_GT(grown, 1e10) << what;
  }
}

TEST(ExplicitLimits, AreWhatIsDeclared) {
  for (const auto& damping : dampings)
    for (const std::string& model :
         test::every(scenario::words::models, {"hertz", "layer", "solid"})) {
      std::vector<std::string> settings = damping;
      settings.push_back("solver.model=" + model);
      for (const auto& word : scenario::integrator_table) {
        if (!word.explicit_steps) continue;
        auto one = settings;
        one.push_back(std::string("solver.integrator=") + word.word);
        expect_limit(one, std::string(word.word) + ", " + damping[0] + ", " + model);
      }
      auto lagged = settings;
      lagged.insert(lagged.end(),
                    {"solver.integrator=central_difference", "solver.damping=lagged"});
      expect_limit(lagged, "lagged, " + damping[0] + ", " + model);
    }
}

// An explicit press of `series`: the contact's spring is in the limit, and the dashpots of a
// semi-implicit step do not hold it.
TEST(ExplicitLimits, KnowTheContactsSpring) {
  const std::string press =
      "schema = 1\n[tissue]\nmaterial = \"skin\"\n[contact]\ncoupling = \"series\"\n[solver]\n"
      "model = \"mass_spring\"\nintegrator = \"central_difference\"\n[[step]]\nkind = \"indent\"\n"
      "to = \"1 mm\"\n";
  const auto limit = [&](const std::vector<std::string>& settings) {
    return test::scene_of(press, settings).specimen->plan.limit.value();
  };
  const double alone = limit({"contact.coupling=one_way", "tissue.viscosity=none"});
  const double both = limit({"tissue.viscosity=none"});
  EXPECT_LT(both, alone);
  // 4 / limit^2 adds up; of the contact alone it is what is left.
  const double contact = 1.0 / std::sqrt(1.0 / (both * both) - 1.0 / (alone * alone));
  EXPECT_NEAR(limit({"solver.integrator=semi_implicit_euler", "tissue.retardation_time=1 s"}),
              contact, 1e-9 * contact);  // rounding of the difference
}

}  // namespace
}  // namespace palpate
