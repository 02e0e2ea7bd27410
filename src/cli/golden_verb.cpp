// `palpate golden`: keeps results of scenarios, compares with them, and blesses palpate's own.
#include <fcntl.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

#include "base/child_process.h"
#include "base/document_writer.h"
#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "cli/checks.h"
#include "cli/program.h"
#include "cli/table_text.h"
#include "cli/verbs.h"
#include "compare/compare_folders.h"
#include "fit/case_fits.h"
#include "record/csv.h"
#include "report/machine.h"
#include "report/results.h"
#include "run/family.h"

namespace palpate::cli {
namespace {

// A scenario with its kept results. Those of NAME.toml are in NAME.expected/ beside it, with their
// tolerances in NAME.tolerances.toml; `scenario.toml`, which is called after its folder, has them
// in expected/ and tolerances.toml.
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
                                         "; give a folder of scenarios and their kept results");
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
                       "has no kept result; write `palpate golden add " + subject + "`");
  }
  std::sort(found.begin(), found.end(),
            [](const KeptResult& a, const KeptResult& b) { return a.scenario < b.scenario; });
  if (found.empty())
    throw InputError({subjects.front(), 0, 0},
                     "has no scenario with a kept result; write `palpate golden add SCENARIO`");
  return found;
}

// Runs a scenario and returns its CSV files. Throws InputError and MeshError.
report::CsvFiles compute(const std::string& scenario, int workers) {
  const scenario::Family family = scenario::read(scenario, {});
  const auto scenes = run::build_all(family, workers);
  const auto records = run::run_all(scenes, workers, [](std::size_t, const record::CaseRecord&) {});
  std::vector<fit::NamedFit> fits;
  for (std::size_t i = 0; i < records.size(); ++i)
    for (fit::NamedFit& named : fit::case_fits(scenes[i].scenario, records[i]))
      fits.push_back(std::move(named));
  return report::csv_files(family, records, fits);
}

// Writes the files into the folder, and removes CSV files there that are no longer written. Throws
// SystemError.
void keep(const report::CsvFiles& files, const std::string& folder) {
  for (const auto& [file, table] : files)
    if (const int at = table.find("outcome"); at >= 0)
      for (const auto& row : table.rows)
        if (row[as_index(at)] == record::Cell(std::string("diverged")))
          throw InputError({folder, 0, 0},
                           "would keep a case that diverged; mend the scenario, so that it runs to "
                           "its end");
  // Beside it, and then in one exchange.
  const std::string fresh = folder + ".partial";
  fs::remove_all(fresh);
  make_folders(fresh);
  for (const auto& [file, table] : files)
    write_atomically(fresh + "/" + file, record::csv_text(table));
  if (fs::exists(folder)) {
    for (const std::string& path : entries_of(folder))
      if (!path.ends_with(".csv"))
        fs::copy(path, fresh + "/" + fs::path(path).filename().string(),
                 fs::copy_options::recursive | fs::copy_options::copy_symlinks);
    if (::renameat2(AT_FDCWD, fresh.c_str(), AT_FDCWD, folder.c_str(), RENAME_EXCHANGE) == 0) {
      fs::remove_all(fresh);
      return;
    }
    fs::remove_all(folder);  // the file system cannot exchange two folders
  }
  fs::rename(fresh, folder);
}

namespace fs = std::filesystem;

std::string git(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "git");
  const ChildResult result = run_process({.argv = arguments});
  if (!result.good()) refuse("blessing needs the project's git history; run it in a checkout");
  return result.output;
}

// The files that git lists as changed, except expected results that were just blessed.
std::string uncommitted() {
  std::string changed;
  for (const std::string& line : split(git({"status", "--porcelain", "-uall"}), '\n')) {
    const bool blessed = line.find(" golden/") != std::string::npos &&
                         (line.find("/expected/") != std::string::npos ||
                          line.find("/blessed.toml") != std::string::npos);
    if (!line.empty() && !blessed) changed += (changed.empty() ? "" : ", ") + trimmed(line);
  }
  return changed;
}

void refuse_to_machines() {
  if (const char* ci = std::getenv("CI"); ci != nullptr && *ci != '\0')
    refuse(
        "`CI` is set, and a machine must not bless its own results; "
        "run this by hand");
}

void refuse_dirty_tree() {
  if (const std::string changed = uncommitted(); !changed.empty())
    refuse("the tree has uncommitted changes (" + changed +
           "); commit them first, so that the blessing names the code");
}

void bless_one(const std::string& name, const std::string& reason) {
  const std::string folder = "golden/" + name;
  keep(compute(folder + "/scenario.toml", 1), folder + "/expected");
  const report::Build build = report::this_build();
  write_atomically(folder + "/blessed.toml", "reason = " + toml_text(reason) + "\ncommit = \"" +
                                                 trimmed(git({"rev-parse", "HEAD"})) +
                                                 "\"\ncompiler = \"" + build.compiler + "\"\n");
}

int bless(const Golden& command, const Talk& talk) {
  if (trimmed(command.reason).empty())
    refuse("`--reason` is empty; say why the results may change");
  for (const std::string& name : command.subjects)
    if (!fs::exists("golden/" + name + "/scenario.toml"))
      throw InputError({"golden/" + name + "/scenario.toml", 0, 0},
                       "is not there; name a folder below golden/ from the project's top");
  refuse_to_machines();
  refuse_dirty_tree();
  for (const std::string& name : command.subjects) {
    bless_one(name, command.reason);
    talk.say("golden/" + name + ": blessed; commit it");
  }
  return exit_good;
}

int add(const Golden& command, const Talk& talk) {
  refuse_to_machines();
  for (const std::string& scenario : command.subjects)
    if (const KeptResult kept = KeptResult::of(scenario); kept.is_kept() && !command.force)
      throw InputError({kept.expected, 0, 0},
                       "holds the kept result of " + scenario +
                           "; see what differs by `palpate golden check`, and give `--force` to "
                           "replace it");
  for (const std::string& scenario : command.subjects) {
    const KeptResult kept = KeptResult::of(scenario);
    keep(compute(kept.scenario, worker_count(command.jobs)), kept.expected);
    talk.say(kept.expected + ": kept");
  }
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
  const auto equal = std::count_if(checks.begin(), checks.end(),
                                   [](const compare::Check& one) { return one.equal(); });
  talk.say(std::to_string(equal) + " of " + std::to_string(checks.size()) +
           (checks.size() == 1 ? " scenario gives" : " scenarios give") + " the kept results");
  return code;
}

int list(const Golden& command, const Talk& talk) {
  record::Table table{{"scenario", "expected", "files", "tolerances"}, {}};
  for (const KeptResult& kept : asked(command)) {
    record::Cell tolerances;
    if (fs::exists(kept.tolerances)) tolerances = kept.tolerances;
    table.rows.push_back({kept.scenario, kept.expected,
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
    case Golden::Act::list: return list(command, talk);
    case Golden::Act::bless: break;
  }
  return bless(command, talk);
}

}  // namespace palpate::cli
