// Runs creep tests under platen forces and relaxation tests at constant platen travel.
#include "run/uniform.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "run/pace.h"
#include "scenario/integrators.h"

namespace palpate::run {
namespace {

using integrate::MemoryRule;
using integrate::State;
using integrate::Vector;
using scenario::Compress;
using scenario::Creep;
using scenario::Relax;

class UniformTest {
 public:
  UniformTest(const scene::Scene& scene, const std::atomic<bool>& stop, record::CaseRecord& record)
      : scene_(scene), specimen_(*scene.specimen), stop_(stop), record_(record) {}

  Course all() {
    for (std::size_t i = 0; i < scene_.scenario.steps.size(); ++i) {
      step_ = static_cast<int>(i) + 1;
      const scenario::Step& step = scene_.scenario.steps[i];
      if (const auto* compressed = std::get_if<Compress>(&step)) {
        if (!compress(*compressed)) co_return;
        continue;
      }
      if (const auto* loaded = std::get_if<Creep>(&step); loaded != nullptr && keeps_shape()) {
        if (!creep_in_shape(*loaded)) co_return;
        continue;
      }
      const bool going = std::holds_alternative<Creep>(step) ? creep(std::get<Creep>(step))
                                                             : relax(std::get<Relax>(step));
      if (!going) co_return;
      for (const Stage& stage : stages_) {
        if (!begin(stage)) co_return;
        const Pace pace = make_pace(scene_, stage.duration);
        const int beginnings = stepper_->beginnings();
        stepper_->set_step(pace.step());
        // Central differences that continue through a jump of the load take the mean of both loads
        // in the next step, which preserves their order.       docs/theory.md, below (39) and (81)
        const bool met_by_mean =
            stage.jumps && stepper_->beginnings() == beginnings &&
            scene_.scenario.solver.integrator == scenario::Solver::Integrator::central_difference;
        const double start = time_;
        for (int row = 0; row < pace.rows; ++row) {
          march_.load = tissue::sparse(stage.load);
          // A row may have any number of steps, and an interrupt does not wait for all of them.
          constexpr int portion = 1024;
          for (int done = 0; done < pace.steps; done += portion) {
            if (stop_.load()) {
              (void)end_early(record_, record::Outcome::interrupted, "interrupted");
              co_return;
            }
            march_.clear();
            if (row == 0 && done == 0 && met_by_mean)
              march_.first_load = tissue::sparse(0.5 * (stage.load_before + stage.load));
            const int end = std::min(done + portion, pace.steps);
            march_.force_wanted = !stage.stress && end == pace.steps;
            for (int k = done + 1; k <= end; ++k) march_.times.push_back(start + pace.time(row, k));
            co_yield march_;
            if (march_.done > 0) record_.last_stable_time = march_.times[march_.done - 1];
            if (march_.wrong && !diverged(*march_.wrong)) co_return;
          }
          time_ = start + pace.time(row + 1, 0);
          write_row(stage.stress ? *stage.stress : stress_of(march_.force));
          if (tissue::inverted(specimen_.mesh, state_.displacement) &&
              !diverged("a tetrahedron has turned inside out; give a smaller load, or set "
                        "`solver.kinematics = \"nonlinear\"`"))
            co_return;
        }
      }
      imbalance_ = std::max(imbalance_, monitor_->imbalance());
    }
    if (monitor_) record_.findings.push_back({"energy_imbalance", imbalance_});
  }

 private:
  // A time under constant load. `stress` (Pa) is that of the rows; if empty, it is measured.
  struct Stage {
    Vector load_before, load;  // N
    double duration = 0.0;     // s
    std::optional<double> stress;
    bool jumps = false;  // the load changes from load_before to load at the start
  };

  void fresh(const std::vector<char>& held) {
    body_.emplace(specimen_.network, specimen_.kinematics, specimen_.law, held);
    const Eigen::Index size = body_->mass().size();
    state_ = {};
    state_.time = time_;
    state_.displacement = Vector::Zero(size);
    state_.velocity = Vector::Zero(size);
    state_.memory = body_->memory_at(state_.displacement);
    monitor_.emplace(*body_);
    stepper_.emplace(scene_, *body_);
    march_.body = &*body_;
    march_.monitor = &*monitor_;
    march_.stepper = &*stepper_;
    march_.state = &state_;
    ++march_.standing;
    // Without inertia a standard linear solid has an immediate response and then creeps with an
    // elongation linear in each step; otherwise the load is constant from the start of the step.
    const bool creeps_on = !about(scene_.scenario.solver.integrator).inertia &&
                           specimen_.law.kind == tissue::Viscosity::standard_linear_solid;
    march_.rule = creeps_on ? MemoryRule::exact : MemoryRule::held;
    stages_.clear();
  }

  // The platen's downward force, distributed over the nodes of the top by the platen shares, N.
  [[nodiscard]] Vector platen_load(double stress) const {
    Vector load = Vector::Zero(3 * specimen_.network.nodes());
    const tissue::Uniaxial& pressed = specimen_.pressed;
    for (std::size_t j = 0; j < pressed.top.size(); ++j)
      load[3 * pressed.top[j] + 2] = -stress * pressed.area * pressed.shares[j];
    return load;
  }

  // The platen's travel over the height: the mean displacement weighted by the platen shares.
  [[nodiscard]] double strain() const {
    const tissue::Uniaxial& pressed = specimen_.pressed;
    double sum = 0.0;
    for (std::size_t j = 0; j < pressed.top.size(); ++j)
      sum -= pressed.shares[j] * state_.displacement[3 * pressed.top[j] + 2];
    return sum / pressed.height;
  }

  // The reaction of the specimen over the area of the top, Pa; `force` (N) is that of the springs.
  [[nodiscard]] double stress_of(const Vector& force) const {
    double sum = 0.0;
    for (const int node : specimen_.pressed.top) sum -= force[3 * node + 2];
    if (body_->has_dashpots()) {
      Vector dashpots;
      body_->dashpot_force(state_.displacement, state_.velocity, dashpots);
      for (const int node : specimen_.pressed.top) sum -= dashpots[3 * node + 2];
    }
    return sum / specimen_.pressed.area;
  }

  bool creep(const Creep& creep) {
    fresh(specimen_.held);
    const Vector load = platen_load(creep.stress);
    const Vector none = Vector::Zero(load.size());
    stages_.push_back({none, load, creep.load_time, creep.stress, true});
    if (creep.recovery_time > 0.0) stages_.push_back({load, none, creep.recovery_time, 0.0, true});
    return true;
  }

  // Whether a creep moves the specimen in the shape of statics, by the creep of Kelvin-Voigt
  // tissue.
  [[nodiscard]] bool keeps_shape() const {
    return !about(scene_.scenario.solver.integrator).inertia &&
           specimen_.kinematics == tissue::Kinematics::linear &&
           specimen_.law.kind == tissue::Viscosity::kelvin_voigt;
  }

  // tau J' + J = 1 under the load and 0 after it.                         docs/theory.md (35)
  bool creep_in_shape(const Creep& creep) {
    const scene::SpringBody elastic(specimen_.network, specimen_.kinematics, {}, specimen_.held);
    state_ = {};
    state_.displacement = state_.velocity = Vector::Zero(elastic.mass().size());
    state_.memory = elastic.memory_at(state_.displacement);
    integrate::Implicit statics(elastic, integrate::Implicit::Inertia::none);
    if (const auto wrong = mechanics::solve_step(statics, elastic, state_, 0.0, MemoryRule::at_once,
                                                 platen_load(creep.stress)))
      return diverged(*wrong);
    const double settled = strain();
    const bool folds = tissue::inverted(specimen_.mesh, state_.displacement);
    const double start = time_;
    const auto row = [&](double after, double stress, double crept) {
      if (stop_.load()) return end_early(record_, record::Outcome::interrupted, "interrupted");
      time_ = start + after;
      record_.add(record::StrainRow{step_, time_, stress, crept * settled});
      record_.last_stable_time = time_;
      return !folds || !tissue::inverted(specimen_.mesh, crept * state_.displacement) ||
             diverged(
                 "a tetrahedron has turned inside out; give a smaller load, or set "
                 "`solver.kinematics = \"nonlinear\"`");
    };
    const auto passed = [&](double duration) { return std::exp(-duration / specimen_.law.time); };
    if (!row(0.0, creep.stress, 0.0)) return false;
    const Pace loading = make_pace(scene_, creep.load_time);
    for (int k = 1; k <= loading.rows; ++k)
      if (!row(loading.time(k, 0), creep.stress, 1.0 - passed(loading.time(k, 0)))) return false;
    if (creep.recovery_time <= 0.0) return true;
    const Pace recovering = make_pace(scene_, creep.recovery_time);
    for (int k = 1; k <= recovering.rows; ++k) {
      const double after = recovering.time(k, 0);
      if (!row(creep.load_time + after, 0.0, (1.0 - passed(creep.load_time)) * passed(after)))
        return false;
    }
    return true;
  }

  // Without inertia all forces of the specimen follow one law of time: its shape is that of
  // statics, and its stress the relaxed modulus times the law's response to the strain.
  //                                                                      docs/theory.md (52a)
  bool compress(const Compress& compress) {
    const tissue::Uniaxial& pressed = specimen_.pressed;
    if (tissue::inverted(specimen_.mesh, compress.strain * pressed.displacement))
      return diverged("a tetrahedron would turn inside out; give a smaller strain");
    const contact::Relaxation law = scene::relaxation_of(specimen_.law);
    const double start = time_;
    const auto row = [&](double after) {
      time_ = start + after;
      const double response = law.ramp_response(compress.rate, compress.ramp_time(), after);
      record_.add(record::StrainRow{step_, time_, pressed.young_modulus * response,
                                    compress.strain_at(after)});
      record_.last_stable_time = time_;
    };
    row(0.0);
    double begun = 0.0;
    for (const double duration : {compress.ramp_time(), compress.hold_time}) {
      if (duration == 0.0) continue;
      const Pace pace = make_pace(scene_, duration);
      for (int k = 1; k <= pace.rows; ++k) row(begun + pace.time(k, 0));
      begun += duration;
    }
    return true;
  }

  bool relax(const Relax& relax) {
    fresh(specimen_.held_between_platens);
    // The strain is applied at once: the specimen starts in its static shape, at rest.
    state_.displacement = relax.strain * specimen_.pressed.displacement;
    state_.memory = body_->memory_at(Vector::Zero(state_.displacement.size()));
    const Vector none = Vector::Zero(state_.displacement.size());
    integrate::Implicit statics(*body_, integrate::Implicit::Inertia::none);
    if (const auto wrong =
            mechanics::solve_step(statics, *body_, state_, 0.0, MemoryRule::at_once, none))
      return diverged(*wrong);
    state_.memory = body_->memory_at(state_.displacement);
    monitor_->begin(state_);
    Vector force;
    body_->force(state_.displacement, state_.memory, force);
    write_row(stress_of(force));
    stages_.push_back({none, none, relax.time, std::nullopt, false});
    return true;
  }

  // Applies a jump of the load: without inertia, tissue other than Kelvin-Voigt deforms at once.
  bool begin(const Stage& stage) {
    if (!stage.jumps) return true;
    const bool at_once = !about(scene_.scenario.solver.integrator).inertia &&
                         specimen_.law.kind != tissue::Viscosity::kelvin_voigt;
    if (at_once) {
      const State before = state_;
      integrate::Implicit statics(*body_, integrate::Implicit::Inertia::none);
      if (const auto wrong =
              mechanics::solve_step(statics, *body_, state_, 0.0, MemoryRule::at_once, stage.load))
        return diverged(*wrong);
      if (const auto wrong = monitor_->step(before, state_, stage.load_before, stage.load))
        return diverged(*wrong);
    }
    if (&stage == &stages_.front()) write_row(*stage.stress);
    return true;
  }

  bool diverged(const std::string& reason) {
    return end_early(record_, record::Outcome::diverged, reason);
  }

  void write_row(double stress) { record_.add(record::StrainRow{step_, time_, stress, strain()}); }

  const scene::Scene& scene_;
  const scene::Specimen& specimen_;
  const std::atomic<bool>& stop_;
  record::CaseRecord& record_;
  std::optional<scene::SpringBody> body_;
  std::optional<mechanics::EnergyMonitor> monitor_;
  std::optional<mechanics::Stepper> stepper_;
  std::vector<Stage> stages_;
  March march_;
  State state_;
  double imbalance_ = 0.0;
  double time_ = 0.0;
  int step_ = 1;
};

}  // namespace

void load_uniformly(const scene::Scene& scene, const std::atomic<bool>& stop,
                    record::CaseRecord& record) {
  carry_out(uniform_course(scene, stop, record));
}

Course uniform_course(const scene::Scene& scene, const std::atomic<bool>& stop,
                      record::CaseRecord& record) {
  UniformTest test(scene, stop, record);
  for (Course course = test.all(); March* march = course.next();) co_yield *march;
}

}  // namespace palpate::run
