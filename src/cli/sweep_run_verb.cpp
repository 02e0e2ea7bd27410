// `palpate sweep run` and `retry`: run missing or failed cases and report progress.
#include <cmath>
#include <csignal>
#include <filesystem>
#include <mutex>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "cli/interrupt.h"
#include "cli/program.h"
#include "cli/sweep_verbs.h"
#include "sweep/run.h"
#include "sweep/stopwatch.h"

namespace palpate::cli {
namespace {

// 90 s, 12 min, 3.5 h
std::string duration_text(double seconds) {
  if (seconds < 100.0) return rounded_text(std::ceil(seconds), 2) + " s";
  if (seconds < 6000.0) return rounded_text(seconds / 60.0, 2) + " min";
  return rounded_text(seconds / 3600.0, 3) + " h";
}

std::string progress_text(const sweep::SweepProgress& now, double seconds) {
  std::string text = bar(now.done, now.all);
  if (now.done > 0) {
    const double rate = static_cast<double>(now.done) / seconds;
    text += ", " + rounded_text(rate, 3) + " cases/s, " +
            duration_text(static_cast<double>(now.all - now.done) / rate) + " left";
  }
  if (now.failed > 0) text += ", " + std::to_string(now.failed) + " failed";
  return text;
}

}  // namespace

int sweep_run(const Sweep& command, const Talk& talk) {
  sweep::SweepTask task{.shard = sweep::parse_shard(command.shard),
                        .workers = worker_count(command.jobs)};
  if (command.act == Sweep::Act::retry) task.which = sweep::SweepTask::Which::failed;
  const sweep::SweepPlan plan = sweep::read_plan(command.subject, program_identity());
  // From here a second signal ends the program at once, without losing a finished row.
  const std::atomic<bool>& stop = listen_for_interrupts(exit_resumable, {SIGUSR1});
  sweep::SweepProgress now;
  std::mutex telling;
  const auto event = [&](double seconds) {
    const std::scoped_lock lock(telling);
    talk.event("progress", {{"done", std::to_string(now.done)},
                            {"all", std::to_string(now.all)},
                            {"failed", std::to_string(now.failed)},
                            {"seconds", rounded_text(seconds)}});
  };
  const sweep::Clock::time_point start = sweep::Clock::now();
  sweep::SweepEnd end;
  try {
    const ProgressLine line(
        talk,
        [&](double seconds) {
          const std::scoped_lock lock(telling);
          return progress_text(now, seconds);
        },
        event);
    end = sweep::run_sweep(plan, task, stop, [&](const sweep::SweepProgress& told) {
      const std::scoped_lock lock(telling);
      now = told;
    });
  } catch (const sweep::PartIsRun& held) {
    Talk::error(held.what());
    return exit_held;
  }
  event(sweep::seconds_since(start));
  if (!std::filesystem::exists(command.subject + "/plan.json"))
    throw SystemError(command.subject +
                      " has vanished while its cases ran, and their rows with it; plan anew");
  for (const std::string& warning : end.warnings) talk.warn(warning);
  std::string text = command.subject + ": " + std::to_string(end.completed) + " of " +
                     cases_text(end.all) + " completed";
  if (end.failed > 0) text += ", " + std::to_string(end.failed) + " failed";
  if (end.missing > 0) text += ", " + std::to_string(end.missing) + " missing";
  talk.event("end", {{"all", std::to_string(end.all)},
                     {"completed", std::to_string(end.completed)},
                     {"failed", std::to_string(end.failed)},
                     {"missing", std::to_string(end.missing)}});
  if (end.interrupted && end.completed + end.failed < end.all) {
    Talk::error("palpate: interrupted; " + text + "; the same command continues from there");
    return exit_resumable;
  }
  const bool good = end.missing == 0 && (end.failed == 0 || command.accept_failed);
  if (good && !command.done.empty()) {
    make_folders(std::filesystem::path(command.done).parent_path().string());
    write_atomically(command.done, task.shard.text() + " of " + plan.hash + "\n");
  }
  talk.say(text);
  return good ? exit_good : exit_partial;
}

}  // namespace palpate::cli
