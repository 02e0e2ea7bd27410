// Follows the finger along straight lines between readings.
#include "live/loop.h"

#include "base/stopwatch.h"
#include "mechanics/half_space_contact.h"
#include "run/bench.h"
#include "scene/first_touch.h"

namespace palpate::live {

LiveModel::LiveModel(const scene::Scene& scene) : scene_(&scene), history_(std::in_place, scene) {
  if (!scene.specimen) {
    touch_.contacts.make_room(scene.finger.centres.size(), [](mechanics::SphereContact&) {});
    first_ = scene::pressed_place(scene);
    touch_.finger = first_ + scene.finger.sphere_radius * Vec3::UnitZ();
    return;
  }
  mesh_.emplace(scene);
  step_ = scene.specimen->plan.substep;
  mesh_->set_step(step_);
  first_ = scene::first_touch(scene).finger;
  touch_.finger = first_;
  mesh_->make_ready(touch_);
}

std::optional<std::string> LiveModel::go_to(const Vec3& offset, double time) {
  const double passed = any_ ? time - time_ : 0.0;
  if (!any_) {
    any_ = true;
    begin_ = time;
    offset_ = offset;
  }
  const Vec3 from = offset_;
  const double start = time_;
  offset_ = offset;
  time_ = time;
  const auto set = [&](const Vec3& place) {
    touch_.travel = 0.0 - place.z();
    touch_.slide = std::hypot(place.x(), place.y());
  };
  if (!mesh_) {
    set(offset);
    const Vec3 sideways(offset.x(), offset.y(), 0.0);
    if (auto wrong = mechanics::press_half_space(*scene_, first_ + sideways, touch_)) return wrong;
    history_->pass(*scene_, passed, touch_);
    return std::nullopt;
  }
  // Times are step numbers times the step, without the rounding errors of a sum.
  constexpr double rounding = 1e-6;  // of a step
  while (begin_ + (static_cast<double>(steps_ + 1) - rounding) * step_ <= time) {
    ++steps_;
    const double now = static_cast<double>(steps_) * step_;
    const double share = passed > 0.0 ? std::clamp((begin_ + now - start) / passed, 0.0, 1.0) : 1.0;
    const Vec3 place = from + share * (offset - from);
    set(place);
    if (auto wrong = mesh_->step(first_ + place, now, *history_, touch_)) return wrong;
  }
  return std::nullopt;
}

bool LiveModel::start_again() {
  if (wrong_ || (mesh_ && !mesh_->forces_follow_finger())) return false;
  history_.emplace(*scene_);
  touch_.contacts.clear();
  touch_.travel = touch_.slide = 0.0;
  touch_.finger = mesh_ ? first_ : Vec3(first_ + scene_->finger.sphere_radius * Vec3::UnitZ());
  offset_ = Vec3::Zero();
  time_ = begin_ = 0.0;
  steps_ = 0;
  any_ = false;
  return true;
}

std::optional<std::string> LiveModel::follow(const Vec3& offset, double time) {
  if (!wrong_) wrong_ = go_to(offset, time);
  return wrong_;
}

Vec3 LiveModel::force() const {
  Vec3 sum = Vec3::Zero();
  for (const mechanics::SphereContact& contact : touch_.contacts)
    sum += contact.force * contact.patch.normal - contact.drag;
  return sum;
}

std::optional<double> LiveModel::imbalance() {
  return mesh_ ? std::optional(mesh_->imbalance()) : std::nullopt;
}

FrameCost predict_cost(const scene::Scene& scene, LiveModel& model, double frame, int frames) {
  const double deepest = scene::deepest_travel(scene.scenario, scene.law());
  std::vector<double> times;
  FrameCost cost;
  const int all = 2 * frames;
  for (int i = 0; i <= all; ++i) {
    const Stopwatch watch;
    if (model.follow(Vec3(0.0, 0.0, -deepest * i / all), frame * i)) break;
    if (i > frames) times.push_back(watch.seconds());
  }
  cost.force = model.touch().force();
  if (times.empty()) return cost;
  cost.median = run::percentile(times, 0.5);
  cost.p99 = run::percentile(times, 0.99);
  return cost;
}

}  // namespace palpate::live
