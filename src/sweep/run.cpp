// Runs cases in blocks, so that memory does not grow with the plan; meshes are kept between blocks.
#include "sweep/run.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "base/error.h"
#include "base/stop_scope.h"
#include "base/stopwatch.h"
#include "base/text.h"
#include "run/refined_mesh.h"
#include "scene/estimates.h"
#include "scene/specimen_shape.h"
#include "scene/surface_displacement_store.h"
#include "sweep/journal.h"
#include "sweep/row.h"

namespace palpate::sweep {
namespace {

constexpr std::size_t block_cases = 16;  // of a worker; larger blocks spend time on new memory
constexpr double block_nodes = 50000.0;  // about the most in memory, of all scenes together
constexpr std::size_t most_shapes = 32;  // kept meshes; if there are more, all are discarded

// The part in names of locks and of files of rows: 3-of-16, or retry-3-of-16.
std::string part_name(const SweepTask& task) {
  return (task.which == SweepTask::Which::failed ? "retry-" : "") + task.shard.text();
}

class Runner {
 public:
  Runner(const SweepPlan& plan, const SweepTask& task, const std::atomic<bool>& no_more,
         const std::function<void(const SweepProgress&)>& told)
      : plan_(plan),
        task_(task),
        no_more_(no_more),
        files_(scenario::hashed(plan.family.inputs)),
        told_(told) {}

  void run(const std::vector<std::uint32_t>& numbers,
           const std::function<std::uint32_t(std::uint32_t)>& attempt) {
    if (numbers.empty()) return;
    attempt_ = attempt;
    now_.all = numbers.size();
    journal_ =
        std::make_unique<record::Journal>(plan_.folder + "/results", part_name(task_), plan_.hash);
    {
      const std::jthread ticking([&](const std::stop_token& end) { beat(end); });
      const std::size_t block = block_cases * as_index(task_.workers);
      for (std::size_t at = 0; at < numbers.size() && !ends(); at += block)
        run_block(std::span(numbers).subspan(at, std::min(block, numbers.size() - at)));
    }
    if (failure_) std::rethrow_exception(failure_);
    journal_->sync();
  }

  [[nodiscard]] const SweepProgress& progress() const { return now_; }

 private:
  struct Made {
    std::uint32_t number = 0;
    std::optional<scenario::Case> one;
    std::optional<scene::Scene> scene;
    bool tried = false;
  };

  // Whether no further case begins.
  [[nodiscard]] bool ends() const { return broken_ || no_more_; }

  // Rows are on the disk within a second.
  void beat(const std::stop_token& end) {
    std::mutex waiting;
    std::condition_variable_any woken;
    std::unique_lock lock(waiting);
    while (!end.stop_requested()) {
      woken.wait_for(lock, end, std::chrono::milliseconds(800), [] { return false; });
      if (!end.stop_requested()) guarded([&] { journal_->sync(); });
    }
  }

  // Carries out work on the journal; the first failure ends the run.
  void guarded(const std::function<void()>& work) {
    const std::lock_guard lock(writing_);
    if (broken_) return;
    try {
      work();
    } catch (...) {
      failure_ = std::current_exception();
      broken_ = true;
    }
  }

  // Keeps a row for a failed case; the reason does not contain the plan's folder.
  void keep_failure(const Made& made, std::string reason) {
    const std::string folder = plan_.family.folder + "/";
    for (std::size_t at = reason.find(folder); at != std::string::npos; at = reason.find(folder))
      reason.erase(at, folder.size());
    SweepRow row{.outcome = SweepOutcome::failed, .reason = std::move(reason)};
    if (made.one) row.name = made.one->name;
    keep(made.number, std::move(row));
  }

  void keep(std::uint32_t number, SweepRow row) {
    row.id = plan_.ids[number];
    row.attempt = attempt_(number);
    guarded([&] {
      journal_->add(journal_row(row));
      ++now_.done;
      if (row.outcome != SweepOutcome::completed) ++now_.failed;
      told_(now_);
    });
  }

  // Calls `work`. An error of the case becomes its row. Returns whether there was none.
  bool attempt(const Made& made, const std::function<void()>& work) {
    try {
      work();
      return true;
    } catch (const InputError& error) {
      std::vector<std::string> sentences;
      for (const Problem& problem : error.problems()) sentences.push_back(problem.message);
      keep_failure(made, joined(sentences, "; "));
    } catch (const MeshError& error) {
      keep_failure(made, error.what());
    }
    return false;
  }

  void run_block(std::span<const std::uint32_t> numbers) {
    std::vector<Made> block(numbers.size());
    run::share_out(block.size(), task_.workers, [&](std::size_t i) {
      Made& made = block[i];
      made.number = numbers[i];
      attempt(made, [&] {
        scenario::Case one = scenario::make_case(plan_.family, made.number);
        const std::uint64_t id = case_id(one, files_);
        const std::uint64_t planned = plan_.ids[made.number];
        if (id != planned && twin_id(id, made.number + 1) != planned)
          throw SystemError("case " + std::to_string(made.number + 1) +
                            " is not what was planned: this machine reads the scenario "
                            "differently; plan anew on this one");
        made.one = std::move(one);
      });
    });
    for (std::size_t at = 0; at < block.size() && !ends();) {
      double nodes = 0.0;
      std::size_t end = at;
      while (end < block.size() && (end < at + as_index(task_.workers) || nodes < block_nodes)) {
        const Made& made = block[end++];
        if (made.one && made.one->scenario.meshed())
          nodes += scene::expected_nodes(made.one->scenario.tissue.mesh);
      }
      for (const std::span part = std::span(block).subspan(at, end - at);
           !ends() && std::ranges::any_of(part, waits);)
        run_part(part);
      at = end;
    }
  }

  static bool waits(const Made& made) { return made.one && !made.tried; }

  // Builds cases that have not been tried for a while, at least one per worker, and runs them: rows
  // must reach the disk long before a job's time is over.
  void run_part(std::span<Made> all) {
    constexpr double longest = 0.3;  // s
    if (shapes_->size() > most_shapes) shapes_ = std::make_unique<scene::SpecimenShapes>();
    std::vector<Made*> part;
    for (Made& made : all)
      if (waits(made)) part.push_back(&made);
    const Stopwatch watch;
    run::share_out(part.size(), task_.workers, [&](std::size_t i) {
      Made& made = *part[i];
      const bool late = i >= as_index(task_.workers) && watch.seconds() > longest;
      if (late || ends()) return;
      made.tried = true;
      attempt(made, [&] {
        made.scene = run::build_scene(*made.one, plan_.family, *shapes_);
        made.scene->scenario.output.keep_rows_only();
        made.scene->surface_displacements = &surface_displacements_;
      });
    });
    std::vector<scene::Scene> scenes;
    std::vector<const Made*> of_scene;
    scenes.reserve(part.size());
    for (Made* made : part) {
      if (!made->scene) continue;
      scenes.push_back(std::move(*made->scene));
      made->scene.reset();
      of_scene.push_back(made);
    }
    const StopScope scope(broken_);
    run::share_out(scenes.size(), task_.workers, [&](std::size_t i) {
      if (ends()) return;
      attempt(*of_scene[i], [&] {
        const record::CaseRecord record = run::run_case(scenes[i]);
        if (record.outcome != record::Outcome::interrupted)
          keep(of_scene[i]->number, row_of(scenes[i], record, plan_.curves));
      });
    });
    for (Made* made : part)
      if (made->tried) made->one.reset();
  }

  const SweepPlan& plan_;
  const SweepTask& task_;
  std::atomic<bool> broken_ = false;  // the journal cannot be written
  const std::atomic<bool>& no_more_;
  const std::vector<HashedFile> files_;
  std::function<std::uint32_t(std::uint32_t)> attempt_;
  std::unique_ptr<record::Journal> journal_;
  std::unique_ptr<scene::SpecimenShapes> shapes_ = std::make_unique<scene::SpecimenShapes>();
  scene::SurfaceDisplacementStore surface_displacements_;
  std::mutex writing_;
  std::exception_ptr failure_;
  SweepProgress now_;
  const std::function<void(const SweepProgress&)>& told_;
};

}  // namespace

SweepEnd run_sweep(const SweepPlan& plan, const SweepTask& task, const std::atomic<bool>& no_more,
                   const std::function<void(const SweepProgress&)>& told) {
  const bool again = task.which == SweepTask::Which::failed;
  const FolderLock lock(plan.folder, part_name(task));
  const SweepResults results(plan, task.shard);
  std::vector<std::uint32_t> numbers;
  SweepEnd end{.warnings = results.warnings()};
  if (!lock.warning().empty()) end.warnings.push_back(lock.warning());
  for (std::size_t i = 0; i < plan.count(); ++i) {
    if (!task.shard.holds(i)) continue;
    ++end.all;
    const bool failed =
        results.at(i).known() && results.at(i).head.outcome != SweepOutcome::completed;
    const bool taken = again ? failed : !results.at(i).known();
    if (taken)
      numbers.push_back(static_cast<std::uint32_t>(i));
    else if (failed)
      ++end.failed;
    else if (results.at(i).known())
      ++end.completed;
    else
      ++end.missing;
  }
  Runner runner(plan, task, no_more, told);
  runner.run(numbers, [&](std::uint32_t i) { return again ? results.at(i).head.attempt + 1 : 1; });
  const SweepProgress& made = runner.progress();
  end.completed += made.done - made.failed;
  end.failed += made.failed;
  const std::size_t left = numbers.size() - made.done;
  (again ? end.failed : end.missing) += left;
  end.interrupted = no_more.load();
  return end;
}

}  // namespace palpate::sweep
