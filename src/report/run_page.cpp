// Puts the page of a run together.
#include "report/run_page.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/text.h"
#include "base/units.h"
#include "page/html.h"
#include "page/page.h"
#include "plot/gnuplot_text.h"
#include "report/answer_lines.h"
#include "report/finding_words.h"
#include "report/map_picture.h"
#include "report/scene_picture.h"
#include "scenario/model_traits.h"
#include "scenario/resolved.h"
#include "scenario/tested.h"

namespace palpate::report {
namespace {

using page::element;
using page::Markup;

using Records = std::vector<record::CaseRecord>;

struct Rows {
  record::Table table{{"the paper", "here", "verdict", "why"}, {}};
  void add(const std::string& paper, const std::string& here, const std::string& verdict,
           const std::string& why) {
    table.rows.push_back({paper, here, verdict, why});
  }
};

std::string agrees(bool yes) { return page::verdicts[yes ? 0 : 1]; }

// Eq. (2) with Table 1, for the row of the largest force: the row's own indentation, and the radius
// with the curvature of the surface there.
struct Predicted {
  double indentation = 0.0;  // m
  double force = 0.0;        // N, of the run
  double equation = 0.0;     // N, of eq. (2)
};
Predicted predicted(const scenario::Family& family, const record::CaseRecord& record) {
  const auto most =
      std::ranges::max_element(record.contact, {}, &record::ContactRow::contact_force);
  if (most == record.contact.end()) return {};
  const double modulus = unit::kPa.to_si(finding_number(record, "effective_modulus_kPa"));
  const double curvature = std::isfinite(most->tissue_radius) ? 1.0 / most->tissue_radius : 0.0;
  const double radius =
      1.0 / (1.0 / scenario::case_named(family, record.name).scenario.finger.radius + curvature);
  const double depth = most->indentation;
  // F = 4/3 E* sqrt(R) h^(3/2)                                              Chen 2007 eq. (2)
  return {depth, most->contact_force,
          4.0 / 3.0 * modulus * std::sqrt(radius) * depth * std::sqrt(depth)};
}

void add_forces(Rows& rows, const scenario::Family& family, const Records& records) {
  for (const record::CaseRecord& record : records) {
    const Predicted one = predicted(family, record);
    if (!(one.equation > 0.0)) continue;
    const double off = one.force / one.equation - 1.0;
    constexpr double rounding = 1e-3;  // a thousandth is less than the digits of Table 1
    rows.add("Eq. (2) with Table 1, " + record.name + " at " +
                 rounded_text(unit::mm.from_si(one.indentation), 3) +
                 " mm: " + rounded_text(one.equation, 4) + " N",
             rounded_text(one.force, 4) + " N", agrees(std::abs(off) < rounding),
             std::abs(off) < rounding
                 ? "the run computes eq. (2)"
                 : "another law than eq. (2) ran here: " + finding_word(record, "model"));
  }
}

void add_order(Rows& rows, const Records& records) {
  std::vector<std::pair<double, std::string>> forces;
  for (const record::CaseRecord& record : records)
    for (const char* tissue : {"skin", "ligament", "muscle", "upper_leg"})
      if (record.name == tissue)
        forces.emplace_back(finding_number(record, "peak_force_N"), tissue);
  if (forces.size() < 4) return;
  std::sort(forces.rbegin(), forces.rend());
  std::string order;
  for (const auto& [force, tissue] : forces) order += (order.empty() ? "" : " > ") + tissue;
  const std::string wanted = "skin > ligament > muscle > upper_leg";
  rows.add("Order of the forces: " + wanted, order, agrees(order == wanted),
           "the order of the moduli of Table 1");
}

std::string range(double low, double high, int digits) {
  const std::string from = rounded_text(low, digits), to = rounded_text(high, digits);
  return from == to ? from : from + " to " + to;
}

void add_fit(Rows& rows, const std::vector<fit::NamedFit>& fits) {
  double least = INFINITY, most = -INFINITY, power_low = INFINITY, power_high = -INFINITY;
  for (const fit::NamedFit& named : fits) {
    if (named.curve != "force_indentation") continue;
    if (named.fit.model == fit::Model::logarithmic) {
      least = std::min(least, named.fit.r2);
      most = std::max(most, named.fit.r2);
    }
    if (named.fit.model == fit::Model::power) {
      power_low = std::min(power_low, named.fit.parameters.at(1).estimate);
      power_high = std::max(power_high, named.fit.parameters.at(1).estimate);
    }
  }
  if (!std::isfinite(least) || !std::isfinite(power_low)) return;
  rows.add("The curves are drawn as F = a + b ln h", "R² of " + range(least, most, 3),
           agrees(false),
           "eq. (2) gives a convex h^(3/2); a logarithm is concave and starts below zero");
  rows.add("Eq. (2): the exponent of h is 1.5", range(power_low, power_high, 5),
           agrees(std::abs(power_low - 1.5) < 5e-3 && std::abs(power_high - 1.5) < 5e-3),
           "the power law fitted to the rows");
}

// F / F_flat = (1 + R_1 kappa)^(-1/2)                     eq. (2) with 1/R = 1/R_1 + kappa
void add_curvatures(Rows& rows, const scenario::Family& family, const Records& records) {
  double worst = 0.0;
  std::size_t count = 0;
  for (const record::CaseRecord& flat : records) {
    if (finding_number(flat, "local_curvature_per_m") != 0.0) continue;
    for (const record::CaseRecord& bent : records) {
      const double curvature = finding_number(bent, "local_curvature_per_m");
      const std::string material = scenario::case_named(family, flat.name).scenario.tissue.material;
      if (scenario::case_named(family, bent.name).scenario.tissue.material != material ||
          curvature == 0.0)
        continue;
      const double ratio =
          finding_number(bent, "peak_force_N") / finding_number(flat, "peak_force_N");
      const double radius = scenario::case_named(family, bent.name).scenario.finger.radius;
      worst = std::max(worst, std::abs(ratio * std::sqrt(1.0 + radius * curvature) - 1.0));
      ++count;
    }
  }
  if (count == 0) return;
  constexpr double rounding = 1e-3;
  rows.add("Eq. (2): the force over that on a flat is (1 + R κ)^(-1/2)",
           "at most " + percent_text(worst) + " off in " + std::to_string(count) + " cases",
           agrees(worst < rounding), "the same depth on every curvature");
}

void add_strains(Rows& rows, const scenario::Family& family, const Records& records) {
  std::string half_times;
  for (const record::CaseRecord& record : records) {
    const scenario::Case& one = scenario::case_named(family, record.name);
    const double modulus = one.materials.tissue.young_modulus.value;
    for (const scenario::Step& step : one.scenario.steps) {
      const auto* creep = std::get_if<scenario::Creep>(&step);
      if (creep == nullptr) continue;
      const double strain = creep->stress / modulus;
      const double here = finding_number(record, "elastic_strain");
      constexpr double rounding = 1e-3;
      rows.add("Table 1, " + record.name +
                   ": the strain goes to stress / E = " + rounded_text(strain, 4),
               rounded_text(here, 4), agrees(std::abs(here / strain - 1.0) < rounding),
               "the springs are scaled to the tissue's modulus");
      half_times += (half_times.empty() ? "half of the final strain of " : ", of ") + record.name +
                    " after " + rounded_text(finding_number(record, "creep_half_time_s"), 3) + " s";
      const double limit = finding_number(record, "stable_time_step_ms");
      if (std::isfinite(limit))
        rows.add("A time step of " +
                     rounded_text(unit::ms.from_si(family.base.output.interval), 3) + " ms",
                 "stable up to " + rounded_text(limit, 3) +
                     " ms; the interval of the rows is the paper's",
                 agrees(limit >= unit::ms.from_si(family.base.output.interval)),
                 "a wave would cross many cells within the paper's step");
      break;
    }
  }
  if (!half_times.empty())
    rows.add("Stiffer tissues settle later", half_times, agrees(false),
             "a dashpot along every spring settles with eta / E, sooner where E is larger; the "
             "paper's curves show oscillation, or viscosities that it does not list");
  rows.add("The right half is called relaxation", "it is recovery: strain after unloading",
           agrees(false), "relaxation is the stress at a constant strain");
}

// One row per statement of the paper's text about its Figure 6 or 7 (`output.paper` says which):
// the statement, the value of this run, whether they agree, and why they cannot where they do not.
// The paper's figures have no numbers that could be read. Empty without `output.paper`.
page::Markup paper_section(const scenario::Family& family, const Records& records,
                           const std::vector<fit::NamedFit>& fits) {
  using Paper = scenario::Output::Paper;
  Rows rows;
  if (family.base.output.paper == Paper::figure_6) {
    add_order(rows, records);
    add_curvatures(rows, family, records);
    constexpr std::size_t most_forces = 8;
    if (records.size() <= most_forces) add_forces(rows, family, records);
    add_fit(rows, fits);
  } else if (family.base.output.paper == Paper::figure_7) {
    add_strains(rows, family, records);
  }
  if (rows.table.rows.empty()) return {};
  rows.add("Numbers along the curves: none are printed", "in the CSV files", page::verdicts[2],
           "what can be compared are the statements and equations of the text");
  return element("div", page::table("The paper beside this run", rows.table), {{"class", "whole"}});
}

using page::text;

constexpr std::size_t most_columns = 6;  // cases of a table with one column per case
constexpr std::size_t most_rows = 200;
constexpr std::size_t most_answers = 8;  // cases of the table below the figures

std::string figure_words(const plot::Figure& figure) {
  std::string words = figure.y_label + " against " + within_sentence(figure.x_label);
  if (figure.series.size() > 1) words += ", " + std::to_string(figure.series.size()) + " curves";
  if (figure.bar) words += "; the colour is " + within_sentence(figure.bar->label);
  if (figure.y_axis == plot::Axis::logarithmic)
    words +=
        figure.x_axis == plot::Axis::logarithmic ? "; logarithmic scales" : "; logarithmic scale";
  return words + ".";
}

// One row per finding that is known, one column per case.
Markup findings_by_case(const Records& records) {
  Markup all;
  const bool frictionless = std::ranges::all_of(
      records, [](const auto& record) { return finding_number(record, "peak_friction_N") == 0.0; });
  const std::size_t of_peak = words_of_finding("peak_force_N").group;
  for (std::size_t group = 0; group < finding_groups().size(); ++group) {
    record::Table table{{"quantity"}, {}};
    std::vector<std::string> names;
    for (const record::CaseRecord& record : records) {
      table.columns.push_back(record.name);
      for (const record::Finding& finding : record.findings)
        if (words_of_finding(finding.name).group == group &&
            std::ranges::find(names, finding.name) == names.end())
          names.push_back(finding.name);
    }
    for (const std::string& name : names) {
      if (frictionless && name.find("friction") != std::string::npos) continue;
      std::vector<record::Cell> row{words_of_finding(name).label};
      for (const record::CaseRecord& record : records) {
        const auto found = std::ranges::find(record.findings, name, &record::Finding::name);
        const bool known =
            found != record.findings.end() && !std::holds_alternative<std::monostate>(found->value);
        const int digits = group == of_peak ? warranted_digits(record.answer) : 4;
        row.push_back(known ? record::Cell(finding_text(*found, digits)) : record::Cell());
      }
      const bool empty = std::all_of(row.begin() + 1, row.end(), [](const record::Cell& cell) {
        return std::holds_alternative<std::monostate>(cell);
      });
      if (!empty) table.rows.push_back(row);
    }
    if (table.rows.empty()) continue;
    const FindingGroup& words = finding_groups()[group];
    all += element("h3", words.heading) + page::table(std::string(words.sentence), table);
  }
  return all + element("p", text("The names and all digits are in ") +
                                page::link("findings.csv", "findings.csv") + text("."));
}

Markup fits(const std::vector<fit::NamedFit>& fits) {
  record::Table table{{"case", "curve", "formula", "parameter", "estimate", "95 % interval", "R²"},
                      {}};
  for (const fit::NamedFit& named : fits)
    for (const fit::Estimate& one : named.fit.parameters) {
      const auto number = [&](double value) {
        return warranted_text(value, one.ci95_low, one.ci95_high);
      };
      const std::string unit = one.unit.empty() ? "" : " " + one.unit;
      table.rows.push_back(
          {named.case_name, named.curve, std::string(fit::info(named.fit.model).formula), one.name,
           number(one.estimate) + unit,
           std::isfinite(one.ci95_low) ? number(one.ci95_low) + " to " + number(one.ci95_high)
                                       : std::string("unknown"),
           rounded_text(named.fit.r2)});
    }
  if (table.rows.empty()) return {};
  constexpr std::size_t most = 60;
  return element("p",
                 "Curves fitted to the computed rows. The interval takes correlated residuals into "
                 "account and holds if the law is right; an R² below 0.99 says that it is wrong.") +
         page::table_of_file("Fits", table, "fits.csv", most);
}

Markup warnings(const Records& records) {
  Markup items;
  for (const record::CaseRecord& record : records)
    for (const std::string& warning : record.warnings)
      items += element(
          "li", page::sentence((records.size() > 1 ? record.name + ": " : "") + warning + "."));
  return items.empty() ? items : element("ul", items);
}

// A map without contact, as after a retraction, is told and not shown.
Markup maps(const Records& records) {
  constexpr std::size_t most = 12;
  Markup pictures;
  std::size_t count = 0;
  std::vector<std::string> released;
  for (const record::CaseRecord& record : records)
    for (const record::PressureMap& map : record.maps) {
      const std::string name = records.size() > 1 ? record.name : "";
      if (!(map.contact_force > 0.0))
        released.push_back((name.empty() ? "step " : name + ", step ") + std::to_string(map.step));
      else if (count++ < most)
        pictures += map_picture(map, name);
    }
  Markup all;
  if (count > 0)
    all = element("p",
                  "Pressure of the finger on the tissue at the end of each step, seen from above; "
                  "without colour: no contact.") +
          element("div", pictures, {{"class", "maps"}});
  if (!released.empty())
    all += page::paragraphs(
        {"without contact at its end, and so without a picture: " + joined(released, "; ")});
  if (count > most)
    all += element("p", "The first " + std::to_string(most) + " of " + std::to_string(count) +
                            " maps; all of them are in the files pressure_NNN.exr.");
  return all;
}

Markup asked(const scenario::Family& family, const std::string& echo) {
  return page::folded("The scenario as written", family.inputs.front().content) +
         page::folded("The scenario with all defaults and choices, scenario.toml", echo);
}

// The end of a sentence's first statement: before a remedy or a further sentence.
std::string first_statement(const std::string& text) {
  return text.substr(0, std::min(text.find("; "), text.find(". ")));
}

// The largest effect that is neglected, with its remedy, and the others by name and size:
// `viscosity, which would add 36 % to the force while pressing; add ... (also the size of the body,
// 15 %; large strains, 1.8 %)`.
std::string neglected(const record::Answer& answer) {
  const auto& effects = answer.effects;
  std::string text = effects.empty() ? answer.neglected : effects.front().sentence();
  if (effects.empty()) text.erase(0, text.find(": ") + 2);
  if (text.ends_with('.')) text.pop_back();
  std::vector<std::string> also;
  for (std::size_t i = 1; i < effects.size(); ++i)
    also.push_back(effects[i].what +
                   (effects[i].change ? ", " + percent_text(std::abs(*effects[i].change)) : ""));
  return also.empty() ? text : text + " (also " + joined(also, "; ") + ")";
}

// `1.17 N`
std::string peak_text(const record::CaseRecord& record) {
  const auto peak = record::peak_of(record);
  return peak ? rounded_text(peak->value, warranted_digits(record.answer)) + peak->unit
              : "no result";
}

// `diverged at 0.0574 s`
std::string divergence(const record::CaseRecord& record) {
  return "diverged at " + rounded_text(record.last_stable_time, 3) + " s";
}

std::string peak_error(const record::CaseRecord& record) {
  const std::optional<double>& error = record.answer.stated_error;
  if (record.unstable) return divergence(record);
  if (record.outcome != record::Outcome::completed) return record::reached_text(record);
  if (!error) return "error not known";
  return (*error > 1.0 ? error_text(*error) + " off" : "± " + percent_text(*error)) +
         record::uncounted_text(record.answer);
}

// Why a case ended early, as a sentence.
std::string early_end(const record::CaseRecord& record) {
  return record.reason + (record.last_stable_time > 0.0
                              ? "; last stable time " + rounded_text(record.last_stable_time) + " s"
                              : "");
}

// The verdict of a live run in two: whether measured and model agree, by how much, and what causes
// it; and the other numbers. Empty without a verdict.
std::vector<std::string> verdict_sentences(const std::string& verdict) {
  if (verdict.empty()) return {};
  const std::string allowed = " allowed)";
  std::size_t numbers = verdict.find(allowed);
  if (numbers == std::string::npos) return {verdict};
  numbers += allowed.size();
  const std::size_t causes = std::min(verdict.find("; ", numbers), verdict.size());
  std::vector<std::string> all{verdict.substr(0, numbers) + verdict.substr(causes)};
  if (causes > numbers + 2) all.push_back(verdict.substr(numbers + 2, causes - numbers - 2));
  return all;
}

// ` at x 30, y 30, z 30 mm`: where the finger touches the surface first, in the scenario's
// coordinates; nothing without a picture and on a half-space, which is the same everywhere.
std::string place_text(const scenario::Case& one, const record::ScenePicture& picture) {
  if (picture.finger.empty() ||
      std::holds_alternative<scenario::HalfSpace>(one.scenario.tissue.shape))
    return "";
  const Vec3 place = picture.axes.transpose() * picture.touch;
  const auto mm = [](double metres) {  // to a hundredth
    return number_text(std::round(100.0 * unit::mm.from_si(metres)) / 100.0 + 0.0);
  };
  return " at x " + mm(place.x()) + ", y " + mm(place.y()) + ", z " + mm(place.z()) + " mm";
}

// The viscous law of a case between plates, for the model that ran.
std::string viscosity_of(const scenario::Case& one, const record::CaseRecord& record) {
  const std::string model = finding_word(record, "model");
  for (const scenario::ModelTraits& traits : scenario::model_table)
    if (traits.word == model)
      return scenario::viscosity_text(scenario::resolve(one, traits.of).tissue);
  return "";
}

// What was tested, where, and with what: `Tissue: skin, E 72.4 kPa, nu 0.33; block of
// 60 x 60 x 30 mm; pressed 2 mm by a sphere of radius 11 mm at x 30, y 30, z 30 mm; underside fixed
// (bonded base).`
std::string tested(const scenario::Case& one, const record::CaseRecord& record) {
  const double depth = finding_number(record, "peak_travel_mm");
  std::vector<std::string> all =
      scenario::tested(one, {},
                       {.depth = std::isfinite(depth) ? rounded_text(depth, 3) + " mm" : "",
                        .place = place_text(one, record.picture)});
  const std::string& side = one.scenario.tissue.base_side;
  if (!record.picture.base.empty())
    all.push_back((side.empty() ? "underside " : "side " + side + " ") + record.picture.base);
  return joined(all, "; ") + ".";
}

record::Table case_table(const scenario::Family& family, const Records& records) {
  const auto peak = record::peak_of(records.front());
  const bool uniform = family.base.uniform();
  record::Table table{{"case", peak ? "peak " + peak->of : "peak", "error", "model", "neglected"},
                      {}};
  if (uniform) table.columns.insert(table.columns.end() - 1, "viscosity");
  for (const record::CaseRecord& record : records) {
    table.rows.push_back({record.name, peak_text(record), peak_error(record),
                          finding_word(record, "model"),
                          first_statement(neglected(record.answer))});
    if (uniform)
      table.rows.back().insert(table.rows.back().end() - 1,
                               viscosity_of(scenario::case_named(family, record.name), record));
  }
  return table;
}

// `Cases differ in region 1 Young's modulus: 20 kPa, 1000 kPa`; nothing without a sweep.
std::string differing_text(const scenario::Family& family) {
  constexpr std::size_t most = 4;
  std::vector<std::string> all;
  for (std::size_t k = 0; k < family.design.keys().size(); ++k) {
    std::vector<std::string> values;
    for (const scenario::Case& one : family.cases)
      if (const std::string& value = one.swept[k].second;
          std::ranges::find(values, value) == values.end())
        values.push_back(value);
    all.push_back(within_sentence(plot::key_label(family.design.keys()[k])) +
                  (values.size() > most ? " (" + std::to_string(values.size()) + " values)"
                                        : ": " + joined(values, ", ")));
  }
  return all.empty() ? "" : "Cases differ in " + joined(all, "; ");
}

// What several cases have in common, and in what they differ.
std::vector<std::string> in_common(const scenario::Family& family, const Records& records) {
  const std::vector<std::string>& keys = family.design.keys();
  const bool one_place = std::ranges::none_of(
      keys, [](const std::string& key) { return key.starts_with("tissue.shape"); });
  const scenario::Case& first = family.cases.front();
  return {joined(scenario::tested(
                     first, keys,
                     {.place = one_place ? place_text(first, records.front().picture) : ""}),
                 "; "),
          differing_text(family)};
}

// The force, its error, the model, and what is neglected: of one case, or of several together.
void add_answer(page::Page& page, const scenario::Family& family, const Records& records) {
  if (records.size() == 1) {
    const record::CaseRecord& record = records.front();
    const record::Answer& answer = record.answer;
    if (answer.neglected.empty()) {  // a gauge was read, and no model ran
      std::string force = answer.error.substr(0, answer.error.rfind('.'));
      std::erase(force, ':');
      page.headline(force, "");
      return page.answer({answer.model});
    }
    const auto peak = record::peak_of(record);
    const std::vector<std::string> verdict = verdict_sentences(answer.verdict);
    if (record.unstable)
      page.headline(capitalized(divergence(record)), first_statement(record.reason),
                    page::Page::Tone::failure);
    else
      page.headline(peak ? "Peak " + peak->of + " " + peak_text(record) : "No result",
                    peak_error(record) + (verdict.empty() ? "" : " (model)"),
                    peak ? page::Page::Tone::result : page::Page::Tone::failure);
    const std::size_t cause = first_statement(record.reason).size();
    if (record.unstable && cause < record.reason.size())  // the cause and the time are above
      page.answer({record.reason.substr(cause + 2)});
    else if (!record.unstable && !record.reason.empty())
      page.answer({early_end(record)});
    if (!verdict.empty()) page.answer({verdict.front()});
    const scenario::Case& one = scenario::case_named(family, record.name);
    page.answer({tested(one, record)});
    if (family.base.uniform()) page.answer({"Viscosity: " + viscosity_of(one, record)});
    page.answer({first_statement(answer.model), "Neglected: " + neglected(answer)});
  } else if (!records.empty()) {
    std::vector<std::string> lines = answer_lines(records);
    std::erase(lines[1], '`');
    const std::size_t error = std::min(lines[1].find(", with"), lines[1].size());
    const bool none = std::ranges::all_of(records, &record::CaseRecord::unstable);
    page.headline(lines[1].substr(0, error), lines[1].substr(std::min(error + 2, lines[1].size())),
                  none ? page::Page::Tone::failure : page::Page::Tone::result);
    std::vector<NamedSentence> ends;
    for (const record::CaseRecord& record : records)
      if (!record.reason.empty()) ends.push_back({record.name, early_end(record)});
    page.answer(said_once(ends));
    page.answer(in_common(family, records));
    page.answer({first_statement(lines[0]), first_statement(lines[2])});
  }
}

// A single case is named after its file.
std::string repeating(const scenario::Family& family) {
  const std::string file = shown_word(family.name + ".toml");
  if (family.cases.size() > 1 || file == "scenario.toml") return "palpate run scenario.toml";
  return "cp scenario.toml " + file + "\npalpate run " + file;
}

}  // namespace

void write_run_page(const RunShown& shown, WholeFolder& folder) {
  const scenario::Family& family = shown.family;
  const Records& records = shown.records;
  page::Page page(family.title, "run");
  add_answer(page, family, records);
  const std::vector<Markup> figures = page::all_figures(folder, [&](const std::string& name) {
    const auto figure = std::ranges::find(shown.figures, name, &plot::Figure::name);
    return figure == shown.figures.end() ? "" : figure_words(*figure);
  });
  page.figures(figures);
  if (records.size() > 1 && records.size() <= most_answers)  // the first screen is for the curves
    page.section("Every case", element("div",
                                       page::table("Result, error, model and what is neglected",
                                                   case_table(family, records)),
                                       {{"class", "whole"}}));
  if (!records.empty() && !records.front().picture.faces.empty()) {
    const Markup scene = scene_view(records.front().picture, family.title);
    figures.empty() ? page.beside(scene) : page.section("Scene", scene);
    page.script(scene_script());
  }
  page.section("Beside the paper", paper_section(family, records, shown.fits));
  for (const record::CaseRecord& record : records)
    if (const auto verdict = verdict_sentences(record.answer.verdict); verdict.size() > 1)
      page.section("Beside the device", page::paragraphs({verdict.back()}));
  constexpr auto folded = page::Page::Shown::folded;
  if (records.size() != 1 || !records.front().answer.neglected.empty())
    page.section("Model, error and what is neglected", page::paragraphs(answer_lines(records)),
                 folded);
  page.section("Warnings", warnings(records), folded);
  page.section("Derived quantities",
               records.size() <= most_columns
                   ? findings_by_case(records)
                   : page::table_of_file("Every case", case_table(family, records), "findings.csv",
                                         most_rows),
               folded);
  page.section("Fits", fits(shown.fits), folded);
  page.section("Pressure maps", maps(records), folded);
  page.section("Scenario", asked(family, read_text(folder.file("scenario.toml"))), folded);
  const std::vector<HashedFile> inputs = scenario::hashed(family.inputs);
  const bool live =
      std::ranges::any_of(records, [](const auto& record) { return !record.attached.empty(); });
  page.section(
      "How it was made",
      page::making({.command = repeating(family),
                    .note = live ? "A live run follows its device, so that this command repeats "
                                   "the loading history and not the motion of the device."
                                 : "How long it took stands in run.json."},
                   inputs),
      folded);
  page::write(std::move(page), folder);
}

}  // namespace palpate::report
