// `palpate sweep parts` and `slurm`: print the commands that run parts, or submit a job file.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <optional>

#include "base/child_process.h"
#include "base/error.h"
#include "base/files.h"
#include "base/index.h"
#include "base/text.h"
#include "cli/program.h"
#include "cli/sweep_verbs.h"
#include "sweep/forecast.h"
#include "sweep/slurm.h"

namespace palpate::cli {
namespace {

// The program as a shell takes it: as given, or this one.
std::string program_word(const Sweep& command) {
  if (command.program.empty())
    return sweep::shell_word(std::filesystem::read_symlink("/proc/self/exe").string());
  for (const char c : command.program)
    if (static_cast<unsigned char>(c) < 0x20)
      throw InputError({},
                       "`--program` wants one line; write `--program \"apptainer exec x.sif "
                       "palpate\"`");
  return command.program;
}

// What a program of the cluster prints; nothing where there is none, or where it fails.
std::string asked(std::vector<std::string> words) {
  const ChildResult result = run_process({.argv = std::move(words), .folder = {}, .limit = 5.0});
  return result.good() ? result.output : std::string();
}

// Seconds of a limit as Slurm writes it: M, M:S, H:M:S, D-H, D-H:M, D-H:M:S; nothing otherwise.
std::optional<double> limit_seconds(const std::string& text) {
  const std::size_t dash = text.find('-');
  const bool days = dash != std::string::npos;
  std::vector<std::string> words = split(days ? text.substr(dash + 1) : text, ':');
  const std::size_t zeros = days ? 0 : words.size() == 3 ? 1 : 2;
  words.insert(words.begin(), zeros, "0");
  if (days) words.insert(words.begin(), text.substr(0, dash));
  const std::array<double, 4> units{86400.0, 3600.0, 60.0, 1.0};  // s
  if (words.size() > units.size()) return std::nullopt;
  double seconds = 0.0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].empty() || words[i].size() > 9 ||
        words[i].find_first_not_of("0123456789") != std::string::npos)
      return std::nullopt;
    seconds += units[i] * std::stod(words[i]);
  }
  return seconds;
}

// Refuses an array or a time limit beyond those of the cluster, where it can be asked.
void check_with_cluster(const Sweep& command, std::size_t tasks, std::size_t cases) {
  for (const std::string& line : split(asked({"scontrol", "show", "config"}), '\n')) {
    const std::size_t equals = line.find('=');
    if (!line.starts_with("MaxArraySize") || equals == std::string::npos) continue;
    const auto size = static_cast<std::size_t>(std::atoll(line.c_str() + equals + 1));
    if (size > 1 && tasks >= size)  // the largest number of a task is below it
      throw InputError({}, "this cluster's arrays have at most " + std::to_string(size - 1) +
                               " tasks, and `--chunk " + std::to_string(command.chunk) +
                               "` makes " + std::to_string(tasks) + "; give `--chunk " +
                               std::to_string((cases + size - 2) / (size - 1)) + "`");
  }
  const std::optional<double> wanted = limit_seconds(command.time);
  if (!wanted) return;
  double longest = 0.0;
  for (const std::string& line : split(asked({"sinfo", "--noheader", "-o", "%l"}), '\n')) {
    if (line.empty()) continue;
    const std::optional<double> limit = limit_seconds(line);
    if (!limit) return;  // infinite
    longest = std::max(longest, *limit);
  }
  if (longest > 0.0 && *wanted > longest)
    throw InputError({}, "`--time " + command.time +
                             "` is longer than every partition of this cluster allows; give at "
                             "most `--time " +
                             std::to_string(static_cast<long>(longest / 60.0)) + "`, in minutes");
}

}  // namespace

int sweep_parts(const Sweep& command, const Talk& talk) {
  const sweep::SweepPlan plan = sweep::read_plan(command.subject, program_identity());
  const std::string start = program_word(command) + " sweep run " +
                            sweep::shell_word(std::filesystem::canonical(command.subject).string());
  const sweep::SweepResults results(plan);
  const std::vector<std::size_t> parts =
      sweep::unfinished_parts(plan, results, as_index(command.of));
  const auto cost = talk.json() && !parts.empty() ? sweep::forecast(plan.family, plan.curves)
                                                  : std::optional<sweep::SweepForecast>();
  std::string text;
  for (const std::size_t part : parts) {
    const std::string call =
        start + " --shard " + std::to_string(part) + "/" + std::to_string(command.of) + " --jobs 1";
    text += call + "\n";
    if (!talk.json()) continue;
    std::size_t cases = 0;
    for (std::size_t i = part - 1; i < plan.count(); i += as_index(command.of))
      if (!results.at(i).known()) ++cases;
    std::vector<std::pair<std::string, std::string>> details{
        {"command", call}, {"part", std::to_string(part)}, {"cases", std::to_string(cases)}};
    if (cost) {
      const double share = static_cast<double>(cases) / static_cast<double>(plan.count());
      details.emplace_back("seconds", rounded_text(share * cost->seconds, 3));
      details.emplace_back("memory_bytes", rounded_text(cost->memory, 3));
    }
    talk.event("part", details);
  }
  if (text.empty()) talk.say(command.subject + ": every case has a row; there is nothing to run");
  if (!talk.json()) print(text);
  return exit_good;
}

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
                            .program = program_word(command),
                            .prologue = command.prologue.empty() ? "" : read_text(command.prologue),
                            .folder = folder,
                            .tasks = (plan.count() + chunk - 1) / chunk,
                            .time = command.time};
  check_with_cluster(command, job.tasks, plan.count());
  fs::create_directories(fs::path(job.folder) / "logs");
  const std::string path = (fs::path(job.folder) / "job.sbatch").string();
  write_atomically(path, sweep::slurm_text(job));
  if (job.tasks > sweep::usual_array)
    talk.warn("many clusters refuse an array of " + std::to_string(job.tasks) +
              " tasks; `--chunk " +
              std::to_string((plan.count() + sweep::usual_array - 1) / sweep::usual_array) +
              "` makes at most " + std::to_string(sweep::usual_array));
  const std::string tasks =
      sweep::number_ranges(sweep::unfinished_parts(plan, sweep::SweepResults(plan), job.tasks), 0);
  if (tasks.empty()) {
    talk.say(command.subject + ": every case has a row; there is nothing to submit");
    return exit_good;
  }
  print("sbatch --array=" + tasks + " " + sweep::shell_word(path) + "\n");
  return exit_good;
}

}  // namespace palpate::cli
