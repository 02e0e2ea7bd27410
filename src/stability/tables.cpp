// The map as tables, sentences and a figure, and the result folder.

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "base/text.h"
#include "base/units.h"
#include "page/page.h"
#include "plot/gnuplot_text.h"
#include "record/csv.h"
#include "scenario/words.h"
#include "stability/measure.h"
#include "stability/stability.h"

namespace palpate::stability {
namespace {

using record::Cell;
using record::known;

Cell microseconds(const std::optional<double>& seconds) {
  return seconds ? Cell(1e6 * *seconds) : Cell();
}

}  // namespace

record::Table limit_table(const StabilityMap& map) {
  record::Table table;
  table.columns = {"model",    "volume",    "integrator", "damping", "axis", "value",
                   "limit_us", "theory_us", "ratio",      "failure", "note"};
  for (const LimitRow& row : map.limits) {
    Cell ratio;
    if (row.measured && row.theory && *row.theory > 0.0) ratio = *row.measured / *row.theory;
    table.rows.push_back({row.model, row.volume, row.integrator, row.damping, row.axis,
                          known(row.value), microseconds(row.measured), microseconds(row.theory),
                          ratio, failure_word(row.failure), known(row.note)});
  }
  return table;
}

record::Table failure_table(const StabilityMap& map) {
  record::Table table;
  table.columns = {"failure", "model",    "integrator", "setting", "setting_unit",
                   "measure", "measured", "theory",     "seen",    "note"};
  for (const FailureRow& row : map.failures)
    table.rows.push_back({failure_word(row.failure), known(row.model), known(row.integrator),
                          known(row.setting), known(row.setting_unit), row.measure,
                          known(row.measured), known(row.theory),
                          row.reached ? "yes" : "not reached", known(row.note)});
  return table;
}

std::vector<std::string> write_map(const StabilityMap& map, const std::string& title,
                                   WholeFolder& folder) {
  std::vector<std::string> warnings;
  folder.open();
  folder.write("stability.csv", record::csv_text(limit_table(map)));
  folder.write("failures.csv", record::csv_text(failure_table(map)));
  plot::draw(stability_sheet(title, map), folder, warnings);
  page::Page page("Stability of " + title, "stability map");
  // The limit and the step that is taken; the rest is for a second look.
  std::vector<std::string> more = map.sentences;
  if (!more.empty()) {
    if (map.longest_step)
      page.headline(rounded_text(1e6 * *map.longest_step, 4) + " µs",
                    "longest safe step of central differences");
    page.answer({more.front(), map.tested});
    more.erase(more.begin());
  }
  page.figures(page::all_figures(folder, [](const std::string&) {
    return "Longest stable time step over the model, each quantity of the scenario, and which "
           "failures were seen: theory as lines, measurements as points.";
  }));
  constexpr auto folded = page::Page::Shown::folded;
  page.section("In words", page::paragraphs(more), folded);
  constexpr std::size_t most = 60;
  page.section("Limits",
               page::table_of_file(
                   "Limits of the time step, measured and by theory",
                   page::columns_of(limit_table(map), {"integrator", "model", "damping", "axis",
                                                       "value", "limit_us", "theory_us", "ratio"}),
                   "stability.csv", most),
               folded);
  page.section("Failures",
               page::table_of_file(
                   "Kinds of failure and whether they were seen",
                   page::columns_of(failure_table(map), {"failure", "seen", "integrator", "setting",
                                                         "setting_unit", "measured", "theory"}),
                   "failures.csv", most),
               folded);
  page.section("How it was made", page::making({.command = "palpate stability " + title + ".toml"}),
               folded);
  page::write(std::move(page), folder);
  return folder.put(WholeFolder::State::complete, warnings);
}

namespace {

struct Curve {
  const char* column;  // the rows that contain `word` in this column are drawn
  const char* word;
  const char* label;
  const char* colour;
  int marker;
};

constexpr Curve method_curves[] = {
    {"integrator", "lagged_velocity", "lagged_velocity", "D55E00", 5},
    {"integrator", "semi_implicit_euler", "semi_implicit_euler", "009E73", 9},
    {"integrator", "central_difference", "central_difference", "0072B2", 7}};
constexpr Curve volume_curves[] = {{"volume", "tetrahedron", "of every tetrahedron", "D55E00", 5},
                                   {"volume", "nodal", "averaged at nodes", "0072B2", 7}};
constexpr Curve device[] = {{"integrator", "zero_order_hold", "frame time", "CC79A7", 7}};

// Whether the map has points of the curve on this axis; gnuplot warns of curves without points.
bool drawn(const StabilityMap& map, const Curve& curve, const std::string& axis) {
  const bool by_volume = std::string("volume") == curve.column;
  for (const LimitRow& row : map.limits)
    if (row.axis == axis && row.measured && row.theory &&
        (by_volume ? row.volume : row.integrator) == curve.word)
      return true;
  return false;
}

std::string picked(const Curve& curve, const std::string& axis, const char* column) {
  return "(strcol('axis') eq '" + axis + "' && strcol('" + curve.column + "') eq '" + curve.word +
         "' ? column('" + column + "') : NaN)";
}

// Theory as a line, measurements as points. The panel of an axis without rows stays empty.
enum class Legend { none, own };
std::string curves(const StabilityMap& map, std::span<const Curve> all, const std::string& axis,
                   Legend legend = Legend::none) {
  std::vector<std::string> lines;
  const std::string file = "'stability.csv' using ";
  for (const Curve& curve : all) {
    if (!drawn(map, curve, axis)) continue;
    const std::string x = picked(curve, axis, "value");
    const std::string colour = std::string("linecolor rgb '#") + curve.colour + "'";
    lines.push_back(file + x + ":" + picked(curve, axis, "theory_us") +
                    " smooth unique with lines linewidth 1.2 " + colour + " notitle");
    lines.push_back(
        file + x + ":" + picked(curve, axis, "limit_us") +
        " with points pointsize 0.45 pointtype " + std::to_string(curve.marker) + " " + colour +
        (legend == Legend::own ? std::string(" title '") + curve.label + "'" : " notitle"));
  }
  if (lines.empty()) return "set multiplot next\n";
  return "plot \\\n  " + joined(lines, ", \\\n  ") + "\n";
}

// The least and the largest of positive numbers.
struct Range {
  double low = INFINITY, high = 0.0;
  void take(double value) {
    if (!(value > 0.0) || !std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  // With a margin on both sides; from 1 to 10 if there are no numbers.
  [[nodiscard]] Range wide() const {
    if (!(high > 0.0)) return {1.0, 10.0};
    return {low / 1.3, high * 1.3};
  }
};

std::string scaled(const char* axis, const Range& range) {
  const Range wide = range.wide();
  return std::string("set ") + axis + "range [" + rounded_text(wide.low, 4) + ":" +
         rounded_text(wide.high, 4) + "]\n" + plot::gnuplot_logarithmic(axis, wide.low, wide.high);
}

enum class Scale { linear_x, linear_y, logarithmic };

// The frame of a panel. `axis` names the rows whose range it shows.
std::string panel(const StabilityMap& map, const std::string& axis, Scale scale,
                  const std::string& title, const std::string& x_label) {
  Range x, y;
  for (const LimitRow& row : map.limits) {
    if (row.axis != axis || !row.measured || !row.theory) continue;
    y.take(1e6 * *row.measured);
    y.take(1e6 * *row.theory);
    x.take(axis == "model" ? 1e6 * *row.theory : row.value.value_or(0.0));
  }
  std::string text = "\n" + plot::gnuplot_linear("x") + plot::gnuplot_linear("y") +
                     "set xrange [*:*]\nset yrange [*:*]\n";
  if (scale != Scale::linear_x) text += scaled("x", x);
  if (scale != Scale::linear_y) text += scaled("y", y);
  return text + "set title " + plot::gnuplot_quoted(title) + "\nset xlabel " +
         plot::gnuplot_quoted(x_label) + "\n";
}

// Measured over theoretical limits of every model and damping; equal ones lie on the diagonal.
std::string agreement(const StabilityMap& map) {
  std::vector<std::string> lines{"x with lines linewidth 1.2 linecolor rgb '#808080' notitle"};
  for (const Curve& curve : method_curves) {
    if (!drawn(map, curve, "model")) continue;
    lines.push_back("'stability.csv' using " + picked(curve, "model", "theory_us") + ":" +
                    picked(curve, "model", "limit_us") + " with points pointsize 0.45 pointtype " +
                    std::to_string(curve.marker) + " linecolor rgb '#" + curve.colour +
                    "' title '" + curve.label + "'");
  }
  return panel(map, "model", Scale::logarithmic, "Every model and damping", "limit by theory, µs") +
         "set key at screen 0.52, screen 0.975 center top vertical maxrows 1 Left reverse samplen "
         "1 font ',13'\n"
         "plot \\\n  " +
         joined(lines, ", \\\n  ") + "\nunset key\n";
}

std::string strip() {
  std::string text =
      "\n" + plot::gnuplot_linear("x") + plot::gnuplot_linear("y") +
      "set key default top right horizontal Left reverse samplen 1 font ',13'\n"
      "set lmargin at screen 0.075\nset rmargin at screen 0.975\n"
      "set tmargin at screen 0.125\nset bmargin at screen 0.06\n"
      "set title 'Kinds of failure: one mark per setting that was tried'\n"
      "unset xlabel\nunset ylabel\nunset ytics\nset xrange [-0.5:6.5]\nset yrange [0:1]\n"
      "set xtics (";
  std::vector<std::string> names;
  std::string index = "NaN";
  for (int i = 1; i <= 7; ++i) {
    const std::string word = failure_word(static_cast<Failure>(i));
    // On two lines in turn, because neighbours would overlap.
    names.push_back("\"" + std::string(i % 2 == 0 ? "\\n" : "") + word + "\" " +
                    std::to_string(i - 1));
    index = "word eq '" + word + "' ? " + std::to_string(i - 1) + " : " + index;
  }
  // Marks of one kind are drawn side by side, shifted by their number within the kind.
  text += joined(names, ", ") + ")\nplace(word) = " + index +
          "\nlast = ''\ncount = 0\n"
          "next(word) = (count = word eq last ? count + 1 : 0, last = word, place(word) - 0.3 + "
          "0.12 * count)\n"
          "plot \\\n"
          "  'failures.csv' using (next(strcol('failure'))):(strcol('seen') eq 'yes' ? 0.45 : NaN) "
          "with points pointtype 9 pointsize 0.8 linecolor rgb '#D55E00' title 'it fails', \\\n"
          "  'failures.csv' using (next(strcol('failure'))):(strcol('seen') eq 'yes' ? NaN : 0.45) "
          "with points pointtype 6 pointsize 0.7 linecolor rgb '#009E73' title 'it does not'\n";
  return text;
}

}  // namespace

plot::Sheet stability_sheet(const std::string& title, const StabilityMap& map) {
  std::string text = plot::gnuplot_head("stability", {.height = 1560, .tick_font = 13});
  text +=
      "set datafile missing NaN\nset xtics offset 0,0.3\nset ytics offset 0.5,0\n"
      "set title offset 0,-0.6 font ',13'\nset xlabel offset 0,0.9 font ',13'\nunset key\n"
      "set multiplot layout 5,2 margins screen 0.11,0.975,0.19,0.93 spacing screen 0.13,0.064 "
      "title " +
      plot::gnuplot_quoted("Limit of the time step (µs), " + title +
                           ": theory as lines, measurements as points") +
      " font ',14'\n";
  text += agreement(map);
  const auto of_methods = [&](const char* axis, Scale scale, const char* heading,
                              const char* x_label) {
    text += panel(map, axis, scale, heading, x_label) + curves(map, method_curves, axis);
  };
  of_methods("young_modulus_Pa", Scale::logarithmic, "Young's modulus", "modulus, Pa");
  text += panel(map, "poisson_ratio", Scale::linear_x, "Volume term of coupled springs",
                "Poisson's ratio") +
          "set key default bottom left Left reverse samplen 1 spacing 1.1 font ',13'\nset xrange "
          "[0:0.52]\n"
          "set xtics 0.1\n" +
          curves(map, volume_curves, "poisson_ratio", Legend::own) +
          "unset key\nset xrange [*:*]\n";
  of_methods("shortest_edge_mm", Scale::logarithmic, "Element size", "shortest edge, mm");
  of_methods("damping_per_s", Scale::logarithmic, "Damping of nodes", "damping, 1/s");
  of_methods("retardation_time_s", Scale::logarithmic, "Dashpots along springs",
             "retardation time, s");
  of_methods("relaxation_time_s", Scale::linear_y, "Standard linear solid", "relaxation time, s");
  of_methods("contact_stiffness_N_per_m", Scale::logarithmic, "Explicit contact",
             "contact stiffness, N/m");
  text += panel(map, "device_damping_N_s_per_m", Scale::logarithmic, "Haptic frame",
                "device damping, N s/m") +
          "set rmargin at screen 0.975\n" +  // the last panel, below two
          curves(map, device, "device_damping_N_s_per_m");
  text += strip() + "\nunset multiplot\n";
  return {.name = "stability", .script = text, .reads = {"stability.csv", "failures.csv"}};
}

namespace {

std::string micro(double seconds) { return rounded_text(1e6 * seconds, 4) + " µs"; }

// That of central differences without damping, of the scenario's own model; null if there is none.
const LimitRow* free_limit(const Survey& survey) {
  const std::string model = scenario::traits(survey.given.model).word;
  const std::string volume = scenario::words::word(scenario::words::volumes, survey.given.volume);
  const auto row = std::ranges::find_if(survey.map.limits, [&](const LimitRow& one) {
    return one.axis == "model" && one.integrator == "central_difference" && one.damping == "none" &&
           one.model == model && one.volume == volume;
  });
  return row != survey.map.limits.end() ? &*row : nullptr;
}

std::string limits_sentence(const Survey& survey) {
  const scene::TimePlan& plan = survey.own->scene.specimen->plan;
  const LimitRow* free = free_limit(survey);
  std::string text = std::string(scenario::traits(survey.given.model).word) + " with volume `" +
                     scenario::words::word(scenario::words::volumes, survey.given.volume) + "`, " +
                     std::to_string(survey.own->nodes()) + " nodes: ";
  if (free == nullptr || !free->measured || !free->theory) return text + "no limit was measured.";
  return text + "central differences are stable below " + micro(*free->measured) +
         " (2 / omega_max is " + micro(*free->theory) + "); by default " +
         std::to_string(plan.substeps) + (plan.substeps == 1 ? " step of " : " steps of ") +
         micro(plan.substep) + (plan.substeps == 1 ? " is" : " are") + " taken every " +
         rounded_text(1e3 * plan.time_step) + " ms.";
}

std::string agreement_sentence(const Survey& survey) {
  int count = 0;
  double worst = 0.0;
  int unlimited = 0;
  for (const LimitRow& row : survey.map.limits) {
    if (row.model == "device") continue;
    if (!row.theory) {
      if (!row.measured) ++unlimited;
      continue;
    }
    if (!row.measured) continue;
    ++count;
    worst = std::max(worst, std::abs(*row.measured / *row.theory - 1.0));
  }
  return std::to_string(count) + " measured limits lie within " + percent_text(worst) +
         " of theory; " + std::to_string(unlimited) +
         " trials of methods without a limit were stable at 1000 times 2 / omega_max.";
}

std::string first_to_fail(const Survey& survey) {
  const LimitRow* shortest = nullptr;
  const std::string model = scenario::traits(survey.given.model).word;
  for (const LimitRow& row : survey.map.limits)
    if (row.axis == "model" && row.model == model && row.measured && row.theory &&
        (shortest == nullptr || *row.measured < *shortest->measured))
      shortest = &row;
  if (shortest == nullptr) return {};
  return "First to fail as the step grows: `" + shortest->integrator + "` with `" +
         shortest->damping + "` (volume `" + shortest->volume + "`), at " +
         micro(*shortest->measured) + ".";
}

// The number of explicit steps that the stiffest tissue requires.
std::string stiffest_sentence(const Survey& survey) {
  const LimitRow* stiffest = nullptr;
  for (const LimitRow& row : survey.map.limits)
    if (row.axis == "young_modulus_Pa" && row.measured) stiffest = &row;
  if (stiffest == nullptr) return {};
  const double steps = std::ceil(1e-3 / (0.9 * *stiffest->measured));
  return "At " + pressure_text(*stiffest->value) + " an explicit method takes " +
         rounded_text(steps) +
         " steps per millisecond; an implicit one takes as many as its accuracy requires.";
}

// The change of the limit from the first to the last row of an axis.
std::string axis_sentence(const Survey& survey, const std::string& axis, const std::string& name,
                          const std::function<std::string(double)>& text) {
  const LimitRow* low = nullptr;
  const LimitRow* high = nullptr;
  for (const LimitRow& row : survey.map.limits) {
    if (row.axis != axis || row.integrator != "central_difference" || !row.measured) continue;
    if (low == nullptr) low = &row;
    high = &row;
  }
  if (low == nullptr || high == low) return {};
  return name + " from " + text(*low->value) + " to " + text(*high->value) +
         " changes the limit from " + micro(*low->measured) + " to " + micro(*high->measured) + ".";
}

std::string device_sentence(const Survey& survey) {
  const auto spring = contact_spring(*survey.own);
  if (!spring) return {};
  return "On a haptic device: the stiffness of the contact at the largest displacement, " +
         rounded_text(spring->stiffness) + " N/m, requires a device damping of " +
         rounded_text(contact::needed_damping(spring->stiffness, {})) +
         " N s/m at frames of 1 ms (K T / 2).";
}

std::string failures_sentence(const Survey& survey) {
  std::vector<std::string> seen;
  std::vector<std::string> not_seen;
  for (const FailureRow& row : survey.map.failures) {
    auto& list = row.reached ? seen : not_seen;
    if (std::ranges::find(list, failure_word(row.failure)) == list.end())
      list.emplace_back(failure_word(row.failure));
  }
  std::erase_if(not_seen, [&](const std::string& word) {
    return std::ranges::find(seen, word) != seen.end();
  });
  std::string text = "Failures shown: " + joined(seen, ", ") + ".";
  if (!not_seen.empty()) text += " Not reached here: " + joined(not_seen, ", ") + ".";
  return text;
}

}  // namespace

std::optional<double> longest_step(const Survey& survey) {
  const LimitRow* free = free_limit(survey);
  return free == nullptr ? std::nullopt : free->measured;
}

std::vector<std::string> map_sentences(const Survey& survey) {
  std::vector<std::string> all{
      limits_sentence(survey),
      agreement_sentence(survey),
      first_to_fail(survey),
      axis_sentence(survey, "young_modulus_Pa", "Young's modulus", pressure_text),
      stiffest_sentence(survey),
      axis_sentence(survey, "contact_stiffness_N_per_m", "An explicit contact's stiffness",
                    [](double value) { return rounded_text(value) + " N/m"; }),
      device_sentence(survey),
      failures_sentence(survey)};
  std::erase_if(all, [](const std::string& text) { return text.empty(); });
  return all;
}

}  // namespace palpate::stability
