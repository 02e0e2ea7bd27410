// `palpate identify`: estimates tissue properties from a measured curve.
#include <algorithm>
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
#include "report/manifest.h"
#include "report/results.h"

namespace palpate::cli {
namespace {

// The loading history begins at time 0. A record whose clock begins later either leaves its
// beginning out or counts from elsewhere, and only the user knows.
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
  throw InputError({curve.file, 0, 0},
                   "its first row is at " + begins + " " + curve.x_axis.unit +
                       ", and the loading history of the scenario begins at 0; give `--origin " +
                       begins +
                       "` if it begins with that row, or `--origin 0` if the clock is that of the "
                       "loading history and the rows before are missing");
}

identify::Measurement read_measurement(const Identify& command, const std::string& data,
                                       const Talk& talk) {
  measured::MeasuredCurve curve = measured::read_measured(data, command.columns);
  const std::string where = command.with.empty() ? "note: " : "note: " + data + ": ";
  for (const std::string& note : curve.notes) talk.say(where + note);
  if (curve.guessed)
    talk.say(where + "x is `" + curve.x_axis.column + "` and y is `" + curve.y_axis.column + "`");
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

scenario::Family read_scenario(const Identify& command, const std::string& path, const Talk& talk) {
  scenario::Family family = scenario::read(path, command.settings);
  const std::string where = command.with.empty() ? "note: " : "note: " + path + ": ";
  for (const Problem& note : family.notes) talk.say("note: " + note.text());
  if (family.cases.size() > 1)
    talk.say(where + "only the first of " + std::to_string(family.cases.size()) +
             " cases is fitted, " + family.cases.front().name);
  const scenario::Case& first = family.cases.front();
  if (first.scenario.finger.material != "rigid" && !first.scenario.uniform())
    talk.say(where + "the finger is `" + first.scenario.finger.material +
             "`, which gives way; set `finger.material = \"rigid\"` for a ball of metal or glass");
  return family;
}

// The arguments say how the data are read and what is unknown.
std::string origin_of(const Arguments& arguments, std::span<const identify::PairFiles> pairs) {
  std::string text;
  for (const std::string& word : arguments.given)
    if (word != "--force" && word != "--quiet" && word != "-q" && word != "--json")
      text += word + "\n";
  for (const identify::PairFiles& pair : pairs)
    text += file_sha256(pair.measured) + "\n" + report::origin_of(*pair.family);
  return text;
}

}  // namespace

int perform(const Identify& command, const Arguments& arguments, const Talk& talk) {
  const std::string started = report::utc_now();
  std::vector<std::pair<std::string, std::string>> asked{{command.data, command.scenario}};
  asked.insert(asked.end(), command.with.begin(), command.with.end());
  if (asked.size() > 1 && !command.givens.empty())
    refuse("`--given` widens the intervals of one measurement; leave it or `--with` out");
  std::vector<scenario::Family> families;
  families.reserve(asked.size());
  std::vector<const scenario::Scenario*> scenarios;
  std::vector<identify::PairFiles> files;
  for (const auto& [data, path] : asked) {
    if (data.ends_with(".toml") && !path.ends_with(".toml"))
      throw InputError({data, 0, 0},
                       "is a scenario, and the measurement comes first; write `palpate identify " +
                           path + " " + data + "`");
    families.push_back(read_scenario(command, path, talk));
    scenarios.push_back(&families.back().cases.front().scenario);
    files.push_back({data, &families.back()});
  }
  const std::vector<identify::Unknown> unknowns =
      identify::read_unknowns(command.unknowns, scenarios);
  scenario::Family& family = families.front();
  const std::vector<identify::Given> givens =
      identify::read_givens(command.givens, family.cases.front().scenario, unknowns);
  identify::set_givens(family, givens);
  WholeFolder folder((std::filesystem::path(command.out) / (family.name + "_identified")).string(),
                     "identification", command.force ? Replace::any : Replace::incomplete,
                     origin_of(arguments, files));
  folder.refuse_what_is_there();
  std::vector<identify::Measurement> measured;
  measured.reserve(asked.size());
  std::vector<identify::Pair> pairs;
  for (const identify::PairFiles& one : files) {
    measured.push_back(read_measurement(command, one.measured, talk));
    pairs.push_back({&measured.back(), one.family});
  }
  identify::IdentifyOptions options;
  if (command.noise == "relative") options.noise = identify::Noise::relative;

  // Nothing is kept until the search has ended, so that an interrupt may end the program at once.
  identify::Identification found = identify::identify(pairs, unknowns, options);
  identify::carry_givens(found, measured.front(), family, givens);
  for (const std::string& note : found.notes) talk.say("note: " + note);
  for (const std::string& warning : found.warnings) talk.warn(warning);
  const std::string missing = warn_all(
      identify::write_identification(found, files, {arguments.given, started}, folder), talk);
  if (talk.json()) {
    print(json_lines(identify::identified_table(found)));
  } else {
    for (const std::string& line : identify::identified_sentences(found)) print(line + "\n");
  }
  const std::string each = files.size() > 1 ? "_1" : "";
  talk.say(folder.path() + ": identified.csv, residuals" + each + ".csv, profile.csv, scenario" +
           each + ".toml" + (files.size() > 1 ? " and those of the other pairs" : "") + missing);
  const auto tied = [](const identify::Identified& one) { return one.tied; };
  return std::any_of(found.unknowns.begin(), found.unknowns.end(), tied) ? exit_partial : exit_good;
}

}  // namespace palpate::cli
