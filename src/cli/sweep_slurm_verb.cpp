// `palpate sweep slurm`: a job file, and the line that sends it.
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "cli/program.h"
#include "cli/sweep_verbs.h"
#include "study/sweep_slurm.h"

namespace palpate::cli {

int sweep_slurm(const Sweep& command, const Talk& talk) {
  namespace fs = std::filesystem;
  const study::SweepPlan plan = study::read_plan(command.subject, program_identity());
  for (const char c : command.time)
    if (std::string_view("0123456789:-").find(c) == std::string_view::npos)
      throw InputError({}, "`--time` wants a limit as Slurm writes it, got `" + command.time +
                               "`; write `--time 01:00:00`");
  const auto chunk = static_cast<std::size_t>(command.chunk);
  const study::SlurmJob job{.name = plan.family.name,
                            .program = fs::read_symlink("/proc/self/exe").string(),
                            .folder = fs::canonical(command.subject).string(),
                            .tasks = (plan.count() + chunk - 1) / chunk,
                            .time = command.time};
  fs::create_directories(fs::path(job.folder) / "logs");
  const std::string path = (fs::path(job.folder) / "job.sbatch").string();
  write_atomically(path, study::slurm_text(job));
  if (job.tasks > study::usual_array)
    talk.warn("many clusters take no array of " + std::to_string(job.tasks) + " tasks; `--chunk " +
              std::to_string((plan.count() + study::usual_array - 1) / study::usual_array) +
              "` makes no more than " + std::to_string(study::usual_array));
  const std::string tasks = study::unfinished_tasks(plan, study::SweepResults(plan), job.tasks);
  if (tasks.empty()) {
    talk.say(command.subject + ": every case has its row; there is nothing to send");
    return exit_good;
  }
  print("sbatch --array=" + tasks + " " + study::shell_word(path) + "\n");
  return exit_good;
}

}  // namespace palpate::cli
