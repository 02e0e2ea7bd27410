// Tables and sentences, with numbers in the units of the keys; files, run.json last.
#include "identify/tables.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/text.h"
#include "fit/residuals.h"
#include "page/page.h"
#include "plot/gnuplot_text.h"
#include "record/csv.h"
#include "scenario/integrators.h"
#include "scenario/tested.h"

namespace palpate::identify {

bool is_exact(const Identification& found) {
  const auto [least, most] = std::ranges::minmax_element(found.measured);
  return found.rmse < 1e-6 * (*most - *least);
}

namespace {

// Of a uniform specimen; contact laws in closed form are models.
bool by_formula(const CurveFit& found) {
  const CurveKind kind = found.kind;
  return found.closed_form && (kind == CurveKind::strain_time || kind == CurveKind::stress_time ||
                               kind == CurveKind::stress_strain);
}

using record::Cell;
using record::known;

Cell cell(const std::optional<double>& si, const Unknown& unknown) {
  return si ? Cell(unknown.shown(*si)) : Cell();
}

Cell word(bool yes) { return std::string(yes ? "yes" : "no"); }

// `57.2 kPa`, `0.45`
std::string with_unit(double value, const std::string& unit) {
  return rounded_text(value, 4) + (unit.empty() ? "" : " " + unit);
}

std::string interval_text(const Interval& interval, const Unknown& unknown, bool exact) {
  const std::string unit = unknown.unit_text();
  if (interval.low && interval.high && exact &&
      rounded_text(*interval.low, 4) == rounded_text(*interval.high, 4))
    return "exact to rounding";
  if (interval.low && interval.high)
    return rounded_text(*interval.low, 4) + " to " + with_unit(*interval.high, unit);
  if (interval.high) return "at most " + with_unit(*interval.high, unit);
  if (interval.low) return "at least " + with_unit(*interval.low, unit);
  return "open";
}

// `+3.1 %` for unknowns on a logarithmic scale, otherwise a difference in the unknown's unit.
std::string change(double moved, const Identified& one) {
  const bool relative = one.unknown.scale == Unknown::Scale::logarithmic;
  const double number = relative ? 100.0 * moved / one.estimate : one.unknown.shown(moved);
  const std::string unit = relative ? "%" : one.unknown.unit_text();
  return (number > 0.0 ? "+" : "") + rounded_text(number, 2) + (unit.empty() ? "" : " " + unit);
}

// An estimate in words: `12.3 kPa` and `(95 %: 11 to 13)`. Without an interval where it is not
// separately identifiable.
struct EstimateTexts {
  std::string value;
  std::string interval;
};
EstimateTexts estimate_texts(const Identification& found, const Identified& one) {
  if (one.inseparable) return {"not determined by itself", ""};
  return {with_unit(one.unknown.shown(one.estimate), one.unknown.unit_text()),
          "(95 %: " + interval_text(trusted(one), one.unknown, is_exact(found)) +
              (one.by_profile ? ", by profile)" : ")") +
              (one.at_bound ? "  on the edge of its range" : "")};
}

// The same of what is determined of unknowns that are not: `E / (1 - nu^2) = 66.9 kPa`.
EstimateTexts estimate_texts(const Combination& one) {
  return {one.text + " = " + with_unit(one.estimate, one.unit),
          "95 % " + rounded_text(one.ci95_low, 4) + " to " + rounded_text(one.ci95_high, 4)};
}

std::string combination_sentence(const Identification& found, const Combination& one) {
  std::vector<std::string> names;
  for (const std::size_t i : one.of) names.push_back("`" + found.unknowns[i].unknown.name() + "`");
  const auto [value, interval] = estimate_texts(one);
  return joined(names, " and ") +
         " are not separately identifiable: these data cannot tell them apart. Determined is " +
         value + ", " + interval + "; set one of them by `--set`.";
}

std::string model_sentence(const Identification& found) {
  const CurveWords& words = words_of(found.kind);
  std::string text = std::string(words.sentence) + ", by " + computed_by(found);
  if (found.predicted_error && !by_formula(found))
    text += ", predicted to be within " + percent_text(*found.predicted_error) +
            ", which the intervals contain";
  if (found.deep_effect)
    text += "; large strain changes the force at the deepest by " +
            std::string(*found.deep_effect > 0.0 ? "+" : "-") +
            percent_text(std::abs(*found.deep_effect)) + ", which is taken into account";
  return capitalized(text) + ".";
}

}  // namespace

Interval trusted(const Identified& one) {
  Interval interval;
  const auto& low = one.by_profile ? one.profile_low : one.ci95_low;
  const auto& high = one.by_profile ? one.profile_high : one.ci95_high;
  if (low) interval.low = one.unknown.shown(*low);
  if (high) interval.high = one.unknown.shown(*high);
  return interval;
}

std::string computed_by(const CurveFit& found) {
  return by_formula(found) ? "the formula of a uniform specimen"
                           : "`" + std::string(scenario::traits(found.taken).word) + "`";
}

record::Table identified_table(const Identification& found) {
  record::Table table;
  table.columns = {"unknown",   "unit",       "estimate",     "std_error",   "ci95_low",
                   "ci95_high", "at_bound",   "identifiable", "profile_low", "profile_high",
                   "interval",  "moved_down", "moved_up"};
  for (const Identified& one : found.unknowns) {
    const Unknown& unknown = one.unknown;
    const std::optional<double> estimate =
        one.inseparable ? std::nullopt : std::optional(one.estimate);
    table.rows.push_back(
        {unknown.name(), known(unknown.unit_text()), cell(estimate, unknown),
         cell(one.std_error, unknown), cell(one.ci95_low, unknown), cell(one.ci95_high, unknown),
         word(one.at_bound), word(!one.inseparable), cell(one.profile_low, unknown),
         cell(one.profile_high, unknown),
         one.inseparable ? Cell() : Cell(std::string(one.by_profile ? "profile" : "student")),
         cell(one.moved_down, unknown), cell(one.moved_up, unknown)});
  }
  for (const Combination& one : found.combinations) {
    table.rows.push_back({one.text, known(one.unit), one.estimate, one.std_error, one.ci95_low,
                          one.ci95_high, word(false), word(true), Cell(), Cell(),
                          std::string("student"), Cell(), Cell()});
  }
  return table;
}

record::Table correlation_table(const Identification& found) {
  record::Table table;
  table.columns = {"unknown"};
  const std::size_t n = found.unknowns.size();
  for (const Identified& one : found.unknowns) table.columns.push_back(one.unknown.name());
  for (std::size_t i = 0; i < n; ++i) {
    table.rows.push_back({found.unknowns[i].unknown.name()});
    for (std::size_t j = 0; j < n; ++j)
      table.rows.back().push_back(known(found.correlation[i * n + j]));
  }
  return table;
}

record::Table profile_table(const Identification& found) {
  record::Table table;
  table.columns = {"unknown", "unit", "value", "delta", "threshold"};
  for (const ProfilePoint& point : found.profile) {
    const Unknown& unknown = found.unknowns[point.unknown].unknown;
    const std::string unit = unknown.unit_text();
    table.rows.push_back(
        {unknown.name(), known(unit), unknown.shown(point.value), point.delta, found.threshold});
  }
  return table;
}

std::vector<std::string> identified_sentences(const Identification& found) {
  std::vector<std::string> lines;
  std::size_t width = 0;
  for (const Identified& one : found.unknowns) width = std::max(width, one.unknown.name().size());
  for (const Identified& one : found.unknowns) {
    const std::string gap(width - one.unknown.name().size() + 2, ' ');
    const auto [value, interval] = estimate_texts(found, one);
    lines.push_back(one.unknown.name() + gap + value + (interval.empty() ? "" : "  ") + interval);
  }
  for (const Combination& one : found.combinations)
    lines.push_back(combination_sentence(found, one));
  for (const GivenPart& part : found.givens)
    for (std::size_t i = 0; i < found.unknowns.size(); ++i)
      if (const Unknown& unknown = found.unknowns[i].unknown; !found.unknowns[i].inseparable)
        lines.push_back("Of this, `" + part.key + "` = " + part.value + " +- " + part.deviation +
                        " adds a standard error of " +
                        with_unit(unknown.shown(part.deviations[i]), unknown.unit_text()) +
                        " to `" + unknown.name() + "`.");
  const auto points_of = [](const Identification& one, const std::string& size) {
    const CurveWords& words = words_of(one.kind);
    return std::to_string(one.x.size()) + " points" +
           (one.excluded > 0 ? " (" + std::to_string(one.excluded) + " excluded)" : "") + size +
           ", RMSE " + with_unit(words.y.from_si(one.rmse), words.y.symbol) + ", R2 " +
           rounded_text(one.r2, 6);
  };
  const std::string size =
      found.rho > 0.0
          ? ", effective sample size " + rounded_text(std::max(1.0, found.effective_size), 3)
          : "";
  const std::string watson = ", Durbin-Watson " + rounded_text(found.durbin_watson, 3) + ".";
  if (found.pairs.empty()) {
    lines.push_back(model_sentence(found));
    lines.push_back(points_of(found, size) + watson);
  } else {
    for (std::size_t k = 0; k < found.pairs.size(); ++k)
      lines.push_back("Pair " + std::to_string(k + 1) + ": " + model_sentence(found.pairs[k]) +
                      " " + points_of(found.pairs[k], "") + ".");
    lines.push_back(std::to_string(found.x.size()) + " points together" + size + watson);
    for (std::size_t i = 0; i < found.unknowns.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        if (const double with = found.correlation[i * found.unknowns.size() + j];
            std::abs(with) > 0.9)
          lines.push_back("`" + found.unknowns[j].unknown.name() + "` and `" +
                          found.unknowns[i].unknown.name() + "` correlate by " +
                          rounded_text(with, 3) + ".");
  }
  const CurveWords& words = words_of(found.kind);
  for (const Identified& one : found.unknowns)
    if (one.moved_down && one.moved_up)
      lines.push_back(std::string(found.kind == CurveKind::force_travel ||
                                          found.kind == CurveKind::tangential_slide
                                      ? "A contact point "
                                      : "A start ") +
                      rounded_text(words.x.from_si(found.contact_shift), 2) +
                      (*words.x.symbol == '\0' ? "" : " ") + words.x.symbol +
                      " earlier or later changes `" + one.unknown.name() + "` by " +
                      change(*one.moved_down, one) + " or " + change(*one.moved_up, one) + ".");
  return lines;
}

std::vector<std::string> warnings_of(const Identification& found,
                                     const WeightedResiduals& residuals,
                                     const scenario::Resolved& with) {
  std::vector<std::string> warnings;
  // Systematic residuals below a thousandth of the curve come from interpolation.
  const bool few = found.rho > 0.0 && found.effective_size < 10.0;
  if ((fit::systematic(residuals.values) || few) && residuals.noise > 1e-3)
    warnings.push_back(fit::correlation_sentence(
        found.durbin_watson, found.x.size(),
        found.rho > 0.0 ? found.effective_size : static_cast<double>(found.x.size())));
  if (found.r2 < 0.9)
    warnings.push_back(
        "R^2 is " + rounded_text(found.r2, 3) +
        ", so that the model describes the curve poorly, and the estimates mean little");
  std::vector<std::string> inseparable;
  for (const Identified& one : found.unknowns)
    if (one.inseparable) inseparable.push_back("`" + one.unknown.name() + "`");
  if (!inseparable.empty())
    warnings.push_back(joined(inseparable, " and ") +
                       (inseparable.size() > 1 ? " have no numbers" : " has no number") +
                       ": these data do not tell; give one by `--set` or `--given`, or add a test "
                       "that differs, such as another radius or thickness, by `--with`");
  for (const Identified& one : found.unknowns)
    if (one.at_bound)
      warnings.push_back(
          "the best `" + one.unknown.name() +
          "` is on the edge of its range; widen the range, or hold it there with `--set`");
  for (const Identification* one : views(found))
    if (one->predicted_error && *one->predicted_error > with.solver.tolerance)
      warnings.push_back(
          "the estimated error of " + computed_by(*one) + " is " +
          percent_text(*one->predicted_error) +
          " here, and the estimates are wrong by about as much" +
          (one->given ? "; leave `solver.model` to `auto`"
           : one->scenario.uniform()
               ? ""
               : "; a search takes no `solid` by itself, which `--set solver.model=solid` does"));
  const auto waves = inertia_of_flow(with);
  if (waves && *waves > 0.01 && !about(with.solver.integrator).inertia)
    warnings.push_back("waves in the specimen change its deformation by about " +
                       percent_text(*waves) +
                       " and are neglected; set `solver.integrator = \"central_difference\"`");
  return warnings;
}

namespace {

// The text of scenario.toml, with which `palpate run` repeats the fitted curve.
std::string echo_of(const Identification& found, const scenario::Family& family) {
  scenario::Family one = family;
  one.cases.resize(1);
  one.cases.front().scenario = found.scenario;
  one.design = {};
  std::string text = "# Fitted to a measurement: `palpate run` of this file repeats the curve.\n";
  for (const Identified& each : found.unknowns) {
    const Unknown& unknown = each.unknown;
    const std::string value = rounded_text(unknown.shown(each.estimate), 6) +
                              (unknown.unit ? " " + unknown.unit_text() : "");
    if (each.inseparable)
      text +=
          "# " + unknown.name() + " is not determined by itself: one of many values that fit.\n";
    if (unknown.what == Unknown::What::contact_point)
      text += "# Displacement 0 is at " + value + " of the measurement.\n";
    if (unknown.what == Unknown::What::force_offset)
      text += "# contact.ambient_force holds the measurement's offset of " + value + ".\n";
  }
  return text + scenario::echo(one);
}

// The ending of the names of pair k's files.
std::string suffix_of(const Identification& found, std::size_t k) {
  return found.pairs.empty() ? "" : "_" + std::to_string(k + 1);
}

std::string figure_words(const std::string& name) {
  if (name.starts_with("profile"))
    return "How much worse the fit becomes if one value is fixed and the others are fitted; "
           "below "
           "the line the value is within the 95 % interval of the noise. What is not known of "
           "model, body and given values makes the stated interval wider.";
  return "Measured and fitted curve, and below them the residuals, measured minus model.";
}

// The arguments without those that change no result, run where the files lie.
std::string command_of(const std::vector<std::string>& argv, std::span<const Pair> pairs) {
  const auto file_of = [&](const std::string& word) {
    const std::string name = std::filesystem::path(word).filename().string();
    const bool known = std::ranges::any_of(pairs, [&](const Pair& pair) {
      return word == pair.file || name == pair.family->inputs.front().name;
    });
    return known ? name : word;
  };
  std::string text = "palpate";
  for (std::size_t i = 0; i < argv.size(); ++i) {
    const std::string& word = argv[i];
    if (word == "--out") ++i;
    const bool idle = word == "--force" || word == "--quiet" || word == "-q" || word == "--json" ||
                      word.starts_with("--out");
    if (!idle) text += " " + shown_word(file_of(word));
  }
  return text;
}

// x, measured, model, residual, in the units of the curve.
record::Table residual_table(const Identification& found) {
  const CurveWords& words = words_of(found.kind);
  const std::string y = words.y_column;
  const std::string unit = *words.y.symbol == '\0' ? "" : std::string("_") + words.y.symbol;
  record::Table table;
  table.columns = {words.x_column, "measured" + unit, "model" + unit, "residual" + unit};
  for (std::size_t i = 0; i < found.x.size(); ++i)
    table.rows.push_back({words.x.from_si(found.x[i]), words.y.from_si(found.measured[i]),
                          words.y.from_si(found.model[i]),
                          words.y.from_si(found.measured[i] - found.model[i])});
  return table;
}

// The page of an identification: what was found, how well it fits, and what it depends on.
void write_page(const Identification& found, std::span<const Pair> pairs,
                const std::vector<HashedFile>& inputs, const std::string& command,
                WholeFolder& folder) {
  page::Page page(pairs.front().family->title, "identification");
  // The first unknown large, the others and what the fit is below.
  std::vector<std::string> lines = identified_sentences(found);
  const Identified& first = found.unknowns.front();
  if (const auto [value, interval] = estimate_texts(found, first); !interval.empty()) {
    page.headline(plot::key_label(first.unknown.name()) + " " + value, interval);
    lines.erase(lines.begin());
  } else if (!found.combinations.empty()) {
    const auto [known, its_interval] = estimate_texts(found.combinations.front());
    page.headline(known, its_interval);
  }
  std::vector<std::string> unknown;
  for (const Identified& one : found.unknowns) unknown.push_back(one.unknown.name());
  page.answer(lines);
  if (pairs.size() == 1)  // what the unknowns depend on
    page.answer({joined(scenario::tested(pairs.front().family->cases.front(), unknown), "; ")});
  page.figures(page::all_figures(folder, figure_words));
  constexpr std::size_t most = 60;
  page.section(
      "Estimates",
      page::table_of_file("Estimates with 95 % intervals",
                          page::columns_of(identified_table(found),
                                           {"unknown", "estimate", "unit", "ci95_low", "ci95_high",
                                            "std_error", "identifiable", "at_bound"}),
                          "identified.csv", most) +
          page::table_of_file("Correlation of the estimates", correlation_table(found),
                              "correlation.csv", most));
  constexpr auto folded = page::Page::Shown::folded;
  std::vector<std::string> notes = found.notes;
  notes.insert(notes.end(), found.warnings.begin(), found.warnings.end());
  page.section("Notes", page::paragraphs(notes));
  page::Markup asked;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const std::string name = "scenario" + suffix_of(found, k) + ".toml";
    asked += page::folded("The scenario as written", pairs[k].family->inputs.front().content) +
             page::folded("The scenario with the estimates, " + name, read_text(folder.file(name)));
  }
  page.section("Scenario", asked, folded);
  page.section(
      "How it was made",
      page::making({.command = command,
                    .note = "It runs where the files below lie. Here, `palpate run scenario" +
                            suffix_of(found, 0) + ".toml` computes the fitted curve."},
                   inputs),
      folded);
  page::write(std::move(page), folder);
}

}  // namespace

std::vector<std::string> write_identification(const Identification& found,
                                              std::span<const Pair> pairs,
                                              const report::Origin& origin, WholeFolder& folder) {
  std::vector<std::string> warnings;
  folder.open();
  std::vector<scenario::InputFile> read;  // by the scenarios, each file once
  const std::string& title = pairs.front().family->title;
  const std::vector<const Identification*> all = views(found);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const std::string suffix = suffix_of(found, k);
    folder.write("scenario" + suffix + ".toml", echo_of(*all[k], *pairs[k].family));
    for (const scenario::InputFile& input : pairs[k].family->inputs) {
      const bool known =
          std::ranges::any_of(read, [&](const auto& one) { return one.name == input.name; });
      if (known) continue;
      if (&input != &pairs[k].family->inputs.front()) folder.write(input.name, input.content);
      read.push_back(input);
    }
    folder.write("residuals" + suffix + ".csv", record::csv_text(residual_table(*all[k])));
  }
  folder.write("identified.csv", record::csv_text(identified_table(found)));
  folder.write("correlation.csv", record::csv_text(correlation_table(found)));
  for (std::size_t k = 0; k < pairs.size(); ++k)
    plot::draw(identified_sheet(title, *all[k], suffix_of(found, k)), folder, warnings);
  if (!found.profile.empty()) {
    folder.write("profile.csv", record::csv_text(profile_table(found)));
    if (!is_exact(found)) plot::draw(profile_sheet(title, found), folder, warnings);
  }

  report::Manifest manifest{.origin = origin, .inputs = scenario::hashed(read), .complete = true};
  std::vector<HashedFile> inputs = manifest.inputs;
  for (const Pair& pair : pairs) {
    const std::string hash = file_sha256(pair.file);
    inputs.push_back({std::filesystem::path(pair.file).filename().string(), hash});
    manifest.inputs.push_back({pair.file, hash});
  }
  write_page(found, pairs, inputs, command_of(origin.argv, pairs), folder);
  manifest.outputs = folder.files();
  folder.write("run.json", report::manifest_text(manifest));
  return folder.put(WholeFolder::State::complete, warnings);
}

// gnuplot scripts of the data, model, residuals and profiles.

namespace {

std::string label(const char* name, const Unit& unit) {
  return *unit.symbol == '\0' ? name : std::string(name) + " (" + unit.symbol + ")";
}

std::pair<const char*, const char*> axes(CurveKind kind) {
  switch (kind) {
    case CurveKind::force_travel: return {"Displacement", "Force"};
    case CurveKind::force_time: return {"Time", "Force"};
    case CurveKind::tangential_slide: return {"Slide", "Tangential force"};
    case CurveKind::strain_time: return {"Time", "Strain"};
    case CurveKind::stress_time: return {"Time", "Stress"};
    case CurveKind::stress_strain: return {"Strain", "Stress"};
  }
  return {"", ""};
}

// The power of a thousand in which numbers up to `most` have one to three digits before the
// point; 1 for those from 0.001 on, and for 0.
double power_of_thousand(double most) {
  if (most >= 1e-3 || most == 0.0) return 1.0;
  return std::pow(10.0, 3.0 * std::floor(std::log10(most) / 3.0));
}

// `, 10^-12` for numbers that are drawn divided by such a power.
std::string power_text(double scale) { return scale == 1.0 ? "" : ", " + plot::tick_text(scale); }

double largest_residual(const Identification& found) {
  double most = 0.0;
  for (std::size_t i = 0; i < found.x.size(); ++i)
    most = std::max(most, std::abs(found.measured[i] - found.model[i]));
  return words_of(found.kind).y.from_si(most);
}

// Whether the values are positive but for some noise, which needs no tick below zero.
bool noise_about_zero(const Identification& found) {
  const auto [low, high] = std::ranges::minmax_element(found.measured);
  return low != found.measured.end() && *low < 0.0 && -*low < *high / 20.0;
}

}  // namespace

plot::Sheet identified_sheet(const std::string& title, const Identification& found,
                             const std::string& suffix) {
  const CurveWords& words = words_of(found.kind);
  const auto [x, y] = axes(found.kind);
  const std::string table = "residuals" + suffix + ".csv";
  const std::string file = "'" + table + "' using 1";
  std::string text = plot::gnuplot_head("curve" + suffix, {.height = 660, .tick_font = 12}) +
                     "set datafile missing NaN\nset multiplot\nset lmargin at screen 0.2\nset "
                     "rmargin at screen 0.97\n";
  text += "set title " + plot::gnuplot_quoted(title + ": measured and fitted") +
          "\nset tmargin at screen 0.91\nset bmargin at screen 0.42\n"
          "set format x ''\nset ylabel " +
          plot::gnuplot_quoted(label(y, words.y)) +
          "\nset key top left Left reverse samplen 2 spacing 1.2\n" +
          (noise_about_zero(found) ? "set autoscale yfixmin\n" : "") + "plot \\\n  " + file +
          ":2 with points pointtype 7 pointsize 0.4 linecolor rgb '#0072B2' title 'measured', \\\n"
          "  " +
          file +
          ":3 smooth unique with lines linewidth 1.6 linecolor rgb '#D55E00' title 'model'\n";
  const double scale = power_of_thousand(largest_residual(found));
  text +=
      "unset title\nunset key\nset autoscale y\nset tmargin at screen 0.38\nset bmargin at "
      "screen "
      "0.13\n"
      "set format x '%.10g'\nset xlabel " +
      plot::gnuplot_quoted(label(x, words.x)) + "\nset ylabel " +
      plot::gnuplot_quoted(label("Measured - model", words.y) + power_text(scale)) +
      "\nplot \\\n  0 with lines linewidth 1 linecolor rgb '#808080', \\\n  " + file + ":($4 / " +
      rounded_text(scale, 3) +
      ") with points pointtype 7 pointsize 0.4 linecolor rgb '#0072B2'\nunset multiplot\n";
  return {.name = "curve" + suffix, .script = text, .reads = {table}};
}

namespace {

struct ProfileAxis {
  double origin;  // subtracted from the values
  double scale;   // divides what is left
};

// Where the values differ in the fourth digit or later, which the numbers at the axis would not
// show, the axis is the difference from the estimate.
ProfileAxis profile_axis(const Identification& found, std::size_t i) {
  const Unknown& unknown = found.unknowns[i].unknown;
  const double estimate = unknown.shown(found.unknowns[i].estimate);
  double far = 0.0;
  for (const ProfilePoint& point : found.profile)
    if (point.unknown == i) far = std::max(far, std::abs(unknown.shown(point.value) - estimate));
  if (!(far < 1e-3 * std::abs(estimate))) return {0.0, 1.0};
  return {estimate, power_of_thousand(far)};
}

}  // namespace

plot::Sheet profile_sheet(const std::string& title, const Identification& found) {
  const std::size_t panels = found.unknowns.size();
  std::string text = plot::gnuplot_head("profile", {.height = static_cast<int>(60 + 270 * panels)});
  text += "set datafile missing NaN\nset multiplot layout " + std::to_string(panels) + ",1 title " +
          plot::gnuplot_quoted(title + ": profile likelihood, 95 % below the line") +
          "\nunset key\nset ylabel '(SSE - least SSE) / s^2'\nset rmargin 4\n"
          "set yrange [0:*]\n";
  for (std::size_t i = 0; i < panels; ++i) {
    const Identified& one = found.unknowns[i];
    const std::string unit = one.unknown.unit_text();
    const auto [origin, scale] = profile_axis(found, i);
    const std::string pick = "(strcol('unknown') eq '" + one.unknown.name() +
                             "' ? (column('value') - " + number_text(origin) + ") / " +
                             number_text(scale) + " : NaN)";
    text += "set xlabel " +
            plot::gnuplot_quoted(one.unknown.name() +
                                 (origin == 0.0 ? "" : " - " + rounded_text(origin, 4)) +
                                 (unit.empty() ? "" : " (" + unit + ")") + power_text(scale)) +
            " noenhanced\nplot \\\n  'profile.csv' using " + pick +
            ":(column('threshold')) with lines linewidth 1 linecolor rgb '#808080', \\\n"
            "  'profile.csv' using " +
            pick +
            ":(column('delta')) with linespoints pointtype 7 pointsize 0.5 linewidth 1.4 linecolor "
            "rgb '#0072B2'\n";
  }
  text += "unset multiplot\n";
  return {.name = "profile", .script = text, .reads = {"profile.csv"}};
}

}  // namespace palpate::identify
