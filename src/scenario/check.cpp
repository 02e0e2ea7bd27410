// Checks that look at several keys at once.
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "base/units.h"
#include "scenario/family.h"

namespace palpate::scenario {
namespace {

using Integrator = Solver::Integrator;

class Checker {
 public:
  Checker(const Scenario& scenario, const Node& document, std::vector<Problem>& problems)
      : scenario_(scenario), document_(document), problems_(problems) {}

  void all() {
    steps();
    methods();
    times();
  }

 private:
  void problem(const std::string& path, const std::string& message) {
    problems_.push_back({place_of(document_, path), message});
  }

  void steps() {
    if (scenario_.steps.empty())
      return problem("step", "a scenario needs something to do; add a `[[step]]`, as "
                             "`kind = \"indent\"`");
    const bool uniform = scenario_.uniform();
    double travel = 0.0;
    for (std::size_t i = 0; i < scenario_.steps.size(); ++i) {
      const std::string path = "step." + std::to_string(i + 1);
      const Step& step = scenario_.steps[i];
      const bool end_faces =
          std::holds_alternative<Creep>(step) || std::holds_alternative<Relax>(step);
      if (end_faces != uniform)
        return problem(path, "`creep` and `relax` load the end faces and have no finger, the other "
                             "steps have one; put them into two scenarios");
      if (const auto* indent = std::get_if<Indent>(&step)) travel = indented(path, *indent, travel);
      if (const auto* retract = std::get_if<Retract>(&step)) {
        if (retract->to >= travel)
          problem(path + ".to", "`retract` goes to " + quantity_text(retract->to, unit::mm) +
                                    ", which is not above the travel of " +
                                    quantity_text(travel, unit::mm) +
                                    " before it; use `indent` to go deeper");
        travel = retract->to;
      }
    }
  }

  // The travel after the step; a step to a force may end anywhere.
  double indented(const std::string& path, const Indent& indent, double travel) {
    if (indent.to.second) return scenario_.finger.radius;
    if (indent.to.value <= travel)
      problem(path + ".to", "`indent` goes to " + quantity_text(indent.to.value, unit::mm) +
                                ", which is not below the travel of " +
                                quantity_text(travel, unit::mm) +
                                " before it; use `retract` to go back");
    if (indent.to.value > scenario_.finger.radius)
      problem(path + ".to", "`to` is deeper than the finger's radius of " +
                                quantity_text(scenario_.finger.radius, unit::mm) +
                                ", where no Hertz contact is left; press less deep");
    const auto& size = std::get<Cuboid>(scenario_.tissue.shape).size;
    if (indent.to.value > 0.9 * size[2])
      problem(path + ".to", "`to` presses through the specimen, which is " +
                                quantity_text(size[2], unit::mm) + " high; press less deep");
    const double patch = std::sqrt(scenario_.finger.radius * indent.to.value);
    if (patch > 0.5 * std::min(size[0], size[1]))
      problem(path + ".to", "the contact would be wider than the specimen's top; press less deep "
                            "or use a wider one");
    return indent.to.value;
  }

  void methods() {
    const Solver& solver = scenario_.solver;
    if (solver.model == Solver::Model::hertz && scenario_.uniform())
      problem("solver.model", "`hertz` has no specimen to creep or relax; set "
                              "`solver.model = \"mass_spring\"`");
    if (solver.model == Solver::Model::hertz) return;
    if (solver.integrator == Integrator::modal &&
        solver.kinematics == tissue::Kinematics::nonlinear)
      problem("solver.kinematics", "`modal` solves linear bodies only; set "
                                   "`solver.kinematics = \"linear\"` or another integrator");
    if (solver.integrator == Integrator::quasi_static &&
        scenario_.tissue.viscosity == tissue::Viscosity::nodal_drag)
      problem("solver.integrator", "`quasi_static` has no drag against the ground; set "
                                   "`solver.integrator = \"backward_difference\"` or another "
                                   "viscosity");
  }

  void times() {
    const Output& output = scenario_.output;
    const double step = scenario_.solver.time_step.value_or(output.interval);
    const double ratio = output.interval / step;
    if (ratio < 0.5 || std::abs(ratio - std::round(ratio)) > 1e-6 * ratio)
      problem("solver.time_step",
              "`time_step` is " + quantity_text(step, unit::ms) + ", which does not fit a whole "
              "number of times into `output.interval` of " +
                  quantity_text(output.interval, unit::ms) + "; choose them so");
    double total = 0.0;
    double travel = 0.0;
    for (const Step& one : scenario_.steps) total += duration(one, travel);
    if (total / output.interval > 1e6)
      problem("output.interval", "the scenario would write " +
                                     rounded_text(total / output.interval) +
                                     " rows a case; use a longer interval");
  }

  static double duration(const Step& step, double& travel) {
    if (const auto* indent = std::get_if<Indent>(&step)) {
      if (indent->to.second) return 0.0;
      const double time = (indent->to.value - travel) / indent->rate;
      travel = indent->to.value;
      return time;
    }
    if (const auto* retract = std::get_if<Retract>(&step)) {
      const double time = (travel - retract->to) / retract->rate;
      travel = retract->to;
      return time;
    }
    if (const auto* hold = std::get_if<Hold>(&step)) return hold->time;
    if (const auto* creep = std::get_if<Creep>(&step)) return creep->load_time + creep->recovery_time;
    return std::get<Relax>(step).time;
  }

  const Scenario& scenario_;
  const Node& document_;
  std::vector<Problem>& problems_;
};

}  // namespace

void check(const Scenario& scenario, const Node& document, std::vector<Problem>& problems) {
  Checker(scenario, document, problems).all();
}

}  // namespace palpate::scenario
