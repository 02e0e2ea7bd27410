// Runs the cases of a family: workers take the next task from a counter.
#include "run/family.h"

#include <chrono>
#include <mutex>
#include <optional>

#include "base/stop_scope.h"
#include "run/findings.h"
#include "run/lanes.h"
#include "run/pace.h"
#include "run/press.h"
#include "run/refined_mesh.h"
#include "run/share_out.h"
#include "run/uniform.h"
#include "scenario/words.h"
#include "scene/specimen_shape.h"

namespace palpate::run {
namespace {

std::string chosen(const scenario::Resolved& scenario) {
  namespace words = scenario::words;
  const scenario::Resolved::Solver& solver = scenario.solver;
  std::string text = "solver.model = " + std::string(scenario::rung(solver.model).word);
  if (scenario.meshed())
    text += std::string(", solver.integrator = ") + about(solver.integrator).word +
            ", solver.volume = " + words::word(words::volumes, solver.volume);
  if (!scenario.uniform())
    text += std::string(", contact.viscosity = ") +
            words::word(words::contact_viscosities, scenario.contact.viscosity) +
            ", contact.depth = " + words::word(words::depths, scenario.contact.depth);
  if (scenario.contact.size == scenario::Contact::Size::body)
    text += std::string(", contact.size = ") + words::word(words::sizes, scenario.contact.size);
  return text;
}

}  // namespace

std::vector<scene::Scene> build_all(const scenario::Family& family, int workers) {
  std::vector<scene::Scene> scenes(family.cases.size());
  scene::SpecimenShapes shapes;
  share_out(scenes.size(), workers,
            [&](std::size_t i) { scenes[i] = run::build_scene(family.cases[i], family, shapes); });
  return scenes;
}

record::CaseRecord begin_case(const scene::Scene& scene) {
  record::CaseRecord record;
  record.name = scene.name;
  record.chosen = chosen(scene.scenario);
  return record;
}

namespace {

// A task for one worker: a single case, or a team of lanes.
struct Task {
  std::size_t number = 0;
  LaneQueue* queue = nullptr;
  std::size_t lanes = 0;
};

// Makes the tasks; teams of lanes come first, because they take longest.
std::vector<Task> share_lanes(const std::vector<scene::Scene>& scenes, int workers, Lanes lanes,
                              const std::vector<std::vector<std::size_t>>& groups,
                              std::vector<LaneQueue>& queues) {
  std::vector<Task> tasks;
  std::vector<char> taken(scenes.size(), 0);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::size_t cases = groups[g].size();
    const std::size_t least =
        lanes == Lanes::wherever_possible ? 1 : least_for_lanes(scenes[groups[g].front()]);
    if (cases < least || least > tissue::LaneSprings::width) continue;
    for (const std::size_t i : groups[g]) taken[i] = 1;
    queues[g].group = groups[g];
    const std::size_t teams = std::min(as_index(std::max(1, workers)), cases / least);
    const std::size_t each = std::min(tissue::LaneSprings::width, (cases + teams - 1) / teams);
    for (std::size_t team = 0; team < teams; ++team) tasks.push_back({0, &queues[g], each});
  }
  for (std::size_t i = 0; i < scenes.size(); ++i)
    if (taken[i] == 0) tasks.push_back({.number = i});
  return tasks;
}

}  // namespace

void run_programme(const scene::Scene& scene, const std::atomic<bool>& stop,
                   record::CaseRecord& record) {
  if (scene.scenario.uniform())
    load_uniformly(scene, stop, record);
  else
    press(scene, stop, record);
}

record::CaseRecord run_case(const scene::Scene& scene, const std::atomic<bool>& stop) {
  const auto start = std::chrono::steady_clock::now();
  record::CaseRecord record = begin_case(scene);
  const StopScope scope(stop);
  try {
    run_programme(scene, stop, record);
    add_findings(scene, record);
  } catch (const Stopped& stopped) {
    (void)end_early(record, record::Outcome::interrupted, stopped.what());
  }
  record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return record;
}

void run_each(const std::vector<scene::Scene>& scenes, int workers, const Stop& stop,
              const std::function<void(std::size_t, record::CaseRecord&&)>& ended, Lanes lanes) {
  const LaneCalls calls{[&](std::size_t i) { return begin_case(scenes[i]); },
                        [&](std::size_t i, record::CaseRecord&& record) {
                          add_findings(scenes[i], record);
                          ended(i, std::move(record));
                        }};
  std::vector<std::vector<std::size_t>> groups;
  if (lanes != Lanes::none) groups = lane_groups(scenes);
  std::vector<LaneQueue> queues(groups.size());
  const std::vector<Task> tasks = share_lanes(scenes, workers, lanes, groups, queues);
  share_out(tasks.size(), workers, [&](std::size_t t) {
    if (stop.no_more()) return;
    const Task& task = tasks[t];
    if (task.queue != nullptr)
      run_in_lanes(scenes, *task.queue, task.lanes, stop, calls);
    else
      ended(task.number, run_case(scenes[task.number], stop.end_now));
  });
}

std::vector<record::CaseRecord> run_all(
    const std::vector<scene::Scene>& scenes, int workers, const std::atomic<bool>& stop,
    const std::function<void(std::size_t, const record::CaseRecord&)>& finished, Lanes lanes) {
  std::vector<std::optional<record::CaseRecord>> slots(scenes.size());
  std::mutex one_at_a_time;
  const auto keep = [&](std::size_t i, record::CaseRecord&& record) {
    const std::lock_guard lock(one_at_a_time);
    finished(i, record);
    slots[i] = std::move(record);
  };
  run_each(scenes, workers, {stop, stop}, keep, lanes);
  std::vector<record::CaseRecord> records;
  for (auto& slot : slots)
    if (slot && slot->outcome != record::Outcome::interrupted) records.push_back(std::move(*slot));
  return records;
}

}  // namespace palpate::run
