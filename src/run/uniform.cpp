// Runs creep tests under platen forces and relaxation tests at constant platen travel.
#include "run/pace.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <optional>
#include <string>
#include <variant>

#include "base/stop_scope.h"
#include "contact/viscous_contact.h"
#include "mechanics/monitor.h"
#include "mechanics/stepper.h"
#include "run/picture.h"
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
  UniformTest(const scene::Scene& scene, record::CaseRecord& record)
      : scene_(scene), specimen_(*scene.specimen), record_(record) {
    if (scene.scenario.output.picture || scene.scenario.output.report)
      record_.picture = picture_of(scene);
  }

  void all() {
    for (std::size_t i = 0; i < scene_.scenario.steps.size(); ++i) {
      step_ = static_cast<int>(i) + 1;
      if (!run(scene_.scenario.steps[i])) return;
      if (monitor_) imbalance_ = std::max(imbalance_, monitor_->imbalance());
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
    // Without inertia a standard linear solid has an immediate response and then creeps with an
    // elongation linear in each step; otherwise the load is constant from the start of the step.
    const bool creeps_on = !about(scene_.scenario.solver.integrator).inertia &&
                           specimen_.law.kind == tissue::Viscosity::standard_linear_solid;
    rule_ = creeps_on ? MemoryRule::exact : MemoryRule::held;
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

  // The reaction of the specimen over the area of the top, Pa.
  [[nodiscard]] double stress() const {
    double sum = 0.0;
    for (const int node : specimen_.pressed.top) sum -= state_.force[3 * node + 2];
    if (body_->has_dashpots()) {
      Vector dashpots;
      body_->dashpot_force(state_.displacement, state_.velocity, dashpots);
      for (const int node : specimen_.pressed.top) sum -= dashpots[3 * node + 2];
    }
    return sum / specimen_.pressed.area;
  }

  // Without inertia, and where springs do not turn, the specimen keeps the shape of statics and
  // follows its law of time, which is one for all its springs.    docs/theory.md [compression]
  [[nodiscard]] bool keeps_shape() const {
    return !about(scene_.scenario.solver.integrator).inertia &&
           specimen_.kinematics == tissue::Kinematics::linear;
  }

  bool run(const scenario::Step& step) {
    if (const auto* loaded = std::get_if<Creep>(&step))
      return keeps_shape() ? creep_in_shape(*loaded) : creep(*loaded);
    if (const auto* strained = std::get_if<Relax>(&step))
      return keeps_shape() ? relax_in_shape(*strained) : relax(*strained);
    return compress(std::get<Compress>(step));
  }

  bool creep(const Creep& creep) {
    fresh(specimen_.held);
    const Vector load = platen_load(creep.stress);
    const Vector none = Vector::Zero(load.size());
    if (!load_jumps(none, load)) return false;
    write_row(creep.stress);
    if (!march({none, load, creep.load_time, creep.stress, true})) return false;
    if (creep.recovery_time <= 0.0) return true;
    return load_jumps(load, none) && march({load, none, creep.recovery_time, 0.0, true});
  }

  // The creep function of the law under the load, less that of the unloading after it.
  //                                                    docs/theory.md [fit_creep], [fit_recovery]
  bool creep_in_shape(const Creep& creep) {
    const scene::SpringBody elastic(specimen_.network, specimen_.kinematics, {}, specimen_.held);
    state_ = {};
    state_.displacement = state_.velocity = Vector::Zero(elastic.mass().size());
    integrate::Implicit statics(elastic, integrate::Implicit::Inertia::none);
    if (const auto wrong = mechanics::solve_step(statics, elastic, state_, 0.0, MemoryRule::at_once,
                                                 platen_load(creep.stress)))
      return diverged(*wrong);
    const double settled = strain();
    const bool folds = tissue::inverted(specimen_.mesh, state_.displacement);
    const contact::Creep law = contact::creep(scene::relaxation_of(specimen_.law));
    const double start = time_;
    const auto row = [&](double after, double stress, double ratio) {
      StopScope::end_if_stopped();
      add_row(start + after, stress, ratio * settled);
      return !folds || !tissue::inverted(specimen_.mesh, ratio * state_.displacement) ||
             diverged(folded);
    };
    if (!row(0.0, creep.stress, law.compliance_ratio(0.0))) return false;
    const Pace loading = make_pace(scene_, creep.load_time);
    for (int k = 1; k <= loading.rows; ++k)
      if (!row(loading.time(k, 0), creep.stress, law.compliance_ratio(loading.time(k, 0))))
        return false;
    if (creep.recovery_time <= 0.0) return true;
    const Pace recovering = make_pace(scene_, creep.recovery_time);
    for (int k = 1; k <= recovering.rows; ++k) {
      const double after = recovering.time(k, 0);
      if (!row(creep.load_time + after, 0.0, law.recovery_ratio(creep.load_time, after)))
        return false;
    }
    return true;
  }

  // The stress is the relaxed modulus times the law's response to the strain.
  //                                                                 docs/theory.md [compression]
  bool compress(const Compress& compress) {
    const contact::Relaxation law = scene::relaxation_of(specimen_.law);
    return follow(compress.strain, {compress.ramp_time(), compress.hold_time}, [&](double after) {
      return std::array{law.ramp_response(compress.rate, compress.ramp_time(), after),
                        compress.strain_at(after)};
    });
  }

  // A strain that is applied at once and kept.        docs/theory.md [branches], [fit_relaxation]
  bool relax_in_shape(const Relax& relax) {
    const contact::Relaxation law = scene::relaxation_of(specimen_.law);
    return follow(relax.strain, {relax.time}, [&](double after) {
      return std::array{relax.strain * law.modulus_ratio(after), relax.strain};
    });
  }

  // Rows of stress over the relaxed modulus and of strain, during times that follow each other (s).
  template <class At>
  bool follow(double largest_strain, std::initializer_list<double> durations, const At& at) {
    const tissue::Uniaxial& pressed = specimen_.pressed;
    if (tissue::inverted(specimen_.mesh, largest_strain * pressed.displacement))
      return diverged("a tetrahedron would turn inside out; give a smaller strain");
    const double start = time_;
    const auto row = [&](double after) {
      const auto [response, strain] = at(after);
      add_row(start + after, pressed.young_modulus * response, strain);
    };
    row(0.0);
    double begun = 0.0;
    for (const double duration : durations) {
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
    body_->look(state_);
    monitor_->begin(state_);
    write_row(stress());
    return march({none, none, relax.time, std::nullopt, false});
  }

  // Applies a jump of the load: without inertia, tissue other than Kelvin-Voigt deforms at once.
  bool load_jumps(const Vector& from, const Vector& to) {
    const bool at_once = !about(scene_.scenario.solver.integrator).inertia &&
                         specimen_.law.kind != tissue::Viscosity::kelvin_voigt;
    if (at_once) {
      const State before = state_;
      integrate::Implicit statics(*body_, integrate::Implicit::Inertia::none);
      if (const auto wrong =
              mechanics::solve_step(statics, *body_, state_, 0.0, MemoryRule::at_once, to))
        return diverged(*wrong);
      if (const auto wrong = monitor_->step(before, state_, from, to)) return diverged(*wrong);
    }
    return true;
  }

  // Steps through a stage, row by row.
  bool march(const Stage& stage) {
    const Pace pace = make_pace(scene_, stage.duration);
    const int beginnings = stepper_->beginnings();
    stepper_->set_step(pace.step());
    // Central differences that continue through a jump of the load take the mean of both loads
    // in the next step, which preserves their order.  docs/theory.md, below [first_step]
    bool met_by_mean =
        stage.jumps && stepper_->beginnings() == beginnings &&
        scene_.scenario.solver.integrator == scenario::Solver::Integrator::central_difference;
    const double start = time_;
    State before;
    for (int row = 0; row < pace.rows; ++row) {
      for (int k = 1; k <= pace.steps; ++k) {
        StopScope::end_if_stopped();
        before = state_;
        const Vector moving =
            met_by_mean ? Vector(0.5 * (stage.load_before + stage.load)) : Vector();
        if (const auto wrong =
                stepper_->step(state_, met_by_mean ? moving : stage.load, stage.load, rule_))
          return diverged(*wrong);
        met_by_mean = false;
        state_.time = start + pace.time(row, k);  // a sum of steps would accumulate rounding errors
        if (const auto wrong = monitor_->step(before, state_, stage.load, stage.load))
          return diverged(*wrong);
        record_.last_stable_time = state_.time;
      }
      time_ = start + pace.time(row + 1, 0);
      write_row(stage.stress ? *stage.stress : stress());
      if (tissue::inverted(specimen_.mesh, state_.displacement)) return diverged(folded);
    }
    return true;
  }

  bool diverged(const std::string& reason) {
    return end_early(record_, record::Outcome::diverged, reason);
  }

  void write_row(double stress) { record_.add(record::StrainRow{step_, time_, stress, strain()}); }

  // A row of a closed form.
  void add_row(double time, double stress, double strain) {
    time_ = time;
    record_.add(record::StrainRow{step_, time, stress, strain});
    record_.last_stable_time = time;
  }

  static constexpr const char* folded =
      "a tetrahedron has turned inside out; give a smaller load, or set `solver.kinematics = "
      "\"nonlinear\"`";

  const scene::Scene& scene_;
  const scene::Specimen& specimen_;
  record::CaseRecord& record_;
  std::optional<scene::SpringBody> body_;
  std::optional<mechanics::EnergyMonitor> monitor_;
  std::optional<mechanics::Stepper> stepper_;
  MemoryRule rule_ = MemoryRule::exact;
  State state_;
  double imbalance_ = 0.0;
  double time_ = 0.0;
  int step_ = 1;
};

}  // namespace

void load_uniformly(const scene::Scene& scene, record::CaseRecord& record) {
  UniformTest(scene, record).all();
}

}  // namespace palpate::run
