// Travel over time, and a row of results at every output interval.
#include "run/press.h"

#include <cmath>
#include <limits>

#include "contact/friction.h"
#include "contact/hertz.h"
#include "run/hertz_map.h"
#include "run/monitor.h"
#include "run/pace.h"
#include "run/touch.h"

namespace palpate::run {
namespace {

using scenario::Hold;
using scenario::Indent;
using scenario::Retract;

// A step of the programme as travel over time.
struct Ramp {
  double from = 0.0;                                       // m
  double duration = 0.0;                                   // s; infinite until a force
  double force = std::numeric_limits<double>::infinity();  // N, to stop at
  double to = 0.0;                                         // m

  [[nodiscard]] double travel(double time) const {
    return time >= duration ? to : from + (to - from) * time / duration;
  }
};

Ramp make_ramp(const scenario::Step& step, double travel, const scene::Scene& scene) {
  Ramp ramp{.from = travel, .to = travel};
  if (const auto* indent = std::get_if<Indent>(&step)) {
    // A force that never comes must not press for ever: to the radius, where Hertz ends.
    ramp.to = indent->to.second ? std::max(travel, scene.scenario.finger.radius) : indent->to.value;
    if (indent->to.second) ramp.force = indent->to.value;
    ramp.duration = (ramp.to - travel) / indent->rate;
  } else if (const auto* retract = std::get_if<Retract>(&step)) {
    ramp.to = retract->to;
    ramp.duration = (travel - retract->to) / retract->rate;
  } else {
    ramp.duration = std::get<Hold>(step).time;
  }
  return ramp;
}

class Press {
 public:
  Press(const scene::Scene& scene, const std::atomic<bool>& stop, record::CaseRecord& record)
      : scene_(scene), stop_(stop), record_(record) {
    if (!scene.specimen) return;
    const scene::Specimen& specimen = *scene.specimen;
    body_.emplace(specimen.network, specimen.kinematics, specimen.law, specimen.held);
    const Eigen::Index size = body_->mass().size();
    state_.displacement = integrate::Vector::Zero(size);
    state_.velocity = integrate::Vector::Zero(size);
    state_.memory = body_->memory_at(state_.displacement);
    touch_.load = integrate::Vector::Zero(size);
    stepper_.emplace(scene, *body_);
    if (scene.scenario.contact.coupling == contact::Coupling::series)
      series_.emplace(scene, *body_);
    else
      static_.emplace(scene, *body_);
    monitor_.emplace(*body_);
  }

  void all() {
    double travel = 0.0;
    for (std::size_t i = 0; i < scene_.scenario.steps.size(); ++i) {
      step_ = static_cast<int>(i) + 1;
      const Ramp ramp = make_ramp(scene_.scenario.steps[i], travel, scene_);
      if (i == 0) write_row();
      if (ramp.duration <= 0.0) {  // after a step to a force nobody knows the travel beforehand
        record_.remarks.push_back("step " + std::to_string(step_) +
                                  " has nothing to do: the finger is there already");
        continue;
      }
      if (!run(ramp)) return;
      travel = touch_.travel;
      if (scene_.scenario.output.pressure_maps) record_.maps.push_back(draw_map());
    }
    if (monitor_) record_.findings.push_back({"energy_imbalance", monitor_->imbalance()});
  }

 private:
  // False where the case ended early.
  bool run(const Ramp& ramp) {
    const bool to_force = std::isfinite(ramp.force);
    const Pace pace =
        to_force ? make_open_pace(scene_, ramp.duration) : make_pace(scene_, ramp.duration);
    const double start = time_;
    if (stepper_) stepper_->set_step(pace.step());
    for (int row = 0; row < pace.rows; ++row) {
      if (stop_.load()) return end_early(record_, record::Outcome::interrupted, "interrupted");
      for (int k = 1; k <= pace.steps; ++k) {
        const double time = pace.time(row, k);
        if (!advance(ramp.travel(time), start + time)) return false;
        if (touch_.force >= ramp.force) {
          time_ = start + time;
          write_row();
          return true;
        }
      }
      time_ = start + pace.time(row + 1, 0);
      write_row();
      if (scene_.specimen && tissue::inverted(scene_.specimen->mesh, state_.displacement))
        return diverged("a tetrahedron has turned inside out");
    }
    if (to_force) return diverged("the force of the step was not reached");
    return true;
  }

  // To the finger's next travel, m, at `time`, s.
  bool advance(double travel, double time) {
    if (!scene_.specimen) {
      press_half_space(travel);
      return true;
    }
    const integrate::State before = state_;
    const integrate::Vector load_before = touch_.load;
    const auto wrong = series_ ? series_->step(*stepper_, state_, travel, touch_)
                               : step_freely(travel, load_before);
    if (wrong) return diverged(*wrong);
    state_.time = time;  // a sum of steps would carry their rounding
    if (const auto unstable = monitor_->step(before, state_, load_before, touch_.load))
      return diverged(*unstable);
    record_.last_stable_time = time;
    return true;
  }

  void press_half_space(double travel) {
    touch_.travel = travel;
    touch_.indentation = std::max(0.0, travel);
    touch_.force = contact::hertz::force(touch_.indentation, scene_.law.radius, scene_.law.modulus);
    touch_.contact_radius = contact::hertz::contact_radius(touch_.indentation, scene_.law.radius);
  }

  // The force does not wait for the mesh, which moves under it.
  std::optional<std::string> step_freely(double travel, const integrate::Vector& load_before) {
    if (auto wrong = static_->touch(travel, touch_)) return wrong;
    return stepper_->step(state_, load_before, touch_.load, integrate::MemoryRule::exact);
  }

  bool diverged(const std::string& reason) {
    return end_early(record_, record::Outcome::diverged, reason);
  }

  void write_row() {
    const scenario::Contact& contact = scene_.scenario.contact;
    record::ContactRow row;
    row.step = step_;
    row.time = time_;
    row.travel = touch_.travel;
    row.indentation = touch_.indentation;
    row.contact_force = touch_.force;
    row.ambient = contact.ambient_force;
    row.force = touch_.force + contact.ambient_force;
    row.friction = touch_.force > 0.0 ? contact::friction::limit(contact.friction, touch_.force,
                                                                 scene_.finger_weight)
                                      : 0.0;
    row.contact_radius = touch_.contact_radius;
    row.peak_pressure = contact::hertz::peak_pressure(touch_.force, touch_.contact_radius);
    row.tissue_radius = std::numeric_limits<double>::infinity();
    row.contacts = touch_.force > 0.0 ? 1 : 0;
    record_.contact.push_back(row);
    if (!scene_.specimen) record_.last_stable_time = time_;
  }

  record::PressureMap draw_map() const {
    record::PressureMap map = hertz_map(touch_.force, touch_.contact_radius);
    const auto& size = std::get<scenario::Cuboid>(scene_.scenario.tissue.shape).size;
    map.origin += Vec3(0.5 * size[0], 0.5 * size[1], size[2]);
    map.time = time_;
    map.scenario_case = scene_.name;
    map.step = step_;
    return map;
  }

  const scene::Scene& scene_;
  const std::atomic<bool>& stop_;
  record::CaseRecord& record_;
  std::optional<scene::SpringBody> body_;
  std::optional<Stepper> stepper_;
  std::optional<StaticContact> static_;
  std::optional<SeriesContact> series_;
  std::optional<EnergyMonitor> monitor_;
  integrate::State state_;
  Touch touch_;
  double time_ = 0.0;
  int step_ = 1;
};

}  // namespace

void press(const scene::Scene& scene, const std::atomic<bool>& stop, record::CaseRecord& record) {
  Press(scene, stop, record).all();
}

}  // namespace palpate::run
