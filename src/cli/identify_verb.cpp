// `palpate identify`: estimates tissue properties from a measured curve.
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "base/stop_scope.h"
#include "base/text.h"
#include "cli/interrupt.h"
#include "cli/program.h"
#include "cli/table_text.h"
#include "cli/verbs.h"
#include "identify/folder.h"
#include "identify/givens.h"
#include "identify/identify.h"
#include "identify/tables.h"
#include "measured/measured.h"
#include "report/machine.h"
#include "report/results.h"

namespace palpate::cli {
namespace {

identify::Measurement read_measurement(const Identify& command, const Talk& talk) {
  measured::MeasuredCurve curve = measured::read_measured(command.data, command.columns);
  for (const std::string& note : curve.notes) talk.say("note: " + note);
  return {.x = std::move(curve.x),
          .y = std::move(curve.y),
          .x_name = curve.x_axis.column,
          .y_name = curve.y_axis.column,
          .x_dimension = curve.x_axis.dimension,
          .y_dimension = curve.y_axis.dimension};
}

// The arguments say how the data are read and what is unknown.
std::string origin_of(const Identify& command, const Arguments& arguments,
                      const scenario::Family& family) {
  std::string text;
  for (const std::string& word : arguments.given)
    if (word != "--force" && word != "--quiet" && word != "-q" && word != "--json")
      text += word + "\n";
  return text + file_sha256(command.data) + "\n" + report::origin_of(family);
}

}  // namespace

int perform(const Identify& command, const Arguments& arguments, const Talk& talk) {
  const std::string started = report::utc_now();
  if (command.data.ends_with(".toml") && !command.scenario.ends_with(".toml"))
    throw InputError({command.data, 0, 0},
                     "is a scenario, and the measurement comes first; write `palpate identify " +
                         command.scenario + " " + command.data + "`");
  scenario::Family family = scenario::read(command.scenario, command.settings);
  for (const Problem& note : family.notes) talk.say("note: " + note.text());
  if (family.cases.size() > 1)
    talk.say("note: only the first of " + std::to_string(family.cases.size()) +
             " cases is fitted, " + family.cases.front().name);
  const std::vector<identify::Unknown> unknowns =
      identify::read_unknowns(command.unknowns, family.cases.front().scenario);
  const std::vector<identify::Given> givens =
      identify::read_givens(command.givens, family.cases.front().scenario, unknowns);
  identify::set_givens(family, givens);
  WholeFolder folder((std::filesystem::path(command.out) / (family.name + "_identified")).string(),
                     "identification", command.force ? Replace::any : Replace::incomplete,
                     origin_of(command, arguments, family));
  folder.refuse_what_is_there();
  const identify::Measurement measured = read_measurement(command, talk);
  identify::IdentifyOptions options;
  if (command.noise == "relative") options.noise = identify::Noise::relative;

  const StopScope scope(listen_for_interrupts(exit_interrupted));
  identify::Identification found;
  try {
    found = identify::identify(measured, family, unknowns, options);
    identify::carry_givens(found, measured, family, givens);
  } catch (const InputError&) {
    StopScope::end_if_stopped();
    throw;
  }
  for (const std::string& note : found.notes) talk.say("note: " + note);
  for (const std::string& warning : found.warnings) talk.warn(warning);
  for (const std::string& warning : identify::write_identification(
           found, family, command.data, {arguments.given, started}, folder))
    talk.warn(warning);
  if (talk.json()) {
    print(json_lines(identify::identified_table(found)));
  } else {
    for (const std::string& line : identify::identified_sentences(found)) print(line + "\n");
  }
  talk.say(folder.path() + ": identified.csv, residuals.csv, profile.csv, scenario.toml");
  return exit_good;
}

}  // namespace palpate::cli
