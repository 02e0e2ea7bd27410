// Creep by platen forces, relaxation by a platen's travel.
#include "run/uniform.h"

#include <cmath>
#include <utility>

#include "run/contact_step.h"
#include "run/monitor.h"

namespace palpate::run {
namespace {

using integrate::MemoryRule;
using integrate::State;
using integrate::Vector;
using scenario::Creep;
using scenario::Relax;

// Solves a step without contact. Returns what is wrong where it does not settle.
template <class Linearised>
std::optional<std::string> solve(Linearised& method, const scene::SpringBody& body, State& state,
                                 double time_step, MemoryRule rule, const Vector& load) {
  Vector displacement = state.displacement;
  method.begin(state, time_step, rule);
  constexpr int most_linearisations = 100;
  const double settled = 1e-12 * (1.0 + displacement.cwiseAbs().maxCoeff());
  for (int i = 0; i < most_linearisations; ++i) {
    if (!method.linearise(displacement, load)) return "the tangent stiffness is not positive";
    const double change = (method.base() - displacement).cwiseAbs().maxCoeff();
    displacement = method.base();
    if (!std::isfinite(change)) return "the motion has left the finite numbers";
    if (body.linear() || change <= settled) {
      method.finish(state, displacement, load);
      return std::nullopt;
    }
  }
  return "the non-linear equations did not settle in 100 iterations";
}

class UniformTest {
 public:
  UniformTest(const scene::Scene& scene, const std::atomic<bool>& stop, record::CaseRecord& record)
      : scene_(scene), specimen_(*scene.specimen), stop_(stop), record_(record) {}

  void all() {
    for (std::size_t i = 0; i < scene_.scenario.steps.size(); ++i) {
      step_ = static_cast<int>(i) + 1;
      const scenario::Step& step = scene_.scenario.steps[i];
      const bool going = std::holds_alternative<Creep>(step) ? creep(std::get<Creep>(step))
                                                             : relax(std::get<Relax>(step));
      if (!going) return;
    }
    record_.findings.push_back({"energy_imbalance", imbalance_});
  }

 private:
  void fresh(const std::vector<char>& held) {
    body_.emplace(specimen_.network, specimen_.kinematics, specimen_.law, held);
    const Eigen::Index size = body_->mass().size();
    state_ = {};
    state_.time = time_;
    state_.displacement = Vector::Zero(size);
    state_.velocity = Vector::Zero(size);
    state_.memory = body_->memory_at(state_.displacement);
    monitor_.emplace(*body_);
    method_.reset();
    method_step_ = 0.0;
  }

  // The platen's force as shares on the nodes under it, pressing down.
  [[nodiscard]] Vector platen_load(double stress) const {
    Vector load = Vector::Zero(3 * specimen_.network.nodes());
    const tissue::Uniaxial& pressed = specimen_.pressed;
    for (std::size_t j = 0; j < pressed.top.size(); ++j)
      load[3 * pressed.top[j] + 2] = -stress * pressed.area * pressed.shares[j];
    return load;
  }

  // The platen's travel over the height: sinkings weighted as the platen's force is.
  [[nodiscard]] double strain() const {
    const tissue::Uniaxial& pressed = specimen_.pressed;
    double sum = 0.0;
    for (std::size_t j = 0; j < pressed.top.size(); ++j)
      sum -= pressed.shares[j] * state_.displacement[3 * pressed.top[j] + 2];
    return sum / pressed.height;
  }

  // The force with which the specimen pushes back over the top's area.
  [[nodiscard]] double stress() const {
    Vector force;
    body_->force(state_.displacement, state_.memory, force);
    double sum = 0.0;
    for (const int node : specimen_.pressed.top) sum -= force[3 * node + 2];
    if (body_->has_dashpots()) {
      body_->dashpot_force(state_.displacement, state_.velocity, force);
      for (const int node : specimen_.pressed.top) sum -= force[3 * node + 2];
    }
    return sum / specimen_.pressed.area;
  }

  bool creep(const Creep& creep) {
    fresh(specimen_.held);
    const Vector load = platen_load(creep.stress);
    const Vector none = Vector::Zero(load.size());
    if (!jump(none, load)) return false;
    row(creep.stress);
    if (!march(load, creep.load_time, [&] { row(creep.stress); })) return false;
    if (creep.recovery_time <= 0.0) return ended();
    if (!jump(load, none)) return false;
    return march(none, creep.recovery_time, [&] { row(0.0); }) && ended();
  }

  bool relax(const Relax& relax) {
    fresh(specimen_.held_between_platens);
    // The strain is applied at once and evenly: the specimen starts in the static shape that the
    // platens give it, at rest.
    state_.displacement = relax.strain * specimen_.pressed.displacement;
    state_.memory = body_->memory_at(Vector::Zero(state_.displacement.size()));
    const Vector none = Vector::Zero(state_.displacement.size());
    integrate::Implicit statics(*body_, integrate::Implicit::Inertia::none);
    if (const auto wrong = solve(statics, *body_, state_, 0.0, MemoryRule::at_once, none))
      return diverged(*wrong);
    state_.memory = body_->memory_at(state_.displacement);
    monitor_->begin(state_);
    row(stress());
    return march(none, relax.time, [&] { row(stress()); }) && ended();
  }

  bool ended() {
    imbalance_ = std::max(imbalance_, monitor_->imbalance());
    return true;
  }

  // A load that changes at once: without inertia, a standard linear solid gives way at once too.
  bool jump(const Vector& from, const Vector& to) {
    const bool at_once =
        scene_.scenario.solver.integrator == scenario::Solver::Integrator::quasi_static &&
        specimen_.law.kind != tissue::Viscosity::kelvin_voigt;
    if (at_once) {
      const State before = state_;
      integrate::Implicit statics(*body_, integrate::Implicit::Inertia::none);
      if (const auto wrong = solve(statics, *body_, state_, 0.0, MemoryRule::at_once, to))
        return diverged(*wrong);
      if (const auto wrong = monitor_->step(before, state_, from, to)) return diverged(*wrong);
    }
    if (method_)
      if (auto* central = std::get_if<integrate::CentralDifference>(&*method_)) central->restart();
    return true;
  }

  [[nodiscard]] int steps_a_row() const {
    return static_cast<int>(
               std::lround(scene_.scenario.output.interval / specimen_.plan.time_step)) *
           specimen_.plan.substeps;
  }
  [[nodiscard]] double rows_of(double duration) const {
    return std::max(1.0, std::ceil(duration / scene_.scenario.output.interval - 1e-6));
  }
  [[nodiscard]] double spacing_of(double duration) const { return duration / rows_of(duration); }

  void start_method(double time_step) {
    const bool fixed_step =
        method_ && std::holds_alternative<integrate::CentralDifference>(*method_);
    if (!method_ || (fixed_step && method_step_ != time_step))
      method_.emplace(make_method(scene_, *body_, time_step));
    method_step_ = time_step;
  }

  template <class Row>
  bool march(const Vector& load, double duration, const Row& write) {
    const double rows = rows_of(duration);
    const double spacing = spacing_of(duration);
    const int steps = steps_a_row();
    start_method(spacing / steps);
    const double start = time_;
    for (double row_number = 1; row_number <= rows; ++row_number) {
      if (stop_.load()) {
        record_.outcome = record::Outcome::interrupted;
        record_.reason = "interrupted";
        return false;
      }
      for (int k = 0; k < steps; ++k)
        if (!advance(load, spacing / steps)) return false;
      time_ = start + spacing * row_number;
      state_.time = time_;
      write();
      if (tissue::inverted(specimen_.mesh, state_.displacement))
        return diverged("a tetrahedron has turned inside out");
    }
    return true;
  }

  bool advance(const Vector& load, double time_step) {
    const State before = state_;
    std::optional<std::string> wrong;
    if (auto* central = std::get_if<integrate::CentralDifference>(&*method_)) {
      central->step(state_, load);
    } else if (auto* implicit = std::get_if<integrate::Implicit>(&*method_)) {
      // Under a held load Kelvin-Voigt's tension is held too, from the jump on.
      const bool held = specimen_.law.kind == tissue::Viscosity::kelvin_voigt;
      wrong = solve(*implicit, *body_, state_, time_step,
                    held ? MemoryRule::held : MemoryRule::exact, load);
    } else {
      wrong = solve(std::get<integrate::Modal>(*method_), *body_, state_, time_step,
                    MemoryRule::held, load);
    }
    if (!wrong) wrong = monitor_->step(before, state_, load, load);
    if (wrong) return diverged(*wrong);
    record_.last_stable_time = state_.time;
    return true;
  }

  bool diverged(const std::string& reason) {
    record_.outcome = record::Outcome::diverged;
    record_.reason = reason;
    return false;
  }

  void row(double stress) { record_.strain.push_back({step_, time_, stress, strain()}); }

  const scene::Scene& scene_;
  const scene::Specimen& specimen_;
  const std::atomic<bool>& stop_;
  record::CaseRecord& record_;
  std::optional<scene::SpringBody> body_;
  std::optional<EnergyMonitor> monitor_;
  std::optional<Method> method_;
  double method_step_ = 0.0;
  State state_;
  double imbalance_ = 0.0;
  double time_ = 0.0;
  int step_ = 1;
};

}  // namespace

void load_uniformly(const scene::Scene& scene, const std::atomic<bool>& stop,
                    record::CaseRecord& record) {
  UniformTest(scene, stop, record).all();
}

}  // namespace palpate::run
