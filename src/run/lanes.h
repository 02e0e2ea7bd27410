// Computes up to eight cases with the same mesh at a time, in the lanes of one vectorised loop.
#pragma once

#include <atomic>
#include <functional>
#include <span>
#include <vector>

#include "record/record.h"
#include "run/stop.h"
#include "scene/scene.h"

namespace palpate::run {

// Groups of cases that can share a loop: they fulfil suits_lanes() and have the same mesh, kind of
// springs and viscosity. A group contains numbers of scenes, ascending; groups are ordered by their
// first scene. Other cases are in no group.
[[nodiscard]] std::vector<std::vector<std::size_t>> lane_groups(
    const std::vector<scene::Scene>& scenes);

// The smallest number of cases of a group for which lanes are faster than single runs. A pass over
// all lanes, used or not, costs as much as two to five single bodies. Larger than the number of
// lanes if they are never faster. docs/speed.md
[[nodiscard]] std::size_t least_for_lanes(const scene::Scene& scene);

// The cases of a group, taken one after the other by one or more teams of lanes.
struct LaneQueue {
  std::span<const std::size_t> group;
  std::atomic<std::size_t> next = 0;  // index in `group` of the next case to begin
};

// Takes cases from the queue, `lanes` at a time (1 to 8), until the queue is empty and all have
// ended. `begin` makes the record of a case, and `end` receives it.
struct LaneCalls {
  std::function<record::CaseRecord(std::size_t)> begin;
  std::function<void(std::size_t, record::CaseRecord&&)> end;
};
void run_in_lanes(const std::vector<scene::Scene>& scenes, LaneQueue& queue, std::size_t lanes,
                  const Stop& stop, const LaneCalls& calls);

}  // namespace palpate::run
