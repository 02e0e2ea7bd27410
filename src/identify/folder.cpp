// Writes the files of an identification, run.json last.
#include "identify/folder.h"

#include <filesystem>

#include "base/text.h"
#include "identify/tables.h"
#include "page/page.h"
#include "record/csv.h"
#include "report/manifest.h"

namespace palpate::identify {
namespace {

// The text of scenario.toml, with which `palpate run` repeats the fitted curve.
std::string echo_of(const identify::Identification& found, const scenario::Family& family) {
  scenario::Family one = family;
  one.cases.resize(1);
  one.cases.front().scenario = found.scenario;
  one.design = {};
  std::string text = "# Fitted to a measurement: `palpate run` of this file repeats the curve.\n";
  for (const identify::Identified& each : found.unknowns) {
    const identify::Unknown& unknown = each.unknown;
    const std::string value = rounded_text(unknown.shown(each.estimate), 6) +
                              (unknown.unit ? " " + unknown.unit_text() : "");
    if (each.tied)
      text += "# " + unknown.key + " is not determined by itself: one of many values that fit.\n";
    if (unknown.what == identify::Unknown::What::contact_point)
      text += "# Travel 0 is at " + value + " of the measurement.\n";
    if (unknown.what == identify::Unknown::What::force_offset)
      text += "# contact.ambient_force holds the measurement's offset of " + value + ".\n";
  }
  return text + scenario::echo(one);
}

std::string figure_words(const std::string& name) {
  if (name == "profile")
    return "How much worse the fit becomes if one value is kept and the others follow; below the "
           "line the value is within the 95 % interval.";
  return "Measured and fitted curve, and below them the residuals, measured minus model.";
}

// The page of an identification: what was found, how well it fits, and what it depends on.
void write_page(const identify::Identification& found, const scenario::Family& family,
                const std::vector<HashedFile>& inputs, WholeFolder& folder) {
  page::Page page(family.title, "identification");
  page.answer(identified_sentences(found));
  page.section("Figures", page::all_figures(folder, figure_words));
  constexpr std::size_t most = 60;
  page.section("Estimates",
               page::table_of_file("Estimates with 95 % intervals", identified_table(found),
                                   "identified.csv", most) +
                   page::table_of_file("Correlation of the estimates", correlation_table(found),
                                       "correlation.csv", most));
  std::vector<std::string> remarks = found.notes;
  remarks.insert(remarks.end(), found.warnings.begin(), found.warnings.end());
  page.section("Remarks", page::paragraphs(remarks));
  page.section("What was asked",
               page::folded("The scenario as written", family.inputs.front().content) +
                   page::folded("The scenario with the estimates, scenario.toml",
                                read_text(folder.file("scenario.toml"))));
  page.section("How it was made",
               page::making({.command = "palpate run scenario.toml",
                             .remark = "The command repeats the fitted curve. `palpate identify` "
                                       "with the files below repeats the fit."},
                            inputs, folder));
  page::write(std::move(page), folder);
}

}  // namespace

std::vector<std::string> write_identification(const Identification& found,
                                              const scenario::Family& family,
                                              const std::string& measured,
                                              const report::Origin& origin, WholeFolder& folder) {
  std::vector<std::string> warnings;
  folder.open();
  folder.write("scenario.toml", echo_of(found, family));
  for (const scenario::InputFile& input : family.inputs)
    if (&input != &family.inputs.front()) folder.write(input.name, input.content);
  folder.write("identified.csv", record::csv_text(identified_table(found)));
  folder.write("correlation.csv", record::csv_text(correlation_table(found)));
  folder.write("residuals.csv", record::csv_text(residual_table(found)));
  plot::draw(identified_sheet(family.title, found), folder, warnings);
  if (!found.profile.empty()) {
    folder.write("profile.csv", record::csv_text(profile_table(found)));
    plot::draw(profile_sheet(family.title, found), folder, warnings);
  }

  report::Manifest manifest = report::begin_manifest(origin, family.inputs);
  std::vector<HashedFile> inputs = manifest.inputs;
  inputs.push_back({std::filesystem::path(measured).filename().string(), file_sha256(measured)});
  write_page(found, family, inputs, folder);
  manifest.inputs.push_back({measured, inputs.back().sha256});
  manifest.outputs = folder.files();
  manifest.complete = true;
  folder.write("run.json", report::manifest_text(manifest));
  return folder.put(WholeFolder::State::complete, warnings);
}

}  // namespace palpate::identify
