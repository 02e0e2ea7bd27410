// Runs cases in lanes. Each lane has its own case and time, and takes the next case when one ends.
#include "run/lanes.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>

#include "run/march.h"
#include "run/uniform.h"
#include "tissue/lane_springs.h"

namespace palpate::run {
namespace {

using tissue::LaneSprings;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

bool alike(const scene::Specimen& a, const scene::Specimen& b) {
  return a.law.kind == b.law.kind && a.law.branches.size() == b.law.branches.size() &&
         LaneSprings::alike(a.network, b.network);
}

// The case in a lane.
struct Place {
  std::size_t number = 0;
  record::CaseRecord record;
  std::optional<Course> course;
  March* march = nullptr;  // null: the lane is empty
  std::size_t step = 0;    // index of the march's next step
  bool entered = false;    // the body has been loaded into the lane
  int standing = 0;        // March::standing of the body in the lane
  int beginnings = 0;      // Stepper::beginnings() of the body in the lane
};

class Team {
 public:
  Team(const std::vector<scene::Scene>& scenes, LaneQueue& queue, const Stop& stop,
       const LaneCalls& calls)
      : scenes_(scenes),
        queue_(queue),
        stop_(stop),
        calls_(calls),
        lanes_(scenes[queue.group.front()].specimen->network,
               scenes[queue.group.front()].specimen->law) {}

  void run(std::size_t lanes) {
    for (std::size_t lane = 0; lane < lanes; ++lane) fill(lane);
    for (std::size_t busy = count_busy(); busy > 0; busy = count_busy()) {
      const Clock::time_point start = Clock::now();
      lanes_.step();
      const double share = seconds_since(start) / static_cast<double>(busy);
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        if (places_[lane].march == nullptr) continue;
        places_[lane].record.seconds += share;
        settle(lane);
        if (places_[lane].march == nullptr) fill(lane);
      }
    }
  }

 private:
  [[nodiscard]] std::size_t count_busy() const {
    std::size_t busy = 0;
    for (const Place& place : places_) busy += place.march != nullptr ? 1 : 0;
    return busy;
  }

  // Begins cases until one needs steps of its mesh.
  void fill(std::size_t lane) {
    while (places_[lane].march == nullptr && !stop_.no_more()) {
      const std::size_t taken = queue_.next++;
      if (taken >= queue_.group.size()) return;
      const Clock::time_point start = Clock::now();
      Place& place = places_[lane];
      place = {};
      place.number = queue_.group[taken];
      place.record = calls_.begin(place.number);
      const scene::Scene& scene = scenes_[place.number];
      // The course refers to place.record, which is not moved while the course runs.
      place.course.emplace(uniform_course(scene, stop_.end_now, place.record));
      go_on(lane, start);
    }
  }

  // Continues the case to its next march, or to its end.
  void go_on(std::size_t lane, Clock::time_point start) {
    Place& place = places_[lane];
    place.march = place.course->next();
    if (place.march == nullptr) {
      place.course.reset();
      lanes_.leave(lane);
      place.record.seconds += seconds_since(start);
      calls_.end(place.number, std::move(place.record));
      return;
    }
    const March& march = *place.march;
    const scene::SpringBody& body = *march.body;
    const bool anew = march.standing != place.standing || !place.entered;
    place.entered = true;
    if (anew) {
      lanes_.enter(lane, body.network(), body.law(), body.held());
      body.force(march.state->displacement, march.state->memory, force_);
      lanes_.place(
          lane, {&march.state->displacement, &march.state->velocity, &force_, march.state->memory});
    }
    if (anew || march.stepper->beginnings() != place.beginnings)
      lanes_.begin(lane, {march.stepper->time_step(), scenes_[place.number].scenario.solver.start ==
                                                          integrate::Start::consistent});
    place.standing = march.standing;
    place.beginnings = march.stepper->beginnings();
    place.step = 0;
    lanes_.load(lane, march.first_load ? *march.first_load : march.load, march.load);
    if (march.first_load) lanes_.jump(lane);
    place.record.seconds += seconds_since(start);
  }

  // Accounts for the step that the lane has just done.
  void settle(std::size_t lane) {
    Place& place = places_[lane];
    March& march = *place.march;
    const tissue::LaneEnergies& energies = lanes_.energies(lane);
    const double before = place.step == 0 ? march.state->time : march.times[place.step - 1];
    const double time_step = march.times[place.step] - before;
    const bool drag = march.body->law().kind == tissue::Viscosity::nodal_drag;
    const double lost = time_step <= 0.0 ? 0.0 : drag ? energies.lost / time_step : energies.lost;
    march.wrong = march.monitor->account(energies.work, lost, energies.stored + energies.kinetic);
    if (!march.wrong) {
      march.done = ++place.step;
      if (place.step < march.times.size()) {
        if (place.step == 1 && march.first_load) lanes_.load(lane, march.load, march.load);
        return;
      }
      march.state->time = march.times.back();
      lanes_.displacement(lane, march.state->displacement);
      if (march.force_wanted) lanes_.force(lane, march.force);
    }
    go_on(lane, Clock::now());
  }

  const std::vector<scene::Scene>& scenes_;
  LaneQueue& queue_;
  const Stop stop_;
  const LaneCalls& calls_;
  LaneSprings lanes_;
  std::array<Place, LaneSprings::width> places_;
  integrate::Vector force_;
};

}  // namespace

std::vector<std::vector<std::size_t>> lane_groups(const std::vector<scene::Scene>& scenes) {
  std::vector<std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    if (!suits_lanes(scenes[i])) continue;
    const auto found = std::find_if(groups.begin(), groups.end(), [&](const auto& group) {
      return alike(*scenes[group.front()].specimen, *scenes[i].specimen);
    });
    if (found != groups.end())
      found->push_back(i);
    else
      groups.push_back({i});
  }
  return groups;
}

std::size_t least_for_lanes(const scene::Scene& scene) {
  constexpr int most_nodes = 25000;  // the largest mesh that was measured
  const tissue::Network& network = scene.specimen->network;
  if (network.nodes() > most_nodes) return LaneSprings::width + 1;
  return network.coupled.empty() && network.volumes.empty() ? 4 : 6;
}

void run_in_lanes(const std::vector<scene::Scene>& scenes, LaneQueue& queue, std::size_t lanes,
                  const Stop& stop, const LaneCalls& calls) {
  Team(scenes, queue, stop, calls).run(lanes);
}

}  // namespace palpate::run
