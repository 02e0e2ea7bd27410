// `palpate sweep status` and `merge`: what there is, and all of it as one table.
#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/program.h"
#include "cli/sweep_verbs.h"
#include "report/response.h"
#include "study/sweep_columns.h"
#include "study/sweep_merge.h"

namespace palpate::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_reasons = 20;  // that people are told

int exit_of(const study::SweepTotals& totals) { return totals.good() ? exit_good : exit_partial; }

std::string status_json(const study::SweepTotals& totals, const study::SweepResults& results) {
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
  for (const study::RowFile& file : results.files())
    json["files"].push_back({{"path", file.path},
                             {"rows", file.rows},
                             {"corrupt", file.corrupt},
                             {"torn", file.torn},
                             {"foreign", file.foreign}});
  return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string status_text(const study::SweepTotals& totals, const study::SweepResults& results) {
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
  for (const study::RowFile& file : results.files())
    text += "  " + file.path + ": " + std::to_string(file.rows) +
            (file.rows == 1 ? " row\n" : " rows\n");
  return text;
}

// Sensitivity, maps and curves beside the table. What they cannot say is no failure of the merge.
void look_at(const study::SweepPlan& plan, const std::string& folder, const Sweep& command,
             const Talk& talk) {
  const scenario::Family& family = plan.family;
  if (family.design.empty()) return;
  const study::SweepColumns columns =
      study::read_sweep_columns(folder + "/results.csv", family.design, command.show);
  std::optional<report::DrawOptions> options;
  if (family.base.output.figures) options.emplace();
  if (options && family.base.output.pdf) options->format = report::PictureFormat::svg_and_pdf;
  const report::SweepDrawings drawn = report::draw_sweep(columns, family.title, folder, options);
  for (const std::string& warning : drawn.warnings) talk.warn(warning);
}

}  // namespace

int sweep_status(const Sweep& command, const Talk& talk) {
  const study::SweepPlan plan = study::read_plan(command.subject, program_identity());
  const study::SweepResults results(plan);
  const study::SweepTotals totals = study::count_results(plan, results);
  print(talk.json() ? status_json(totals, results) : status_text(totals, results));
  for (const std::string& warning : results.warnings()) talk.warn(warning);
  return exit_of(totals);
}

int sweep_merge(const Sweep& command, const Talk& talk) {
  const study::SweepPlan plan = study::read_plan(command.subject, program_identity());
  const study::SweepResults results(plan);
  const study::SweepTotals totals = study::count_results(plan, results);
  for (const std::string& warning : results.warnings()) talk.warn(warning);
  const std::string folder = study::merge_sweep(
      plan, results, totals, command.force ? study::Replace::any : study::Replace::incomplete);
  std::string text = folder + ": " + std::to_string(totals.completed) + " of " +
                     cases_text(totals.cases) + " completed";
  if (totals.diverged + totals.failed > 0)
    text += ", " + std::to_string(totals.diverged + totals.failed) + " failed";
  if (totals.missing > 0)
    text += ", " + std::to_string(totals.missing) + " missing (numbers " + totals.missing_numbers +
            "); `palpate sweep run` runs them";
  look_at(plan, folder, command, talk);
  talk.say(text);
  talk.event("merged", {{"folder", folder},
                        {"cases", std::to_string(totals.cases)},
                        {"completed", std::to_string(totals.completed)},
                        {"missing", std::to_string(totals.missing)}});
  return exit_of(totals);
}

}  // namespace palpate::cli
