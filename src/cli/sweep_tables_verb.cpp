// `palpate sweep status` and `merge`: count the results of a sweep, and write them as one table.
#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "base/files.h"
#include "cli/program.h"
#include "cli/sweep_verbs.h"
#include "report/family_figures.h"
#include "sweep/columns.h"
#include "sweep/merge.h"
#include "sweep/response.h"

namespace palpate::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_reasons = 20;  // printed by `status`

int exit_of(const sweep::SweepTotals& totals) { return totals.good() ? exit_good : exit_partial; }

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
    text += "  " + part + ": " + std::to_string(count.second) +
            (count.second == 1 ? " row in " : " rows in ") + std::to_string(count.first) +
            (count.first == 1 ? " file\n" : " files\n");
  return text;
}

// Writes sensitivity, maps, curves and the page beside the table. Returns notes on what could not
// be computed; this is no failure of the merge.
std::vector<std::string> look_at(const sweep::SweepPlan& plan, const Sweep& command,
                                 const sweep::SweepTotals& totals, WholeFolder& folder) {
  const scenario::Family& family = plan.family;
  if (family.design.empty()) return {};
  const sweep::SweepColumns columns =
      sweep::read_sweep_columns(folder.file("results.csv"), family.design, command.show);
  std::optional<plot::DrawOptions> options;
  if (family.base.output.figures) options.emplace();
  if (options) options->formats = report::picture_formats(family.base.output);
  const sweep::Sensitivity found = sweep::sensitivity(columns);
  std::vector<std::string> remarks =
      sweep::draw_sweep(columns, found, family.title, folder, options);
  if (family.base.output.report)
    sweep::write_sweep_page(
        {.columns = columns,
         .found = found,
         .title = family.title,
         .totals = std::to_string(totals.completed) + " of " + cases_text(totals.cases) +
                   " completed, " + std::to_string(totals.diverged + totals.failed) + " failed, " +
                   std::to_string(totals.missing) + " missing.",
         .scenario = family.inputs.front().content,
         .remarks = remarks},
        folder);
  return remarks;
}

}  // namespace

int sweep_status(const Sweep& command, const Talk& talk) {
  const sweep::SweepPlan plan = sweep::read_plan(command.subject, program_identity());
  const sweep::SweepResults results(plan);
  const sweep::SweepTotals totals = sweep::count_results(plan, results);
  print(talk.json() ? status_json(totals, results) : status_text(totals, results));
  for (const std::string& warning : results.warnings()) talk.warn(warning);
  return exit_of(totals);
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
  sweep::merge_sweep(plan, results, totals, folder);
  const std::string undrawn =
      warn_all(folder.put(totals.missing == 0 ? State::complete : State::incomplete,
                          look_at(plan, command, totals, folder)),
               talk);
  std::string text = folder.path() + ": " + std::to_string(totals.completed) + " of " +
                     cases_text(totals.cases) + " completed";
  if (totals.diverged + totals.failed > 0)
    text += ", " + std::to_string(totals.diverged + totals.failed) + " failed";
  if (totals.missing > 0)
    text += ", " + std::to_string(totals.missing) + " missing (numbers " + totals.missing_numbers +
            "); `palpate sweep run` runs them";
  talk.say(text + undrawn);
  talk.event("merged", {{"folder", folder.path()},
                        {"cases", std::to_string(totals.cases)},
                        {"completed", std::to_string(totals.completed)},
                        {"missing", std::to_string(totals.missing)}});
  return exit_of(totals);
}

}  // namespace palpate::cli
