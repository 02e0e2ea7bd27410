// The verdict on a chart, its table and its sentences.
#include "chart/table.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "plot/gnuplot_text.h"
#include "scenario/integrators.h"

namespace palpate::chart {
namespace {

bool counts(const Tradeoff& one) {
  return std::isfinite(one.cost) && std::isfinite(one.error) && one.cost > 0.0 && one.error > 0.0;
}

}  // namespace

std::vector<std::size_t> pareto_front(std::span<const Tradeoff> all) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (counts(all[i])) order.push_back(i);
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    return all[a].cost != all[b].cost ? all[a].cost < all[b].cost : all[a].error < all[b].error;
  });
  std::vector<std::size_t> front;
  for (const std::size_t i : order)
    if (front.empty() || all[i].error < all[front.back()].error) front.push_back(i);
  return front;
}

std::optional<std::size_t> knee(std::span<const Tradeoff> front) {
  if (front.size() < 3) return std::nullopt;
  const Tradeoff& first = front.front();
  const Tradeoff& last = front.back();
  const double width = std::log(last.cost / first.cost);
  const double height = std::log(first.error / last.error);
  // Rounding errors of the logarithms: choices on the chord are no knee.
  constexpr double rounding = 1e-9;
  std::optional<std::size_t> best;
  double farthest = rounding;
  for (std::size_t i = 1; i + 1 < front.size(); ++i) {
    // The chord runs from (0, 1) to (1, 0): x + y = 1.
    const double x = std::log(front[i].cost / first.cost) / width;
    const double y = std::log(front[i].error / last.error) / height;
    const double below = 1.0 - x - y;
    if (below <= farthest) continue;
    farthest = below;
    best = i;
  }
  return best;
}

namespace {

using record::Cell;
using record::known;

struct Spread {
  double least, median, most;
};

// For at least one value; the median of an even number of values is the lower middle one.
Spread spread(std::vector<double> values) {
  std::ranges::sort(values);
  return {values.front(), values[(values.size() - 1) / 2], values.back()};
}

double median(const std::vector<double>& values) { return spread(values).median; }

Cell ratio(const std::optional<Deviation>& deviation, double Deviation::*part) {
  return deviation ? Cell((*deviation).*part) : Cell();
}

Cell count(int number) { return number > 0 ? Cell(static_cast<double>(number)) : Cell(); }

Cell rings(const Measurement& one) {
  const auto number = whole_number(one.rings);
  return number ? Cell(*number) : known(one.rings);
}

// Rounded to four digits, the accuracy of the clock.
Cell clocked(double value) { return Cell(*whole_number(rounded_text(value, 4))); }

const std::vector<std::string> columns{"case",
                                       "group",
                                       "configuration",
                                       "model",
                                       "coupling",
                                       "integrator",
                                       "rings",
                                       "time_step_ms",
                                       "substeps",
                                       "nodes",
                                       "tetrahedra",
                                       "status",
                                       "greatest_error",
                                       "end_error",
                                       "rms_error",
                                       "reference",
                                       "reference_error",
                                       "shown_error",
                                       "surface_error",
                                       "surface_reference_error",
                                       "greatest_time_error",
                                       "rms_time_error",
                                       "time_reference_error",
                                       "cost_us_per_ms",
                                       "cost_min_us_per_ms",
                                       "cost_max_us_per_ms",
                                       "setup_s",
                                       "total_s",
                                       "total_min_s",
                                       "total_max_s",
                                       "timings",
                                       "within_tolerance",
                                       "pareto",
                                       "knee",
                                       "auto",
                                       "settings",
                                       "note"};

std::vector<Cell> row_of(const CaseChart& chart, const Verdict& verdict, std::size_t i) {
  const Measurement& one = chart.rows[i];
  const bool measured = one.status == Status::measured && !one.timings.empty();
  std::vector<Cell> row{chart.name,
                        one.variant.group,
                        one.variant.name,
                        known(one.model),
                        known(one.coupling),
                        known(one.integrator),
                        rings(one),
                        one.substep > 0.0 ? Cell(1e3 * one.substep) : Cell(),
                        count(one.substeps),
                        count(one.nodes),
                        count(one.tetrahedra),
                        std::string(status_word(one.status)),
                        ratio(one.error, &Deviation::greatest),
                        ratio(one.error, &Deviation::at_end),
                        ratio(one.error, &Deviation::rms),
                        chart.truth.kind,
                        verdict.floor,
                        verdict.error[i] > 0.0 ? Cell(verdict.error[i]) : Cell(),
                        known(one.surface_error),
                        one.surface_error ? Cell(chart.surface.error) : Cell(),
                        ratio(one.time_error, &Deviation::greatest),
                        ratio(one.time_error, &Deviation::rms),
                        one.time_error ? Cell(one.time_floor) : Cell()};
  if (measured) {
    const Spread cost = spread(one.costs());
    const Spread total = spread(one.totals());
    for (const double number : {cost.median, cost.least, cost.most, median(one.setups()),
                                total.median, total.least, total.most})
      row.push_back(clocked(number));
  } else {
    row.resize(row.size() + 7);
  }
  const auto flag = [&](bool is) { row.emplace_back(is ? 1.0 : 0.0); };
  row.emplace_back(static_cast<double>(one.timings.size()));
  flag(verdict.error[i] > 0.0 && verdict.error[i] <= chart.tolerance);
  flag(std::ranges::find(verdict.front, i) != verdict.front.end());
  flag(verdict.knee == i);
  flag(verdict.taken == i);
  row.push_back(known(joined(one.variant.settings, "; ")));
  row.push_back(known(one.note));
  return row;
}

// Rounded to two digits.
std::string rounded(double value) { return number_text(*whole_number(rounded_text(value, 2))); }

// Makes the sentences of one case.
class Speaker {
 public:
  explicit Speaker(const CaseChart& chart) : chart_(chart), verdict_(judge(chart)) {}

  std::string text() const {
    std::string text = "## " + chart_.name + "\n\nReference: " + chart_.truth.sentence + ".\n\n" +
                       within() + displaced() + "\n\n" + at_knee() + "\n\n" + real_time() +
                       in_time() + front() + "\n" + rest();
    return text;
  }

  [[nodiscard]] ChartSentences sentences() const {
    ChartSentences said{.reference = "Reference: " + chart_.truth.sentence + ".",
                        .result = within() + displaced()};
    if (verdict_.cheapest_within)
      said.settings = "Its settings: " + settings(*verdict_.cheapest_within) + displaced();
    for (const std::string& text : {at_knee(), real_time(), in_time()})
      if (const std::string one = trimmed(text); one.ends_with('.')) said.more.push_back(one);
    return said;
  }

 private:
  static std::string percent(double part) { return rounded(100.0 * part) + " %"; }

  [[nodiscard]] std::string error(std::size_t i) const {
    return (verdict_.error[i] <= verdict_.floor ? "at most " : "") + percent(verdict_.error[i]);
  }
  [[nodiscard]] std::string cost(std::size_t i) const {
    return rounded(verdict_.cost[i]) + " µs per ms";
  }
  [[nodiscard]] std::string named(std::size_t i) const {
    return "`" + name(i) + "` (" + error(i) + ", " + cost(i) + ")";
  }
  [[nodiscard]] std::string name(std::size_t i) const {
    const Measurement& one = chart_.rows[i];
    return one.variant.group == "base" && !one.model.empty() ? one.variant.name + " = " + one.model
                                                             : one.variant.name;
  }
  [[nodiscard]] std::string how(std::size_t i) const {
    return set_line(chart_.rows[i].variant.settings);
  }
  [[nodiscard]] std::string times(std::size_t dear, std::size_t cheap) const {
    return rounded(verdict_.cost[dear] / verdict_.cost[cheap]) + " times";
  }

  [[nodiscard]] std::string within() const {
    const std::string tolerance = percent(chart_.tolerance);
    if (!verdict_.nearest) return "No configuration could be compared with the reference.";
    if (!verdict_.cheapest_within)
      return (verdict_.floor > chart_.tolerance
                  ? "The error of the reference is " + percent(verdict_.floor) +
                        ", so that no configuration can be shown to be within the tolerance of "
                  : "No configuration is within the tolerance of ") +
             tolerance + "; nearest is " + named(*verdict_.nearest) + ": " +
             how(*verdict_.nearest) + ".";
    const std::size_t best = *verdict_.cheapest_within;
    return "Within the tolerance of " + tolerance + ", the cheapest is " + named(best) + ": " +
           settings(best);
  }

  // Those of the cheapest within the tolerance, and what `auto` took.
  [[nodiscard]] std::string settings(std::size_t best) const {
    std::string text = how(best);
    if (!verdict_.taken) return text + "; what `auto` takes was not measured.";
    const std::size_t taken = *verdict_.taken;
    if (taken == best) return text + "; `auto` took it.";
    const Measurement& row = chart_.rows[taken];
    const bool scenario = row.variant.group == "base" && !row.model.empty();
    text += "; `auto` took `" + (scenario ? row.model : name(taken)) + "` (" + error(taken) + ", " +
            cost(taken) + ")";
    if (verdict_.error[taken] > chart_.tolerance) return text + ", which is outside.";
    return text + ", at " + times(taken, best) + " the cost.";
  }

  // The row of a model on the scenario's mesh; null if it has no error of the surface.
  [[nodiscard]] const Measurement* on_own_mesh(scenario::Model model) const {
    const auto row = std::ranges::find_if(chart_.rows, [&](const Measurement& one) {
      return one.variant.group == "model x mesh" && one.variant.name == word_of(model) &&
             one.surface_error;
    });
    return row != chart_.rows.end() ? &*row : nullptr;
  }

  // Where both kinds of springs have the same force, their displaced surfaces tell them apart.
  [[nodiscard]] std::string displaced() const {
    const Measurement* springs = on_own_mesh(scenario::Model::mass_spring);
    const Measurement* coupled = on_own_mesh(scenario::Model::coupled_springs);
    if (springs == nullptr || coupled == nullptr || !springs->error || !coupled->error ||
        std::abs(springs->error->greatest - coupled->error->greatest) > comparison_error)
      return "";
    return " `mass_spring` and `coupled_springs` have the same force, an error of " +
           percent(coupled->error->greatest) +
           "; the displaced surface within four contact radii is off by " +
           percent(*springs->surface_error) + " with `mass_spring` and by " +
           percent(*coupled->surface_error) +
           " with `coupled_springs` (root mean square over the largest displacement, compared with "
           "`solid`, whose own error there is " +
           percent(chart_.surface.error) + ").";
  }

  [[nodiscard]] std::string at_knee() const {
    if (!verdict_.knee)
      return "The front has no knee: " +
             std::string(verdict_.front.size() < 3 ? "fewer than three configurations are on it."
                                                   : "every step along it costs alike.");
    const std::size_t knee = *verdict_.knee;
    std::string text = "The knee is " + named(knee) + ": " + how(knee) + "; ";
    for (const std::size_t i : verdict_.front)
      if (verdict_.error[i] <= 0.5 * verdict_.error[knee])
        return text + "to halve its error costs " + times(i, knee) + " as much: `" + name(i) +
               "`, " + how(i) + ".";
    return text +
           (verdict_.error[knee] < 2.0 * verdict_.floor
                ? "the reference is not accurate enough to show that a configuration halves it."
                : "no configuration halves its error.");
  }

  // The most accurate variant that is fast enough for a haptic device.
  [[nodiscard]] std::string real_time() const {
    std::optional<std::size_t> best;
    for (const std::size_t i : verdict_.front)
      if (verdict_.cost[i] <= real_time_cost) best = i;
    if (!best)
      return "No configuration runs in real time: each takes more than 1000 µs per ms.\n\n";
    return "In real time (1000 µs per ms) the most accurate is " + named(*best) + ": " +
           how(*best) + ".\n\n";
  }

  // The errors of integrators and time steps alone.
  [[nodiscard]] std::string in_time() const {
    double most = 0.0;
    double floor = comparison_error;
    std::vector<Tradeoff> tradeoffs(chart_.rows.size());
    for (std::size_t i = 0; i < chart_.rows.size(); ++i) {
      const Measurement& one = chart_.rows[i];
      if (!one.time_error || verdict_.cost[i] <= 0.0) continue;
      most = std::max(most, one.time_error->greatest);
      floor = std::max(floor, one.time_floor);
    }
    for (std::size_t i = 0; i < chart_.rows.size(); ++i)
      if (const auto& off = chart_.rows[i].time_error; off && verdict_.cost[i] > 0.0)
        tradeoffs[i] = {verdict_.cost[i], std::max(off->greatest, floor)};
    const std::vector<std::size_t> best = pareto_front(tradeoffs);
    const auto in_group = [](const Measurement& one) {
      return one.variant.group == "integrator x time step";
    };
    const bool press = std::ranges::any_of(
        chart_.rows, [](const Measurement& one) { return !one.coupling.empty(); });
    if (press && std::ranges::none_of(chart_.rows, in_group))
      return "All integrators and steps give the same force, which does not depend on the motion "
             "of the mesh.\n\n";
    if (best.empty()) return "";
    if (most <= floor)
      return "Time integration alone (compared with `modal`, " + percent(floor) +
             "): all integrators and steps give the same.\n\n";
    std::string text = "Time integration alone, compared with `modal` (" + percent(floor) + "):";
    for (const std::size_t i : best)
      text += "\n- `" + chart_.rows[i].variant.name + "`, " + percent(tradeoffs[i].error) + ", " +
              cost(i);
    return text + "\n\n";
  }

  [[nodiscard]] std::string front() const {
    std::string text =
        "The front, from cheap to accurate:\n\n| configuration | error | displaced surface | us "
        "per ms | set-up |\n|---|---|---|---|---|\n";
    for (const std::size_t i : verdict_.front)
      text +=
          "| `" + name(i) + "`" + (verdict_.knee == i ? " (knee)" : "") + " | " + error(i) + " | " +
          (chart_.rows[i].surface_error ? percent(*chart_.rows[i].surface_error) : "-") + " | " +
          rounded(verdict_.cost[i]) + " | " + rounded(median(chart_.rows[i].setups())) + " s |\n";
    return text;
  }

  // Variants without a result, those with the same reason together; chart.csv has a row for each.
  [[nodiscard]] std::string rest() const {
    std::string text;
    for (const Status status : {Status::diverged, Status::not_run, Status::cannot}) {
      std::vector<std::pair<std::string, std::vector<std::string>>> reasons;
      std::size_t number = 0;
      for (const Measurement& one : chart_.rows) {
        if (one.status != status) continue;
        ++number;
        auto at = std::ranges::find(reasons, one.note, &decltype(reasons)::value_type::first);
        if (at == reasons.end()) at = reasons.insert(at, {one.note, {}});
        at->second.push_back("`" + one.variant.name + "`");
      }
      if (number == 0) continue;
      text += std::to_string(number) + (status == Status::diverged  ? " diverged:\n\n"
                                        : status == Status::not_run ? " would take too long:\n\n"
                                                                    : " cannot be computed:\n\n");
      for (const auto& [reason, names] : reasons)
        text += "- " +
                (names.size() <= 3 ? joined(names, ", ")
                                   : names[0] + " and " + std::to_string(names.size() - 1) +
                                         " more configurations (chart.csv)") +
                ": " + reason + "\n";
      text += "\n";
    }
    return text;
  }

  const CaseChart& chart_;
  Verdict verdict_;
};

}  // namespace

Verdict judge(const CaseChart& chart) {
  Verdict verdict;
  verdict.floor = std::max(chart.reference_error, comparison_error);
  std::vector<Tradeoff> tradeoffs;
  for (std::size_t i = 0; i < chart.rows.size(); ++i) {
    const Measurement& one = chart.rows[i];
    const bool known =
        one.status == Status::measured && one.error.has_value() && !one.timings.empty();
    verdict.cost.push_back(known ? median(one.costs()) : 0.0);
    verdict.error.push_back(known ? std::max(one.error->greatest, verdict.floor) : 0.0);
    tradeoffs.push_back({verdict.cost[i], verdict.error[i]});
    if (known && one.variant.name == "auto") verdict.taken = i;
    if (!known) continue;
    const auto better = [&](const std::optional<std::size_t>& than, bool by_cost) {
      if (!than) return true;
      if (!by_cost && verdict.error[i] != verdict.error[*than])
        return verdict.error[i] < verdict.error[*than];
      return verdict.cost[i] < verdict.cost[*than];
    };
    if (verdict.error[i] <= chart.tolerance && better(verdict.cheapest_within, true))
      verdict.cheapest_within = i;
    if (better(verdict.nearest, false)) verdict.nearest = i;
  }
  verdict.front = pareto_front(tradeoffs);
  std::vector<Tradeoff> front;
  for (const std::size_t i : verdict.front) front.push_back(tradeoffs[i]);
  if (const auto at = knee(front)) verdict.knee = verdict.front[*at];
  return verdict;
}

record::Table chart_table(const std::vector<CaseChart>& charts) {
  record::Table table{columns, {}};
  for (const CaseChart& chart : charts) {
    const Verdict verdict = judge(chart);
    for (std::size_t i = 0; i < chart.rows.size(); ++i)
      table.rows.push_back(row_of(chart, verdict, i));
  }
  return table;
}

std::string chart_text(const std::vector<CaseChart>& charts) {
  std::string text;
  for (const CaseChart& chart : charts) text += (text.empty() ? "" : "\n") + Speaker(chart).text();
  return text;
}

ChartSentences chart_sentences(const CaseChart& chart) { return Speaker(chart).sentences(); }

std::string set_line(const std::vector<std::string>& settings) {
  if (settings.empty()) return "as the scenario stands";
  std::string text = "`";
  for (const std::string& setting : settings) {
    const bool plain = setting.find_first_of(" '\"[]{}*") == std::string::npos;
    text += (text.size() > 1 ? " --set " : "--set ") + (plain ? setting : "\"" + setting + "\"");
  }
  return text + "`";
}

namespace {

// Each model has the same colour in every chart; a variant without a scene is grey.
std::string colour_of(const std::string& model) {
  constexpr std::array<std::size_t, 6> order{2, 4, 0, 1, 3, 5};
  static_assert(scenario::model_table.size() <= order.size(), "every model has a colour");
  constexpr std::size_t no_model = 6;
  for (std::size_t i = 0; i < scenario::model_table.size(); ++i)
    if (model == scenario::model_table[i].word) return plot::line_colours[order[i]];
  return plot::line_colours[no_model];
}

// Each integrator has its marker in every chart.
std::string marker(const std::string& integrator) {
  constexpr std::array<int, 8> shapes{9, 13, 5, 11, 15, 2, 3, 1};
  static_assert(scenario::integrator_table.size() <= shapes.size(),
                "every integrator has a marker");
  constexpr int no_mesh = 7;
  for (std::size_t i = 0; i < scenario::integrator_table.size(); ++i)
    if (integrator == scenario::integrator_table[i].word) return std::to_string(shapes[i]);
  return std::to_string(no_mesh);
}

template <class One>
void add_new(std::vector<One>& all, const One& one) {
  if (std::ranges::find(all, one) == all.end()) all.push_back(one);
}

// The numbers that an axis shows.
struct Range {
  double low, high;

  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

// With a margin of a factor of two on both sides.
std::string axis(const char* name, const Range& range) {
  const double low = range.low / 2.0;
  const double high = range.high * 2.0;
  return std::string("set ") + name + "range [" + number_text(low) + ":" + number_text(high) +
         "]\n" + plot::gnuplot_logarithmic(name, low, high);
}

constexpr const char* csv_file = "chart.csv";

// The figure of a case.
class Scatter {
 public:
  Scatter(const CaseChart& chart, const Verdict& verdict) : chart_(chart), verdict_(verdict) {
    error_.take(chart.tolerance);
    for (std::size_t i = 0; i < chart.rows.size(); ++i) {
      if (verdict.cost[i] <= 0.0) continue;
      const Measurement& one = chart.rows[i];
      add_new(models_, one.model);
      add_new(integrators_, one.integrator);
      add_new(series_, std::pair(one.model, one.integrator));
      for (const double cost : one.costs()) cost_.take(cost);
      error_.take(verdict.error[i]);
    }
    if (verdict.knee)
      marks_.push_back(ringed(
          "knee", "pointtype 6 pointsize 2.2 linewidth 2.2 linecolor rgb '#000000'", "knee"));
    if (verdict.taken)
      marks_.push_back(ringed("auto",
                              "pointtype 4 pointsize 2.0 linewidth 2.2 linecolor rgb '#CC79A7'",
                              "taken by auto"));
  }

  [[nodiscard]] plot::Sheet sheet(const std::string& name, const std::string& title) const {
    // The front as a line; gnuplot sorts its rows by cost.
    std::vector<std::string> lines{
        using_rows("column('pareto') == 1") +
        " smooth unique with lines linewidth 1.6 linecolor rgb '#404040' title 'Pareto front'"};
    for (const auto& [model, integrator] : series_) lines.push_back(points(model, integrator));
    lines.insert(lines.end(), marks_.begin(), marks_.end());
    for (const std::string& model : models_)
      lines.push_back("keyentry with points pointtype 5 pointsize 1.2 linecolor rgb '#" +
                      colour_of(model) + "' title " + plot::gnuplot_quoted(model));
    for (const std::string& integrator : integrators_)
      lines.push_back("keyentry with points pointtype " + marker(integrator) +
                      " pointsize 0.9 linecolor rgb '#808080' title " +
                      plot::gnuplot_quoted(integrator.empty() ? "no mesh" : integrator));
    return {name,
            plot::gnuplot_head(name, {.height = 440 + 20 * static_cast<int>(key_rows())}) +
                frame(title) + guides() + "plot \\\n  " + joined(lines, ", \\\n  ") + "\n",
            {csv_file}};
  }

 private:
  // Two columns of the key: in more of them, which are wider than the page, gnuplot drops entries.
  [[nodiscard]] std::size_t key_rows() const {
    constexpr std::size_t front = 1;
    return (front + marks_.size() + models_.size() + integrators_.size() + 1) / 2;
  }

  [[nodiscard]] std::string frame(const std::string& title) const {
    // NaN means missing, not undefined: rows that are not drawn do not break the line of the front.
    return "set datafile missing NaN\n"
           "set title " +
           plot::gnuplot_quoted(title) +
           "\n"
           "set xlabel 'cost (µs per simulated ms)'\n"
           "set ylabel 'greatest error (%)'\n" +
           axis("x", cost_) + axis("y", {100.0 * error_.low, 100.0 * error_.high}) +
           "set key below vertical maxrows " + std::to_string(key_rows()) +
           " height 1 Left reverse samplen 1.6 spacing 1.2\n"
           "set tmargin 2.5\n";
  }

  // Lines at real time, at the tolerance and at the error of the reference.
  [[nodiscard]] std::string guides() const {
    const std::string tolerance = number_text(100.0 * chart_.tolerance);
    const std::string floor = number_text(100.0 * verdict_.floor);
    const std::string cost = number_text(real_time_cost);
    return "set arrow 1 from first " + cost + ", graph 0 to first " + cost +
           ", graph 1 nohead dashtype (6,4) linecolor rgb '#808080'\n"
           "set label 1 'real time' at first " +
           cost +
           ", graph 0.99 offset -0.4,0 right textcolor rgb '#606060' font ',12'\n"
           "set arrow 2 from graph 0, first " +
           tolerance + " to graph 1, first " + tolerance +
           " nohead dashtype (6,4) linecolor rgb '#808080'\n"
           "set label 2 'tolerance' at graph 0.99, first " +
           tolerance +
           " offset 0,0.5 right textcolor rgb '#606060' font ',12'\n"
           "set arrow 3 from graph 0, first " +
           floor + " to graph 1, first " + floor +
           " nohead linewidth 1.5 linecolor rgb '#808080'\n"
           "set label 3 'the reference''s own error' at graph 0.99, first " +
           floor + " offset 0,-0.6 right textcolor rgb '#606060' font ',12'\n";
  }

  // gnuplot's `using` for the rows that meet a condition: NaN as x for all others.
  [[nodiscard]] std::string using_rows(const std::string& condition) const {
    return plot::gnuplot_quoted(csv_file) + " using ((strcol('case') eq " +
           plot::gnuplot_quoted(chart_.name) + " && strcol('status') eq 'measured' && " +
           condition + ") ? column('cost_us_per_ms') : NaN):(100*column('shown_error'))";
  }

  [[nodiscard]] std::string points(const std::string& model, const std::string& integrator) const {
    return using_rows("strcol('model') eq " + plot::gnuplot_quoted(model) +
                      " && strcol('integrator') eq " + plot::gnuplot_quoted(integrator)) +
           ":(column('cost_min_us_per_ms')):(column('cost_max_us_per_ms')) with xerrorbars "
           "linewidth 1.2 linecolor rgb '#50" +
           colour_of(model) + "' pointtype " + marker(integrator) + " pointsize 0.8 notitle";
  }

  [[nodiscard]] std::string ringed(const std::string& flag, const std::string& style,
                                   const std::string& title) const {
    return using_rows("column('" + flag + "') == 1") + " with points " + style + " title " +
           plot::gnuplot_quoted(title);
  }

  const CaseChart& chart_;
  const Verdict& verdict_;
  std::vector<std::string> models_, integrators_;  // "" for models without a mesh
  // Pairs of model and integrator that have rows; gnuplot warns of a series without points.
  std::vector<std::pair<std::string, std::string>> series_;
  std::vector<std::string> marks_;  // of the knee and of `auto`, if a row has the mark
  Range cost_{real_time_cost, real_time_cost};
  Range error_{verdict_.floor, verdict_.floor};
};

}  // namespace

std::optional<plot::Sheet> scatter_sheet(const CaseChart& chart, const std::string& name,
                                         const std::string& title) {
  const Verdict verdict = judge(chart);
  if (verdict.front.empty()) return std::nullopt;
  return Scatter(chart, verdict).sheet(name, title);
}

}  // namespace palpate::chart
