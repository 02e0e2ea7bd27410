// Cases on one mesh, up to eight at a time, their meshes moved in lanes.
#pragma once

#include <atomic>
#include <functional>
#include <span>
#include <vector>

#include "record/record.h"
#include "run/stop.h"
#include "scene/scene.h"

namespace palpate::run {

// Cases that may stand in lanes side by side: suits_lanes(), one mesh, one form of springs. Numbers
// of scenes, ascending; in the order of their first ones. Others are in no group.
[[nodiscard]] std::vector<std::vector<std::size_t>> lane_groups(
    const std::vector<scene::Scene>& scenes);

// How many cases of a group it takes for lanes to be cheaper than each alone: a pass costs what two
// to five bodies alone do, whether its lanes are taken or not. More than there are lanes where
// lanes do not pay at all. docs/speed.md
[[nodiscard]] std::size_t least_for_lanes(const scene::Scene& scene);

// Which cases of a group are still to be begun, for several teams of lanes.
struct LaneQueue {
  std::span<const std::size_t> group;
  std::atomic<std::size_t> next = 0;  // of the group
};

// Takes cases from the queue, `lanes` at a time (1 to 8), until it is empty and they have ended.
// `begin` makes what a case records, `end` is given it.
struct LaneCalls {
  std::function<record::CaseRecord(std::size_t)> begin;
  std::function<void(std::size_t, record::CaseRecord&&)> end;
};
void run_in_lanes(const std::vector<scene::Scene>& scenes, LaneQueue& queue, std::size_t lanes,
                  const Stop& stop, const LaneCalls& calls);

}  // namespace palpate::run
