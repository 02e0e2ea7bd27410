// `palpate sweep`: its verbs.

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/child_process.h"
#include "base/error.h"
#include "base/files.h"
#include "base/index.h"
#include "base/stopwatch.h"
#include "base/text.h"
#include "base/written.h"
#include "cli/arguments.h"
#include "cli/interrupt.h"
#include "cli/program.h"
#include "cli/talk.h"
#include "cli/verbs.h"
#include "report/family_figures.h"
#include "scenario/tested.h"
#include "sweep/columns.h"
#include "sweep/journal.h"
#include "sweep/merge.h"
#include "sweep/plan.h"
#include "sweep/response.h"
#include "sweep/run.h"
#include "sweep/slurm.h"

namespace palpate::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_reasons = 20;  // printed by `status`

int exit_of(const sweep::SweepTotals& totals, const Sweep& command) {
  const bool good = command.accept_failed || totals.diverged + totals.failed == 0;
  return good && totals.missing == 0 ? exit_good : exit_partial;
}

// What the commands of parts end with.
std::string accepting(const Sweep& command) {
  return command.accept_failed ? " --accept-failed" : "";
}

std::string status_json(const sweep::SweepTotals& totals, const sweep::SweepResults& results) {
  Json json{{"cases", totals.cases},
            {"completed", totals.completed},
            {"diverged", totals.diverged},
            {"failed", totals.failed},
            {"missing", totals.missing},
            {"missing_numbers", totals.missing_numbers},
            {"corrupt_lines", results.corrupt()}};
  json["reasons"] = Json::object();
  for (const auto& [reason, count] : totals.reasons) json["reasons"][reason] = count;
  json["files"] = Json::array();
  for (const record::JournalFile& file : results.files())
    json["files"].push_back({{"path", file.path},
                             {"rows", file.rows},
                             {"corrupt", file.corrupt},
                             {"torn", file.torn},
                             {"foreign", file.whose == record::JournalFile::Whose::another}});
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string status_text(const sweep::SweepTotals& totals, const sweep::SweepResults& results) {
  std::string text;
  const auto line = [&](const std::string& name, std::size_t count, const std::string& more = "") {
    text += name + std::string(name.size() < 12 ? 12 - name.size() : 1, ' ') +
            std::to_string(count) + more + "\n";
  };
  line("cases", totals.cases);
  line("completed", totals.completed);
  line("diverged", totals.diverged);
  line("failed", totals.failed);
  std::size_t said = 0;
  for (const auto& [reason, count] : totals.reasons)
    if (said++ < most_reasons) text += "  " + std::to_string(count) + " x " + reason + "\n";
  if (said > most_reasons)
    text += "  and " + std::to_string(said - most_reasons) + " other reasons\n";
  line("missing", totals.missing,
       totals.missing > 0 ? "  (numbers " + totals.missing_numbers + ")" : "");
  line("corrupt", results.corrupt());
  line("files", results.files().size());
  // A part that was continued has several files: one line a part, 10 behind 2.
  using ByLength = decltype([](const std::string& a, const std::string& b) {
    return std::pair(a.size(), a) < std::pair(b.size(), b);
  });
  std::map<std::string, std::pair<std::size_t, std::size_t>, ByLength> parts;  // files and rows
  for (const record::JournalFile& file : results.files()) {
    const std::string name = std::filesystem::path(file.path).filename().string();
    auto& [files, rows] = parts[name.substr(0, name.find('_'))];
    ++files;
    rows += file.rows;
  }
  for (const auto& [part, count] : parts)
    text += "  " + part + ": " + count_text(count.second, "row") + " in " +
            count_text(count.first, "file") + "\n";
  return text;
}

// What repeats a merged sweep in its folder, from the copy of the scenario in that of the plan.
std::string repeating(const sweep::SweepPlan& plan, const Sweep& command) {
  std::string text = "palpate sweep plan ../inputs/scenario.toml";
  if (plan.curves) text += " --curves";
  if (plan.count() > sweep::sweep_ceiling) text += " --yes";
  text += "\npalpate sweep run out/scenario_sweep\npalpate sweep merge out/scenario_sweep";
  for (const std::string& column : command.show) text += " --show " + shown_word(column);
  return text;
}

// What all cases of a plan test, by the first of them; empty if it cannot be made.
std::string common_to_all(const scenario::Family& family) {
  try {
    return joined(scenario::tested(scenario::make_case(family, 0), family.design.keys()), "; ");
  } catch (const InputError&) {  // the row of this case says why
    return "";
  }
}

struct LookedAt {
  std::string range = {};                  // of the first result; empty if it has none
  std::vector<std::string> warnings = {};  // on what could not be computed: no failure of the merge
};

// Writes sensitivity, maps, curves and the page beside the table.
LookedAt look_at(const sweep::SweepPlan& plan, const Sweep& command,
                 const sweep::SweepTotals& totals, const sweep::SweepAnswer& answer,
                 WholeFolder& folder) {
  const scenario::Family& family = plan.family;
  LookedAt looked;
  if (family.design.empty()) return looked;
  const sweep::SweepColumns columns =
      sweep::read_sweep_columns(folder.file("results.csv"), family.design, command.show);
  std::optional<plot::DrawOptions> options;
  if (family.base.output.figures) options.emplace();
  if (options) options->formats = report::picture_formats(family.base.output);
  const sweep::Sensitivity found = sweep::sensitivity(columns);
  if (!columns.outputs.empty()) looked.range = sweep::range_text(columns.outputs.front());
  looked.warnings = sweep::draw_sweep(columns, found, family.title, folder, options);
  if (family.base.output.report)
    sweep::write_sweep_page(
        {.columns = columns,
         .found = found,
         .answer = answer,
         .title = family.title,
         .tested = common_to_all(family),
         .totals = std::to_string(totals.completed) + " of " + count_text(totals.cases, "case") +
                   " completed, " + std::to_string(totals.diverged + totals.failed) + " failed, " +
                   std::to_string(totals.missing) + " missing.",
         .incomplete = totals.completed < totals.cases,
         .scenario = family.inputs.front().content,
         .command = repeating(plan, command),
         .warnings = looked.warnings},
        folder);
  return looked;
}

int sweep_status(const Sweep& command, const Talk& talk) {
  const sweep::SweepPlan plan = sweep::read_plan(command.subject, program_identity());
  const sweep::SweepResults results(plan);
  const sweep::SweepTotals totals = sweep::count_results(plan, results);
  print(talk.json() ? status_json(totals, results) : status_text(totals, results));
  for (const std::string& warning : results.warnings()) talk.warn(warning);
  const bool failed = totals.diverged + totals.failed > 0;
  talk.next(totals.missing > 0 ? "sweep run"
            : failed           ? "sweep retry"
                               : "sweep merge",
            command.subject);
  return exit_of(totals, command);
}

int sweep_merge(const Sweep& command, const Talk& talk) {
  const sweep::SweepPlan plan = sweep::read_plan(command.subject, program_identity());
  const sweep::SweepResults results(plan);
  const sweep::SweepTotals totals = sweep::count_results(plan, results);
  for (const std::string& warning : results.warnings()) talk.warn(warning);
  using State = WholeFolder::State;
  // The same rows and columns give the same tables and figures.
  Sha256 origin;
  origin.add(plan.hash);
  for (std::size_t i = 0; i < plan.count(); ++i)
    if (results.at(i).known()) origin.add(sweep::id_text(results.at(i).head.seal));
  for (const std::string& column : command.show) origin.add("\n" + column);
  WholeFolder folder((std::filesystem::path(plan.folder) / "merged").string(), "merged sweep",
                     command.force ? Replace::any : Replace::incomplete, origin.digits());
  folder.refuse_what_is_there();
  folder.open();
  const sweep::SweepAnswer answer = sweep::merge_sweep(plan, results, totals, folder);
  const LookedAt looked = look_at(plan, command, totals, answer, folder);
  const std::string undrawn = warn_all(
      folder.put(totals.missing == 0 ? State::complete : State::incomplete, looked.warnings), talk);
  std::string text = folder.path() + ": " + std::to_string(totals.completed) + " of " +
                     count_text(totals.cases, "case") + " completed";
  if (totals.diverged + totals.failed > 0)
    text += ", " + std::to_string(totals.diverged + totals.failed) + " failed";
  if (totals.missing > 0)
    text += ", " + std::to_string(totals.missing) + " missing (numbers " + totals.missing_numbers +
            "); `palpate sweep run` runs them";
  if (const std::string error = answer.error(); !error.empty())
    talk.say((looked.range.empty() ? "Error:" : looked.range) + " " + error + ".");
  for (const std::string& line : answer.lines()) talk.say(line);
  talk.say(text + undrawn);
  talk.next("open", folder.path());
  talk.event("merged", {{"folder", folder.path()},
                        {"cases", totals.cases},
                        {"completed", totals.completed},
                        {"missing", totals.missing}});
  return exit_of(totals, command);
}

// The program as a shell takes it: as given, or this one.
std::string program_word(const Sweep& command) {
  if (command.program.empty())
    return shell_word(std::filesystem::read_symlink("/proc/self/exe").string());
  for (const char c : command.program)
    if (static_cast<unsigned char>(c) < 0x20)
      throw InputError(
          {}, "`--program` wants one line; write `--program \"apptainer exec x.sif palpate\"`");
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
    throw InputError(
        {}, "`--time " + command.time +
                "` is longer than every partition of this cluster allows; give at most `--time " +
                std::to_string(static_cast<long>(longest / 60.0)) + "`, in minutes");
}

// The folder as a command of a part names it: on one line.
std::string folder_of_parts(const Sweep& command) {
  std::string folder = std::filesystem::canonical(command.subject).string();
  if (std::ranges::any_of(folder, [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return byte < 0x20 || byte == 0x7f;
      }))
    throw InputError({}, "`" + folder +
                             "` has a control character in its name, which the commands of parts "
                             "cannot hold; rename the folder");
  return folder;
}

int sweep_parts(const Sweep& command, const Talk& talk) {
  const sweep::SweepPlan plan = sweep::read_plan(command.subject, program_identity());
  const std::string start =
      program_word(command) + " sweep run " + shell_word(folder_of_parts(command));
  const sweep::SweepResults results(plan);
  const std::vector<std::size_t> parts =
      sweep::unfinished_parts(plan, results, as_index(command.of));
  const auto cost = talk.json() && !parts.empty() ? sweep::forecast(plan.family, plan.curves)
                                                  : std::optional<sweep::SweepForecast>();
  std::string text;
  for (const std::size_t part : parts) {
    const std::string call = start + " --shard " + std::to_string(part) + "/" +
                             std::to_string(command.of) + " --jobs 1" + accepting(command);
    text += call + "\n";
    if (!talk.json()) continue;
    std::size_t cases = 0;
    for (std::size_t i = part - 1; i < plan.count(); i += as_index(command.of))
      if (!results.at(i).known()) ++cases;
    Talk::Details details{{"command", call}, {"part", part}, {"cases", cases}};
    if (cost) {
      const double share = static_cast<double>(cases) / static_cast<double>(plan.count());
      details.emplace_back("seconds", rounded(share * cost->seconds, 3));
      details.emplace_back("memory_bytes", rounded(cost->memory, 3));
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
  const std::string folder = folder_of_parts(command);
  const auto chunk = as_index(command.chunk);
  const sweep::SlurmJob job{.name = plan.family.name,
                            .program = program_word(command),
                            .prologue = command.prologue.empty() ? "" : read_text(command.prologue),
                            .folder = folder,
                            .tasks = (plan.count() + chunk - 1) / chunk,
                            .more = accepting(command),
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
  const std::vector<std::size_t> parts =
      sweep::unfinished_parts(plan, sweep::SweepResults(plan), job.tasks);
  const std::string call =
      "sbatch --array=" + sweep::number_ranges(parts, 0) + " " + shell_word(path);
  talk.event("submit", {{"command", parts.empty() ? "" : call},
                        {"job", path},
                        {"tasks", job.tasks},
                        {"unfinished", parts.size()}});
  if (parts.empty())
    talk.say(command.subject + ": every case has a row; there is nothing to submit");
  else if (!talk.json())
    print(call + "\n");
  return exit_good;
}

std::string progress_text(const sweep::SweepProgress& now, double seconds) {
  std::string text = bar(now.done, now.all, seconds);
  if (now.done > 0)
    text += ", " + rounded_text(static_cast<double>(now.done) / seconds, 3) + " cases/s";
  if (now.failed > 0) text += ", " + std::to_string(now.failed) + " failed";
  return text;
}

// The file of `--done` may replace one of an earlier run, or an empty one.
void check_done(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) return;
  const std::string text = read_text(path);
  if (!text.empty() && text.substr(0, text.find(' ')).find("-of-") == std::string::npos)
    throw InputError(
        {path, 0, 0},
        "exists and was not written by `--done`; name another file, or remove this one");
}

int sweep_run(const Sweep& command, const Talk& talk) {
  if (!command.done.empty()) check_done(command.done);
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
    talk.event("progress", {{"done", now.done},
                            {"all", now.all},
                            {"failed", now.failed},
                            {"seconds", rounded(seconds)}});
  };
  const Stopwatch watch;
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
  event(watch.seconds());
  if (!std::filesystem::exists(command.subject + "/plan.json"))
    throw SystemError(command.subject +
                      " has vanished while its cases ran, and their rows with it; plan anew");
  for (const std::string& warning : end.warnings) talk.warn(warning);
  std::string text = command.subject + ": " + std::to_string(end.completed) + " of " +
                     count_text(end.all, "case") + " completed";
  if (end.failed > 0) text += ", " + std::to_string(end.failed) + " failed";
  if (end.missing > 0) text += ", " + std::to_string(end.missing) + " missing";
  talk.event("end", {{"all", end.all},
                     {"completed", end.completed},
                     {"failed", end.failed},
                     {"missing", end.missing}});
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
  if (end.missing == 0) talk.next("sweep merge", command.subject);
  return good ? exit_good : exit_partial;
}

int sweep_plan(const Sweep& command, const Talk& talk) {
  sweep::SweepOrder order{.scenario = command.subject,
                          .settings = command.settings,
                          .out = command.out,
                          .workers = worker_count(0),
                          .program = program_identity()};
  order.reuse = command.reuse;
  if (command.curves) order.curves = sweep::SweepOrder::Curves::kept;
  if (command.yes) order.ceiling = sweep::SweepOrder::Ceiling::lifted;
  const sweep::Planned planned = sweep::plan_sweep(order);
  for (const Problem& note : planned.notes) talk.say("note: " + note.text());
  const std::string cases = count_text(planned.cases, "case");
  if (planned.there_already)
    talk.say(planned.folder + ": the same plan of " + cases + " is there already");
  else
    talk.say(planned.folder + ": " + cases + " planned" +
             (planned.forecast ? ", " + planned.forecast->text() : ""));
  if (!command.reuse.empty())
    talk.say(planned.folder + ": " + std::to_string(planned.reused) + " of " + cases +
             " taken over from " + command.reuse);
  Talk::Details details{{"folder", planned.folder},
                        {"cases", planned.cases},
                        {"there_already", planned.there_already}};
  if (planned.forecast) {
    details.emplace_back("seconds", rounded(planned.forecast->seconds, 3));
    details.emplace_back("row_bytes", rounded(planned.forecast->bytes, 3));
    details.emplace_back("memory_bytes", rounded(planned.forecast->memory, 3));
  }
  talk.event("plan", details);
  talk.next("sweep run", planned.folder);
  return exit_good;
}

}  // namespace

int perform(const Sweep& command, const Arguments&, const Talk& talk) {
  switch (command.act) {
    case Sweep::Act::plan: return sweep_plan(command, talk);
    case Sweep::Act::run:
    case Sweep::Act::retry: return sweep_run(command, talk);
    case Sweep::Act::status: return sweep_status(command, talk);
    case Sweep::Act::merge: return sweep_merge(command, talk);
    case Sweep::Act::parts: return sweep_parts(command, talk);
    case Sweep::Act::slurm: return sweep_slurm(command, talk);
  }
  return exit_internal;
}

}  // namespace palpate::cli
