// `palpate identify`: estimates tissue properties from a measured curve.
#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "base/index.h"
#include "base/text.h"
#include "cli/program.h"
#include "cli/table_text.h"
#include "cli/verbs.h"
#include "fit/parts.h"
#include "fit/regression.h"
#include "identify/identify.h"
#include "identify/tables.h"
#include "identify/unknowns.h"
#include "measured/measured.h"
#include "report/manifest.h"
#include "report/results.h"

namespace palpate::cli {
namespace {

// The step of a record of creep or relaxation, whose protocol is a step at time 0, and of a record
// whose clock begins later than the ramp of its first step and that goes on after it. In s.
std::optional<fit::StepOrigin> step_of(const scenario::Scenario& scenario,
                                       const measured::MeasuredCurve& curve, bool late) {
  using fit::AfterStep;
  const scenario::Step& first = scenario.steps.front();
  if (std::holds_alternative<scenario::Relax>(first))
    return fit::step_origin(curve.x, curve.y, AfterStep::relaxes, 0.0);
  if (const auto* creep = std::get_if<scenario::Creep>(&first)) {
    const bool voigt = scenario.tissue.viscosity == tissue::Viscosity::kelvin_voigt;
    const auto coarse = fit::step_origin(
        curve.x, curve.y, voigt ? AfterStep::rises_from_zero : AfterStep::rises, 0.0);
    if (!coarse.after_level || coarse.sentence.empty()) return coarse;
    return fit::refined(coarse, curve.x, curve.y, [&](const fit::Loading& loading) {
      std::vector<double> x = curve.x;  // under load
      for (double& each : x)
        if (each < loading.first || each >= loading.time + creep->load_time) each = std::nan("");
      return fit::misfit_of([&] {
        return fit::regress(x, curve.y,
                            voigt ? fit::Model::kelvin_voigt : fit::Model::standard_linear_solid,
                            {.x_origin = loading.time});
      });
    });
  }
  if (!late) return std::nullopt;
  std::optional<double> ramp;
  if (const auto* compress = std::get_if<scenario::Compress>(&first)) ramp = compress->ramp_time();
  if (const auto* indent = std::get_if<scenario::Indent>(&first); indent && !indent->to.second)
    ramp = indent->to.value / indent->rate;
  const auto largest = [](double a, double b) { return std::abs(a) < std::abs(b); };
  const auto peak = std::ranges::max_element(curve.y, largest);
  if (!ramp || scenario.steps.size() > 2 || curve.y.end() - peak < 4) return std::nullopt;
  return fit::step_origin(curve.x, curve.y, AfterStep::relaxes, *ramp);
}

// The loading history begins at time 0. Where the record shows its step, that is where it begins;
// otherwise a clock that begins later either leaves the beginning out or counts from elsewhere, and
// only the user knows.
std::string begin_with_programme(const Identify& command, const scenario::Scenario& scenario,
                                 measured::MeasuredCurve& curve, std::vector<double>& starts) {
  const bool time = curve.x_axis.dimension == Dimension{0, 0, 1};
  const std::size_t last = curve.x.size() - 1;
  const double per_unit =
      last > 0 && curve.x.front() != curve.x_written.front()
          ? (curve.x[last] - curve.x[0]) / (curve.x_written[last] - curve.x_written[0])
          : 1.0;
  const auto shift = [&](double by) {
    for (double& each : curve.x) each -= by;
  };
  if (command.x_origin) {
    shift(*command.x_origin * per_unit);
    return {};
  }
  if (!time || curve.x.size() < 2) return {};
  const double first = curve.x.front();
  const bool late = first > (curve.x[1] - curve.x[0]) * (1.0 + 1e-9);
  if (const auto step = step_of(scenario, curve, late)) {
    shift(step->best.time);
    for (const fit::Loading& other : step->others) starts.push_back(other.time - step->best.time);
    return step->sentence + (step->sentence.empty() || per_unit == 1.0 ? "" : ", in s");
  }
  if (!late) return {};
  const std::string begins = rounded_text(curve.x_written.front());
  throw InputError({curve.file, 0, 0},
                   "its first row is at " + begins + " " + curve.x_axis.unit +
                       ", and the loading history of the scenario begins at 0; give `--origin " +
                       begins +
                       "` if it begins with that row, or `--origin 0` if the clock is that of the "
                       "loading history and the rows before are missing");
}

// Strains below 0, and stretches below 1, are the compression that the scenario counts as positive,
// from its beginning on; says so.
std::string turn_compression(const scenario::Scenario& scenario, measured::MeasuredCurve& curve) {
  if (!std::holds_alternative<scenario::Compress>(scenario.steps.front()) ||
      !(curve.x_axis.dimension == Dimension{}) ||
      !(curve.y_axis.dimension == unit::kPa.dimension) || curve.x.empty())
    return {};
  const auto [least, most] = std::ranges::minmax_element(curve.x);
  if (*least > -0.1 * *most) {
    if (!curve.x_axis.stretch) return {};
    throw InputError({curve.file, 0, 0},
                     "`" + curve.x_axis.column +
                         "` is a stretch above 1, which is tension, and the scenario compresses; "
                         "fit it by `palpate fit --model ogden`");
  }
  const bool load = curve.y[as_index(least - curve.x.begin())] < 0.0;
  for (double& each : curve.x) each = 0.0 - each;
  if (load)
    for (double& each : curve.y) each = 0.0 - each;
  if (curve.x.front() > curve.x.back()) {
    std::ranges::reverse(curve.x);
    std::ranges::reverse(curve.y);
  }
  return "`" + curve.x_axis.column + "` is negative in compression; sign changed" +
         (load ? ", and that of `" + curve.y_axis.column + "`" : "");
}

// Adds notes, which are said once there is a result.
identify::Measurement read_measurement(const Identify& command, const std::string& data,
                                       const scenario::Scenario& scenario,
                                       std::vector<std::string>& notes) {
  measured::MeasuredCurve curve = measured::read_measured(data, command.columns);
  std::vector<std::string> own = curve.notes;
  if (curve.guessed)
    own.push_back("x is `" + curve.x_axis.column + "` and y is `" + curve.y_axis.column + "`");
  if (curve.x_axis.stretch)
    for (double& each : curve.x) each -= 1.0;
  own.push_back(turn_compression(scenario, curve));
  std::vector<double> starts;
  own.push_back(begin_with_programme(command, scenario, curve, starts));
  for (const std::string& note : own)
    if (!note.empty()) notes.push_back((command.with.empty() ? "" : data + ": ") + note);
  return {.x = std::move(curve.x),
          .y = std::move(curve.y),
          .x_name = curve.x_axis.column,
          .y_name = curve.y_axis.column,
          .x_dimension = curve.x_axis.dimension,
          .y_dimension = curve.y_axis.dimension,
          .starts = std::move(starts)};
}

scenario::Family read_scenario(const Identify& command, const std::string& path,
                               std::vector<std::string>& notes) {
  scenario::Family family = scenario::read(path, command.settings);
  const std::string where = command.with.empty() ? "" : path + ": ";
  for (const Problem& note : family.notes) notes.push_back(note.text());
  if (family.cases.size() > 1)
    notes.push_back(where + "only the first of " + std::to_string(family.cases.size()) +
                    " cases is fitted, " + family.cases.front().name);
  const scenario::Case& first = family.cases.front();
  if (first.scenario.finger.material != "rigid" && !first.scenario.uniform())
    notes.push_back(
        where + "the finger's material is `" + first.scenario.finger.material +
        "`, which gives way; set `finger.material = \"rigid\"` for a ball of metal or glass");
  return family;
}

// The arguments say how the data are read and what is unknown.
std::string origin_of(const Arguments& arguments, std::span<const identify::Pair> pairs) {
  std::string text;
  for (const std::string& word : arguments.given)
    if (word != "--force" && word != "--quiet" && word != "-q" && word != "--json")
      text += word + "\n";
  for (const identify::Pair& pair : pairs)
    text += file_sha256(pair.file) + "\n" + report::origin_of(*pair.family);
  return text;
}

}  // namespace

int perform(const Identify& command, const Arguments& arguments, const Talk& talk) {
  const std::string started = report::utc_now();
  std::vector<std::pair<std::string, std::string>> asked{{command.data, command.scenario}};
  asked.insert(asked.end(), command.with.begin(), command.with.end());
  if (asked.size() > 1 && !command.givens.empty())
    refuse("`--given` widens the intervals of one measurement; leave it or `--with` out");
  std::vector<std::string> notes;
  std::vector<scenario::Family> families;
  families.reserve(asked.size());
  std::vector<const scenario::Scenario*> scenarios;
  std::vector<identify::Pair> pairs;
  for (const auto& [data, path] : asked) {
    if (data.ends_with(".toml") && !path.ends_with(".toml"))
      throw InputError({data, 0, 0},
                       "is a scenario, and the measurement comes first; write `palpate identify " +
                           path + " " + data + "`");
    families.push_back(read_scenario(command, path, notes));
    scenarios.push_back(&families.back().cases.front().scenario);
    pairs.push_back({nullptr, &families.back(), data});
  }
  const std::vector<identify::Unknown> unknowns =
      identify::read_unknowns(command.unknowns, scenarios);
  scenario::Family& family = families.front();
  const std::vector<identify::Given> givens =
      identify::read_givens(command.givens, family.cases.front().scenario, unknowns);
  identify::set_givens(family, givens);
  WholeFolder folder((std::filesystem::path(command.out) / (family.name + "_identified")).string(),
                     "identification", command.force ? Replace::any : Replace::incomplete,
                     origin_of(arguments, pairs));
  folder.refuse_what_is_there();
  std::vector<identify::Measurement> measured;
  measured.reserve(asked.size());
  for (identify::Pair& pair : pairs) {
    measured.push_back(
        read_measurement(command, pair.file, pair.family->cases.front().scenario, notes));
    pair.measured = &measured.back();
  }
  identify::IdentifyOptions options;
  if (command.noise == "relative") options.noise = identify::Noise::relative;

  // Nothing is kept until the search has ended, so that an interrupt may end the program at once.
  std::optional<ProgressLine> ticker(std::in_place, talk, [&](double) { return family.name; });
  identify::Identification found = identify::identify(pairs, unknowns, options);
  identify::carry_givens(found, measured.front(), family, givens, options.noise);
  ticker.reset();
  notes.insert(notes.end(), found.notes.begin(), found.notes.end());
  for (const std::string& note : notes) talk.say("note: " + note);
  for (const std::string& warning : found.warnings) talk.warn(warning);
  const std::string missing = warn_all(
      identify::write_identification(found, pairs, {arguments.given, started}, folder), talk);
  if (talk.json()) {
    print(json_lines(identify::identified_table(found)));
  } else {
    for (const std::string& line : identify::identified_sentences(found)) print(line + "\n");
  }
  const std::string each = pairs.size() > 1 ? "_1" : "";
  talk.say(folder.path() + ": identified.csv, residuals" + each + ".csv, profile.csv, scenario" +
           each + ".toml" + (pairs.size() > 1 ? " and those of the other pairs" : "") + missing);
  talk.next("open", folder.path());
  const auto inseparable = [](const identify::Identified& one) { return one.inseparable; };
  return std::ranges::any_of(found.unknowns, inseparable) ? exit_partial : exit_good;
}

}  // namespace palpate::cli
