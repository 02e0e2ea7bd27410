// `palpate identify`: the properties behind a measured curve.
#include "base/error.h"
#include "base/text.h"
#include "cli/interrupt.h"
#include "cli/program.h"
#include "cli/table_text.h"
#include "cli/verbs.h"
#include "fit/identified_tables.h"
#include "fit/identify.h"
#include "record/measured.h"
#include "report/identified_folder.h"
#include "report/machine.h"

namespace palpate::cli {
namespace {

fit::Measurement read_measurement(const Identify& command, const Talk& talk) {
  record::MeasuredCurve curve = record::read_measured(command.data, command.columns);
  for (const std::string& note : curve.notes) talk.say("note: " + note);
  return {.x = std::move(curve.x),
          .y = std::move(curve.y),
          .x_name = curve.x_axis.column,
          .y_name = curve.y_axis.column,
          .x_dimension = curve.x_axis.dimension,
          .y_dimension = curve.y_axis.dimension};
}

}  // namespace

int identify(const Identify& command, const Arguments& arguments, const Talk& talk) {
  const std::string started = report::utc_now();
  const scenario::Family family = scenario::read(command.scenario, command.settings);
  for (const Problem& note : family.notes) talk.say("note: " + note.text());
  if (family.cases.size() > 1)
    talk.say("note: of " + std::to_string(family.cases.size()) + " cases the first is fitted, " +
             family.cases.front().name);
  const std::vector<fit::Unknown> unknowns =
      fit::read_unknowns(command.unknowns, family.cases.front().scenario);
  report::IdentifiedFolder folder(command.out, family.name, command.force);
  const fit::Measurement measured = read_measurement(command, talk);
  fit::IdentifyOptions options;
  if (command.noise == "relative") options.noise = fit::Noise::relative;

  const std::atomic<bool>& stop = listen_for_interrupts(exit_interrupted);
  fit::Identification found;
  try {
    found = fit::identify(measured, family, unknowns, stop, options);
  } catch (const InputError&) {
    if (!stop.load()) throw;
    Talk::error("palpate: interrupted; nothing was written");
    return exit_interrupted;
  }
  for (const std::string& note : found.notes) talk.say("note: " + note);
  for (const std::string& warning : found.warnings) talk.warn(warning);
  for (const std::string& warning :
       folder.write(found, family, command.data, {arguments.given, started}))
    talk.warn(warning);
  if (talk.json()) {
    print(json_lines(fit::identified_table(found)));
  } else {
    for (const std::string& line : fit::identified_sentences(found)) print(line + "\n");
  }
  talk.say(folder.path() +
           ": identified.csv, residuals.csv, profile.csv, curve.svg, scenario.toml");
  return exit_good;
}

}  // namespace palpate::cli
