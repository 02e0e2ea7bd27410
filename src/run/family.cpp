// Workers take the next case from a counter; each case is computed by one thread alone.
#include "run/family.h"

#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>

#include "run/findings.h"
#include "run/press.h"
#include "run/uniform.h"
#include "scenario/words.h"
#include "scene/specimen_shape.h"

namespace palpate::run {
namespace {

// Calls work(i) for every i below count on that many threads; rethrows the failure of the least i.
void share_out(std::size_t count, int workers, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::exception_ptr> failures(count);
  const auto take = [&] {
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
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace

namespace {

std::string chosen(const scenario::Scenario& scenario) {
  namespace words = scenario::words;
  const scenario::Solver& solver = scenario.solver;
  std::string text = std::string("solver.model = ") + words::word(words::models, solver.model);
  if (scenario.meshed())
    text += std::string(", solver.integrator = ") +
            words::word(words::integrators, solver.integrator) +
            ", solver.volume = " + words::word(words::volumes, solver.volume);
  if (!scenario.uniform())
    text += std::string(", contact.viscosity = ") +
            words::word(words::contact_viscosities, scenario.contact.viscosity) +
            ", contact.depth = " + words::word(words::depths, scenario.contact.depth);
  return text;
}

}  // namespace

std::vector<scene::Scene> build_all(const scenario::Family& family, int workers) {
  std::vector<scene::Scene> scenes(family.cases.size());
  scene::SpecimenShapes shapes;
  share_out(scenes.size(), workers,
            [&](std::size_t i) { scenes[i] = scene::build(family.cases[i], family, shapes); });
  return scenes;
}

record::CaseRecord run_case(const scene::Scene& scene, const std::atomic<bool>& stop) {
  const auto start = std::chrono::steady_clock::now();
  record::CaseRecord record;
  record.name = scene.name;
  record.chosen = chosen(scene.scenario);
  if (scene.scenario.uniform())
    load_uniformly(scene, stop, record);
  else
    press(scene, stop, record);
  add_findings(scene, record);
  record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return record;
}

std::vector<record::CaseRecord> run_all(
    const std::vector<scene::Scene>& scenes, int workers, const std::atomic<bool>& stop,
    const std::function<void(std::size_t, const record::CaseRecord&)>& finished) {
  std::vector<std::optional<record::CaseRecord>> slots(scenes.size());
  std::mutex one_at_a_time;
  share_out(scenes.size(), workers, [&](std::size_t i) {
    if (stop.load()) return;
    record::CaseRecord record = run_case(scenes[i], stop);
    const std::lock_guard lock(one_at_a_time);
    finished(i, record);
    slots[i] = std::move(record);
  });
  std::vector<record::CaseRecord> records;
  for (auto& slot : slots)
    if (slot && slot->outcome != record::Outcome::interrupted) records.push_back(std::move(*slot));
  return records;
}

}  // namespace palpate::run
