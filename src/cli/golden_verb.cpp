// `palpate golden`: keeps results of scenarios and compares with them.
#include <fcntl.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "base/child_process.h"
#include "base/document.h"
#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "cli/checks.h"
#include "cli/program.h"
#include "cli/table_text.h"
#include "cli/verbs.h"
#include "compare/compare.h"
#include "fit/case_fits.h"
#include "record/csv.h"
#include "report/manifest.h"
#include "report/results.h"
#include "run/family.h"

namespace palpate::cli {
namespace {

// A scenario with its kept results. Those of NAME.toml are in NAME.expected/ beside it, with the
// reason of the last change in its baseline.toml and their tolerances in NAME.tolerances.toml;
// `scenario.toml`, which is called after its folder, has them in expected/ and tolerances.toml.
struct KeptResult {
  std::string scenario;    // path
  std::string expected;    // folder
  std::string tolerances;  // path of a file that need not exist

  [[nodiscard]] static KeptResult of(const std::string& scenario);
  [[nodiscard]] bool is_kept() const;
};

namespace fs = std::filesystem;

// The kept results at or below a folder.
void find_below(const std::string& folder, std::vector<KeptResult>& found) {
  std::error_code error;
  fs::recursive_directory_iterator entry(folder, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    if (entry->path().extension() != ".toml") continue;
    if (KeptResult kept = KeptResult::of(entry->path().string()); kept.is_kept())
      found.push_back(std::move(kept));
  }
  if (error)
    throw InputError({folder, 0, 0}, "cannot be read: " + error.message() +
                                         "; give a folder of scenarios with baselines");
}

KeptResult KeptResult::of(const std::string& scenario) {
  const fs::path path = fs::path(scenario).lexically_normal();
  const std::string stem = path.stem().string();
  const std::string before = stem == "scenario" ? "" : stem + ".";
  return {.scenario = path.string(),
          .expected = (path.parent_path() / (before + "expected")).string(),
          .tolerances = (path.parent_path() / (before + "tolerances.toml")).string()};
}

bool KeptResult::is_kept() const {
  std::error_code ignored;
  return fs::is_directory(expected, ignored);
}

// The kept results of scenarios, and of all scenarios at or below folders, sorted by path. Throws
// InputError for a path that does not exist, a scenario without a kept result, and if there are
// none at all.
std::vector<KeptResult> kept_results(const std::vector<std::string>& subjects) {
  std::vector<KeptResult> found;
  for (const std::string& subject : subjects) {
    if (fs::is_directory(subject)) {
      find_below(subject, found);
      continue;
    }
    found.push_back(KeptResult::of(subject));
    if (!fs::exists(subject))
      throw InputError({subject, 0, 0}, "is not there; give a scenario or a folder");
    if (!found.back().is_kept())
      throw InputError({subject, 0, 0},
                       "has no baseline; write `palpate golden add " + subject + "`");
  }
  std::ranges::sort(found, {}, &KeptResult::scenario);
  if (found.empty())
    throw InputError({subjects.front(), 0, 0},
                     "has no scenario with a baseline; write `palpate golden add SCENARIO`");
  return found;
}

// Runs a scenario and returns its CSV files. Throws InputError and MeshError.
report::CsvFiles compute(const std::string& scenario, int workers) {
  const scenario::Family family = scenario::read(scenario, {});
  const auto scenes = run::build_all(family, workers);
  const auto records = run::run_all(scenes, workers, [](std::size_t, const record::CaseRecord&) {});
  std::vector<fit::NamedFit> fits;
  for (std::size_t i = 0; i < records.size(); ++i)
    for (fit::NamedFit& named :
         fit::case_fits(scenes[i].scenario, records[i], fit::Residuals::correlated))
      fits.push_back(std::move(named));
  return report::csv_files(family, records, fits);
}

// Writes the files and, if there is one, the text of baseline.toml into the folder, and removes CSV
// files there that are no longer written and the reason of others. Throws SystemError.
void keep(const report::CsvFiles& files, const std::string& baseline, const std::string& folder) {
  constexpr const char* reason = "baseline.toml";
  for (const auto& [file, table] : files)
    if (const int at = table.find("outcome"); at >= 0)
      for (const auto& row : table.rows)
        if (row[as_index(at)] == record::Cell(std::string("diverged")))
          throw InputError(
              {folder, 0, 0},
              "would keep a case that diverged; mend the scenario, so that it runs to its end");
  // Beside it, and then in one exchange.
  const std::string fresh = folder + ".partial";
  fs::remove_all(fresh);
  make_folders(fresh);
  for (const auto& [file, table] : files)
    write_atomically(fresh + "/" + file, record::csv_text(table));
  if (!baseline.empty()) write_atomically(fresh + "/" + reason, baseline);
  if (fs::exists(folder)) {
    fs::permissions(fresh, fs::status(folder).permissions());
    for (const std::string& path : entries_of(folder))
      if (const std::string name = fs::path(path).filename();
          !name.ends_with(".csv") && name != reason)
        fs::copy(path, fresh + "/" + name,
                 fs::copy_options::recursive | fs::copy_options::copy_symlinks);
    if (::renameat2(AT_FDCWD, fresh.c_str(), AT_FDCWD, folder.c_str(), RENAME_EXCHANGE) == 0) {
      fs::remove_all(fresh);
      return;
    }
    fs::remove_all(folder);  // the file system cannot exchange two folders
  }
  fs::rename(fresh, folder);
}

void refuse_to_machines() {
  if (const char* ci = std::getenv("CI"); ci != nullptr && *ci != '\0')
    refuse(
        "`CI` is set, and a machine must not replace what it is checked against; run this by hand");
}

// The commit of the folder's git checkout, with `-dirty` where files differ from it; empty outside
// of one.
std::string commit_of(const std::string& folder) {
  const ChildResult result =
      run_process({.argv = {"git", "-C", folder.empty() ? "." : folder, "describe", "--always",
                            "--dirty", "--abbrev=40", "--exclude=*"}});
  return result.good() ? trimmed(result.output) : "";
}

// What is kept beside results that were replaced for a reason.
std::string baseline_text(const std::string& reason, const std::string& commit) {
  return "reason = " + toml_text(reason) + "\n" +
         (commit.empty() ? "" : "commit = \"" + commit + "\"\n") + "compiler = \"" +
         report::this_build().compiler + "\"\n";
}

int add(const Golden& command, const Talk& talk) {
  refuse_to_machines();
  for (const std::string& scenario : command.subjects)
    if (const KeptResult kept = KeptResult::of(scenario); kept.is_kept() && !command.force)
      throw InputError(
          {kept.expected, 0, 0},
          "holds the baseline of " + one_line(scenario) +
              "; see what differs by `palpate golden check`, and give `--force` to replace it");
  std::vector<std::string> commits;  // before any file changes
  for (const std::string& scenario : command.subjects)
    commits.push_back(
        command.reason.empty() ? "" : commit_of(fs::path(scenario).parent_path().string()));
  for (std::size_t i = 0; i < command.subjects.size(); ++i) {
    const KeptResult kept = KeptResult::of(command.subjects[i]);
    keep(compute(kept.scenario, worker_count(command.jobs)),
         command.reason.empty() ? "" : baseline_text(command.reason, commits[i]), kept.expected);
    talk.event("added", {{"scenario", kept.scenario}, {"expected", kept.expected}});
    talk.say(one_line(kept.expected) + ": baseline stored");
  }
  if (command.subjects.size() == 1) talk.next("golden check", command.subjects.front());
  return exit_good;
}

std::vector<KeptResult> asked(const Golden& command) {
  return kept_results(command.subjects.empty() ? std::vector<std::string>{"."} : command.subjects);
}

// Runs a scenario and compares. An error ends this check only; `code` becomes its exit code.
compare::Check check_one(const KeptResult& kept, int workers, int& code) {
  compare::Check check{.name = kept.scenario, .want = kept.expected};
  const auto failed = [&](const std::exception& error, int its_code) {
    check.error = kept.scenario + ": cannot be checked: " + error.what();
    if (code == exit_good || code == exit_different) code = its_code;
  };
  try {
    compare::Tolerances tolerances;
    if (fs::exists(kept.tolerances)) tolerances = compare::read_tolerances(kept.tolerances);
    compare::Tables got;
    for (auto& [file, table] : compute(kept.scenario, workers))
      got[file] = [table = std::move(table)] { return table; };
    check.comparison =
        compare::compare_tables(got, compare::tables_below(kept.expected), tolerances);
    if (!check.equal() && code == exit_good) code = exit_different;
  } catch (const InputError& error) {
    failed(error, exit_input);
  } catch (const MeshError& error) {
    failed(error, exit_mesh);
  }
  return check;
}

int check(const Golden& command, const Talk& talk) {
  const std::vector<KeptResult> all = asked(command);
  std::vector<compare::Check> checks;
  int code = exit_good;
  for (const KeptResult& kept : all) {
    talk.progress(bar(checks.size(), all.size()) + ", " + kept.scenario);
    checks.push_back(check_one(kept, worker_count(command.jobs), code));
  }
  talk.progress("");
  report_checks(checks, command.options, talk);
  const auto equal = std::ranges::count_if(checks, &compare::Check::equal);
  talk.say(
      std::to_string(equal) + " of " + std::to_string(checks.size()) +
      (checks.size() == 1 ? " scenario gives its baseline" : " scenarios give their baselines"));
  return code;
}

int list(const Golden& command, const Talk& talk) {
  record::Table table{{"scenario", "expected", "files", "tolerances"}, {}};
  for (const KeptResult& kept : asked(command)) {
    record::Cell tolerances;
    if (fs::exists(kept.tolerances)) tolerances = one_line(kept.tolerances);
    table.rows.push_back({one_line(kept.scenario), one_line(kept.expected),
                          static_cast<double>(compare::tables_below(kept.expected).size()),
                          tolerances});
  }
  print_result(table, table, talk);
  return exit_good;
}

}  // namespace

int perform(const Golden& command, const Arguments&, const Talk& talk) {
  switch (command.act) {
    case Golden::Act::add: return add(command, talk);
    case Golden::Act::check: return check(command, talk);
    case Golden::Act::list: break;
  }
  return list(command, talk);
}

}  // namespace palpate::cli
