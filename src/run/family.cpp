// Builds, runs and times the cases of a family.
#include "run/family.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>

#include "base/stop_scope.h"
#include "base/stopwatch.h"
#include "run/choose.h"
#include "run/findings.h"
#include "run/pace.h"
#include "run/refined_mesh.h"
#include "scenario/programme.h"
#include "scenario/words.h"
#include "scene/specimen_shape.h"

namespace palpate::run {
namespace {

std::string chosen(const scenario::Resolved& scenario) {
  namespace words = scenario::words;
  const scenario::Resolved::Solver& solver = scenario.solver;
  std::string text = "solver.model = " + std::string(scenario::traits(solver.model).word);
  if (scenario.meshed())
    text += std::string(", solver.integrator = ") + about(solver.integrator).word +
            ", solver.volume = " + words::word(words::volumes, solver.volume);
  if (!scenario.uniform())
    text += std::string(", contact.viscosity = ") +
            words::word(words::contact_viscosities, scenario.contact.viscosity) +
            ", contact.depth = " + words::word(words::depths, scenario.contact.depth);
  return text;
}

}  // namespace

void share_out(std::size_t count, int workers, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::exception_ptr> failures(count);
  const auto take = [&, limits = StopScope::limits()] {
    const StopScope scope(limits);
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        failures[i] = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> others;
    for (int worker = 1; worker < workers; ++worker) others.emplace_back(take);
    take();
  }
  // Only now, so that the reported one does not depend on timing.
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

std::vector<scene::Scene> build_all(const scenario::Family& family, int workers) {
  std::vector<scene::Scene> scenes(family.cases.size());
  scene::SpecimenShapes shapes;
  const auto common = scenes.size() > 1 ? one_model(family, shapes, workers).model : std::nullopt;
  share_out(scenes.size(), workers, [&](std::size_t i) {
    scenario::Case one = family.cases[i];
    one.at_least = common;
    scenes[i] = run::build_scene(one, family, shapes);
  });
  return scenes;
}

record::CaseRecord begin_case(const scene::Scene& scene) {
  record::CaseRecord record;
  record.name = scene.name;
  record.chosen = chosen(scene.scenario);
  return record;
}

void run_programme(const scene::Scene& scene, record::CaseRecord& record) {
  try {
    if (scene.scenario.uniform())
      load_uniformly(scene, record);
    else
      press(scene, record);
  } catch (const Stopped& stopped) {
    (void)end_early(record, record::Outcome::interrupted, stopped.what());
  }
}

record::CaseRecord run_case(const scene::Scene& scene) {
  const Stopwatch watch;
  record::CaseRecord record = begin_case(scene);
  run_programme(scene, record);
  try {
    if (record.outcome != record::Outcome::interrupted) add_findings(scene, record);
  } catch (const Stopped& stopped) {
    (void)end_early(record, record::Outcome::interrupted, stopped.what());
  }
  record.seconds = watch.seconds();
  return record;
}

std::vector<record::CaseRecord> run_all(
    const std::vector<scene::Scene>& scenes, int workers,
    const std::function<void(std::size_t, const record::CaseRecord&)>& finished) {
  std::vector<std::optional<record::CaseRecord>> slots(scenes.size());
  share_out(scenes.size(), workers, [&](std::size_t i) {
    if (StopScope::stopped()) return;
    record::CaseRecord record = run_case(scenes[i]);
    finished(i, record);
    slots[i] = std::move(record);
  });
  std::vector<record::CaseRecord> records;
  records.reserve(scenes.size());  // a growing vector would copy the maps
  for (auto& slot : slots)
    if (slot && slot->outcome != record::Outcome::interrupted) records.push_back(std::move(*slot));
  return records;
}

std::optional<double> share_done(const scene::Scene& scene, const record::CaseRecord& record) {
  const double time = record::end_time(record);
  const double whole = scenario::programme_time(scene.scenario);
  return time > 0.0 && whole > 0.0 ? std::optional(std::min(1.0, time / whole)) : std::nullopt;
}

Cost expected_cost(const std::vector<scene::Scene>& scenes, double longest) {
  const Stopwatch watch;
  Cost cost;
  std::size_t tried = 0;
  for (; tried < scenes.size() && watch.seconds() < longest; ++tried) {
    const scene::Scene& scene = scenes[(scenes.size() / 2 + tried) % scenes.size()];
    const StopScope deadline(longest - watch.seconds());
    const double before = processor_seconds();
    const record::CaseRecord record = run_case(scene);
    const bool ended = record.outcome != record::Outcome::interrupted;
    const std::optional<double> share = ended ? std::optional(1.0) : share_done(scene, record);
    cost.seconds += (processor_seconds() - before) / share.value_or(1.0);
    cost.at_least = cost.at_least || !share;
  }
  if (tried > 0) cost.seconds *= static_cast<double>(scenes.size()) / static_cast<double>(tried);
  return cost;
}

}  // namespace palpate::run
