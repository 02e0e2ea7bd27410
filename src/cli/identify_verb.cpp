// `palpate identify`: estimates tissue properties from a measured curve.
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"
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

// The programme begins at time 0. A record whose clock begins later either leaves its beginning out
// or counts from elsewhere, and only the user knows.
void begin_with_programme(const Identify& command, measured::MeasuredCurve& curve) {
  const bool time = curve.x_axis.dimension == Dimension{0, 0, 1};
  if (command.x_origin) {
    const double by = curve.x.front() == curve.x_written.front()
                          ? *command.x_origin
                          : *command.x_origin * (curve.x.back() - curve.x.front()) /
                                (curve.x_written.back() - curve.x_written.front());
    for (double& each : curve.x) each -= by;
    return;
  }
  if (!time || curve.x.size() < 2) return;
  const double first = curve.x.front();
  const double gap = curve.x[1] - curve.x[0];
  if (first <= gap * (1.0 + 1e-9)) return;
  const std::string begins = rounded_text(curve.x_written.front());
  throw InputError({command.data, 0, 0},
                   "its first row is at " + begins + " " + curve.x_axis.unit +
                       ", and the programme of the scenario begins at 0; give `--origin " + begins +
                       "` if it begins with that row, or `--origin 0` if the clock is that of the "
                       "programme and the rows before are missing");
}

identify::Measurement read_measurement(const Identify& command, const Talk& talk) {
  measured::MeasuredCurve curve = measured::read_measured(command.data, command.columns);
  for (const std::string& note : curve.notes) talk.say("note: " + note);
  if (curve.guessed)
    talk.say("note: x is `" + curve.x_axis.column + "` and y is `" + curve.y_axis.column + "`");
  if (curve.x_axis.stretch)
    for (double& each : curve.x) each -= 1.0;
  begin_with_programme(command, curve);
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

  // Nothing is kept until the search has ended, so that an interrupt may end the program at once.
  identify::Identification found = identify::identify(measured, family, unknowns, options);
  identify::carry_givens(found, measured, family, givens);
  for (const std::string& note : found.notes) talk.say("note: " + note);
  for (const std::string& warning : found.warnings) talk.warn(warning);
  const std::string missing =
      warn_all(identify::write_identification(found, family, command.data,
                                              {arguments.given, started}, folder),
               talk);
  if (talk.json()) {
    print(json_lines(identify::identified_table(found)));
  } else {
    for (const std::string& line : identify::identified_sentences(found)) print(line + "\n");
  }
  talk.say(folder.path() + ": identified.csv, residuals.csv, profile.csv, scenario.toml" + missing);
  return exit_good;
}

}  // namespace palpate::cli
