// The job file: a bash script that passes on signals and queues an unfinished task again.
#include "sweep/slurm.h"

#include "base/text.h"

namespace palpate::sweep {
namespace {

// Text for between quotes on an #SBATCH line: escapes quotes, and `%`, which Slurm would replace. A
// line feed would end the line, and what follows it would be a command.
std::string batch_text(const std::string& text) {
  std::string word;
  for (char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f) c = '_';
    if (c == '"' || c == '\\') word += '\\';
    word += c;
    if (c == '%') word += '%';
  }
  return word;
}

}  // namespace

std::string number_ranges(const std::vector<std::size_t>& numbers, std::size_t most) {
  std::string text;
  std::size_t said = 0;
  for (std::size_t i = 0; i < numbers.size();) {
    std::size_t end = i;
    while (end + 1 < numbers.size() && numbers[end + 1] == numbers[end] + 1) ++end;
    if (said++ == most && most > 0) return text + ",...";
    if (!text.empty()) text += ",";
    text += std::to_string(numbers[i]);
    if (end > i) text += "-" + std::to_string(numbers[end]);
    i = end + 1;
  }
  return text;
}

std::vector<std::size_t> unfinished_parts(const SweepPlan& plan, const SweepResults& results,
                                          std::size_t parts) {
  std::vector<char> wanted(parts, 0);
  for (std::size_t i = 0; i < plan.count(); ++i)
    if (!results.at(i).known()) wanted[i % parts] = 1;
  std::vector<std::size_t> numbers;
  for (std::size_t part = 0; part < parts; ++part)
    if (wanted[part] != 0) numbers.push_back(part + 1);
  return numbers;
}

std::string slurm_text(const SlurmJob& job) {
  const std::string tasks = std::to_string(job.tasks);
  std::string text = "#!/bin/bash\n# Written by `palpate sweep slurm`: a task runs one of " +
                     tasks + " parts of the sweep.\n";
  const auto option = [&](const std::string& line) { text += "#SBATCH --" + line + "\n"; };
  option("job-name=\"" + batch_text(job.name) + "\"");
  option("array=1-" + tasks);
  if (!job.time.empty()) option("time=" + job.time);
  option("signal=B:TERM@60");
  option("requeue");
  option("open-mode=append");
  option("output=\"" + batch_text(job.folder + "/logs/") + "%A_%a.log\"");
  text += "\nfolder=" + shell_word(job.folder) + "\n";
  if (!job.prologue.empty())
    text += "\n" + job.prologue + (job.prologue.ends_with('\n') ? "" : "\n");
  text +=
      "\n# The task's number determines its part, so that single tasks can be submitted again.\n" +
      job.program + " sweep run \"$folder\" --shard \"${SLURM_ARRAY_TASK_ID}/" + tasks +
      "\" \\\n  --jobs \"${SLURM_CPUS_PER_TASK:-1}\"" + job.more +
      " &\n"
      "child=$!\n"
      "\n# The signal before the time limit reaches this shell; palpate then finishes the cases "
      "that run.\n"
      "trap 'signalled=1; kill -TERM \"$child\" 2>/dev/null' TERM USR1\n"
      "signalled=1\n"
      "while [ \"$signalled\" = 1 ]; do\n"
      "  signalled=0\n"
      "  wait \"$child\"\n"
      "  code=$?\n"
      "done\n"
      "\n# Exit code 75: cases are left; the same task is queued again to continue.\n"
      "if [ \"$code\" = 75 ] && [ \"${SLURM_RESTART_COUNT:-0}\" -lt 100 ]; then\n"
      "  scontrol requeue \"${SLURM_ARRAY_JOB_ID}_${SLURM_ARRAY_TASK_ID}\"\n"
      "fi\n"
      "exit \"$code\"\n";
  return text;
}

}  // namespace palpate::sweep
