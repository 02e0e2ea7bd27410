// The lines of `palpate explain` on time.
#include "cli/explain_time.h"

#include <cmath>

#include "base/text.h"
#include "scenario/integrators.h"

namespace palpate::cli {
namespace {

using Solver = scenario::Resolved::Solver;

std::string milliseconds(double seconds) { return rounded_text(1e3 * seconds) + " ms"; }

// For implicit methods, which have no limit, the line gives that of central differences.
std::string limit_word(const Solver& solver) {
  return solver.integrator == Solver::Integrator::semi_implicit_euler
             ? "semi-implicit Euler is stable below "
             : "central differences are stable below ";
}

std::string limit_formula(const Solver& solver) {
  if (!about(solver.integrator).explicit_steps) return " (2 / omega_max)";
  switch (scenario::damping_velocity(solver)) {
    case integrate::DampingVelocity::centred: return " (2 / omega_max)";
    case integrate::DampingVelocity::lagged:
      return " (2 (sqrt(1 + zeta^2) - zeta) / omega_max: damping lags)";
    case integrate::DampingVelocity::ahead: break;
  }
  return " (2 (sqrt(1 + zeta^2) + zeta) / omega_max)";
}

// The paper's time step, which it gives without a unit, read as s; 0 for other materials.
double literal_step(const std::string& material) {
  if (material == "skin" || material == "ligament") return 0.01;
  if (material == "muscle" || material == "upper_leg") return 0.05;
  return 0.0;
}

}  // namespace

std::vector<std::string> explain_time(const scene::Scene& scene) {
  const scene::TimePlan& plan = scene.specimen->plan;
  const Solver& solver = scene.scenario.solver;
  const double limit = plan.limit
                           ? *plan.limit
                           : scene::stability_limit(scene.scenario, *scene.specimen, plan.contact);
  std::vector<std::string> lines;
  lines.push_back(std::string("  time         ") + about(solver.integrator).told);
  lines.push_back("  stability    " + limit_word(solver) + milliseconds(limit) +
                  limit_formula(solver));
  lines.push_back("  steps        time step " + milliseconds(plan.time_step) + " in " +
                  std::to_string(plan.substeps) +
                  (plan.substeps == 1 ? " step of " : " substeps of ") +
                  milliseconds(plan.substep) + ", " +
                  rounded_text(scene.specimen->network.springs() / plan.substep, 2) +
                  " spring updates a second of motion");
  if (solver.allow_unstable && !plan.stable())
    lines.emplace_back(
        "  warning      the step is above the stability limit and will diverge; "
        "`allow_unstable` permits it");
  const double literal = literal_step(scene.scenario.tissue.material);
  if (literal > limit)
    lines.push_back("  the paper    its literal time step of " + milliseconds(literal) + " is " +
                    rounded_text(literal / limit, 3) +
                    " times the limit: central differences would have diverged");
  return lines;
}

}  // namespace palpate::cli
