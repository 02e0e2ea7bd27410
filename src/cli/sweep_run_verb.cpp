// `palpate sweep run` and `retry`: run missing or failed cases and report progress.
#include <cmath>
#include <csignal>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "cli/interrupt.h"
#include "cli/program.h"
#include "cli/sweep_verbs.h"
#include "sweep/run.h"

namespace palpate::cli {
namespace {

// 90 s, 12 min, 3.5 h
std::string duration_text(double seconds) {
  if (seconds < 100.0) return rounded_text(std::ceil(seconds), 2) + " s";
  if (seconds < 6000.0) return rounded_text(seconds / 60.0, 2) + " min";
  return rounded_text(seconds / 3600.0, 3) + " h";
}

std::string rate_text(const sweep::SweepProgress& now) {
  std::string text;
  if (now.done > 0 && now.seconds > 0.0) {
    const double rate = static_cast<double>(now.done) / now.seconds;
    text = ", " + rounded_text(rate, 3) + " cases/s, " +
           duration_text(static_cast<double>(now.all - now.done) / rate) + " left";
  }
  if (now.failed > 0) text += ", " + std::to_string(now.failed) + " failed";
  return text;
}

// Progress: a bar five times per second on a terminal, otherwise one line per minute; with --json
// one event per second.
class Ticker {
 public:
  explicit Ticker(const Talk& talk) : talk_(talk) {}

  void operator()(const sweep::SweepProgress& now) {
    talk_.progress(bar(now.done, now.all) + rate_text(now));
    if (!talk_.shows_progress() && now.seconds >= next_line_) {
      talk_.say(std::to_string(now.done) + " of " + cases_text(now.all) + rate_text(now));
      next_line_ = now.seconds + 60.0;
    }
    if (now.seconds < next_event_ && now.done < now.all) return;
    next_event_ = now.seconds + 1.0;
    talk_.event("progress", {{"done", std::to_string(now.done)},
                             {"all", std::to_string(now.all)},
                             {"failed", std::to_string(now.failed)},
                             {"seconds", rounded_text(now.seconds)}});
  }

 private:
  const Talk& talk_;
  double next_line_ = 60.0;  // s
  double next_event_ = 0.0;
};

}  // namespace

int sweep_run(const Sweep& command, const Talk& talk) {
  sweep::SweepTask task{.shard = sweep::parse_shard(command.shard),
                        .workers = worker_count(command.jobs)};
  if (command.act == Sweep::Act::retry) task.which = sweep::SweepTask::Which::failed;
  const sweep::SweepPlan plan = sweep::read_plan(command.subject, program_identity());
  // From here a second signal ends the program at once, without losing a finished row.
  const std::atomic<bool>& stop = listen_for_interrupts(exit_resumable, {SIGUSR1});
  Ticker ticker(talk);
  sweep::SweepEnd end;
  try {
    end = sweep::run_sweep(plan, task, stop, [&](const sweep::SweepProgress& now) { ticker(now); });
  } catch (const sweep::PartIsRun& held) {
    Talk::error(held.what());
    return exit_held;
  }
  talk.progress("");
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
