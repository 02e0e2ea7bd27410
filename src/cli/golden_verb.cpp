// `palpate golden bless`: replaces expected results by today's, and records the reason.
#include <cstdlib>
#include <filesystem>
#include <set>

#include "base/document_writer.h"
#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
#include "cli/program.h"
#include "cli/verbs.h"
#include "fit/case_fits.h"
#include "plot/process.h"
#include "record/csv.h"
#include "report/machine.h"
#include "report/results.h"
#include "run/family.h"

namespace palpate::cli {
namespace {

namespace fs = std::filesystem;

std::string git(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "git");
  const plot::ProcessResult result = plot::run_process({.argv = arguments});
  if (result.end != plot::ProcessResult::End::exited || result.code != 0)
    refuse("blessing needs the project's git history; run it in a checkout");
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

void refuse_where_unsafe() {
  if (const char* ci = std::getenv("CI"); ci != nullptr && *ci != '\0')
    refuse(
        "`CI` is set, and a machine must not bless its own results; "
        "run this by hand");
  if (const std::string changed = uncommitted(); !changed.empty())
    refuse("the tree has uncommitted changes (" + changed +
           "); commit them first, so that the blessing names the code");
}

void bless_one(const std::string& name, const std::string& reason) {
  const std::string folder = "golden/" + name;
  const scenario::Family family = scenario::read(folder + "/scenario.toml", {});
  const auto scenes = run::build_all(family, 1);
  const std::atomic<bool> stop = false;
  const auto records = run::run_all(scenes, 1, stop, [](std::size_t, const record::CaseRecord&) {});
  std::vector<fit::NamedFit> fits;
  for (std::size_t i = 0; i < records.size(); ++i)
    for (fit::NamedFit& named : fit::case_fits(scenes[i].scenario, records[i]))
      fits.push_back(std::move(named));
  const std::string expected = folder + "/expected";
  make_folders(expected);
  std::set<std::string> written;
  for (const auto& [file, table] : report::csv_files(family, records, fits)) {
    write_atomically(expected + "/" + file, record::csv_text(table));
    written.insert(expected + "/" + file);
  }
  for (const std::string& file : entries_of(expected))
    if (file.ends_with(".csv") && !written.contains(file)) fs::remove(file);  // no longer written
  const report::Build build = report::this_build();
  write_atomically(folder + "/blessed.toml", "reason = " + toml_text(reason) + "\ncommit = \"" +
                                                 trimmed(git({"rev-parse", "HEAD"})) +
                                                 "\"\ncompiler = \"" + build.compiler + "\"\n");
}

}  // namespace

int perform(const Bless& command, const Arguments&, const Talk& talk) {
  if (trimmed(command.reason).empty())
    refuse("`--reason` is empty; say why the results may change");
  for (const std::string& name : command.names)
    if (!fs::exists("golden/" + name + "/scenario.toml"))
      throw InputError({"golden/" + name + "/scenario.toml", 0, 0},
                       "is not there; name a folder below golden/ from the project's top");
  refuse_where_unsafe();
  for (const std::string& name : command.names) {
    bless_one(name, command.reason);
    talk.say("golden/" + name + ": blessed; commit it");
  }
  return exit_good;
}

}  // namespace palpate::cli
