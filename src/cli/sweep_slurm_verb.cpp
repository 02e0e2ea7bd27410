// `palpate sweep slurm`: writes a job file and prints the command that submits it.
#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "cli/program.h"
#include "cli/sweep_verbs.h"
#include "sweep/slurm.h"

namespace palpate::cli {

int sweep_slurm(const Sweep& command, const Talk& talk) {
  namespace fs = std::filesystem;
  const sweep::SweepPlan plan = sweep::read_plan(command.subject, program_identity());
  for (const char c : command.time)
    if (std::string_view("0123456789:-").find(c) == std::string_view::npos)
      throw InputError({}, "`--time` wants a limit as Slurm writes it, got `" + command.time +
                               "`; write `--time 01:00:00`");
  const std::string folder = fs::canonical(command.subject).string();
  if (std::any_of(folder.begin(), folder.end(), [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return byte < 0x20 || byte == 0x7f;
      }))
    throw InputError({}, "`" + folder +
                             "` has a control character in its name, which a job file "
                             "cannot hold; rename the folder");
  const auto chunk = as_index(command.chunk);
  const sweep::SlurmJob job{.name = plan.family.name,
                            .program = fs::read_symlink("/proc/self/exe").string(),
                            .folder = folder,
                            .tasks = (plan.count() + chunk - 1) / chunk,
                            .time = command.time};
  fs::create_directories(fs::path(job.folder) / "logs");
  const std::string path = (fs::path(job.folder) / "job.sbatch").string();
  write_atomically(path, sweep::slurm_text(job));
  if (job.tasks > sweep::usual_array)
    talk.warn("many clusters refuse an array of " + std::to_string(job.tasks) +
              " tasks; `--chunk " +
              std::to_string((plan.count() + sweep::usual_array - 1) / sweep::usual_array) +
              "` makes at most " + std::to_string(sweep::usual_array));
  const std::string tasks = sweep::unfinished_tasks(plan, sweep::SweepResults(plan), job.tasks);
  if (tasks.empty()) {
    talk.say(command.subject + ": every case has a row; there is nothing to submit");
    return exit_good;
  }
  print("sbatch --array=" + tasks + " " + sweep::shell_word(path) + "\n");
  return exit_good;
}

}  // namespace palpate::cli
