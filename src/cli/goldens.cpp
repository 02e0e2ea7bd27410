// Finds, computes and keeps results of scenarios.
#include "cli/goldens.h"

#include <fcntl.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "base/error.h"
#include "base/files.h"
#include "base/index.h"
#include "fit/case_fits.h"
#include "record/csv.h"
#include "run/family.h"

namespace palpate::cli {
namespace {

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

}  // namespace

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

report::CsvFiles compute(const std::string& scenario, int workers) {
  const scenario::Family family = scenario::read(scenario, {});
  const auto scenes = run::build_all(family, workers);
  const std::atomic<bool> stop = false;
  const auto records =
      run::run_all(scenes, workers, stop, [](std::size_t, const record::CaseRecord&) {});
  std::vector<fit::NamedFit> fits;
  for (std::size_t i = 0; i < records.size(); ++i)
    for (fit::NamedFit& named : fit::case_fits(scenes[i].scenario, records[i]))
      fits.push_back(std::move(named));
  return report::csv_files(family, records, fits);
}

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

}  // namespace palpate::cli
