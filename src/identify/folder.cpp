// Writes the files of an identification, run.json last.
#include "identify/folder.h"

#include "base/text.h"
#include "identify/tables.h"
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
  manifest.inputs.push_back({measured, file_sha256(measured)});
  manifest.outputs = folder.files();
  manifest.complete = true;
  folder.write("run.json", report::manifest_text(manifest));
  return folder.put(WholeFolder::State::complete, warnings);
}

}  // namespace palpate::identify
