// Chooses the figures of a family, with one series per case and its fits.
#include "report/family_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "base/text.h"
#include "base/units.h"
#include "plot/gnuplot_text.h"

namespace palpate::report {
namespace {

// Puts negative numbers into brackets, so that they can follow an operator.
std::string operand(double number) {
  return number < 0.0 ? "(" + number_text(number) + ")" : number_text(number);
}

std::string formula(fit::Model model, const std::vector<std::string>& p) {
  switch (model) {
    case fit::Model::logarithmic: return p[0] + " + " + p[1] + "*log(x)";
    case fit::Model::power: return p[0] + "*x**" + p[1];
    case fit::Model::exponential: return p[0] + "*(exp(" + p[1] + "*x) - 1)";
    case fit::Model::kelvin_voigt: return p[0] + "*(1 - exp(-x/" + p[1] + "))";
    case fit::Model::kelvin_voigt_recovery: return p[0] + "*exp(-x/" + p[1] + ")";
    case fit::Model::standard_linear_solid:
      return p[0] + " + (" + p[1] + " - " + p[0] + ")*exp(-x/" + p[2] + ")";
  }
  return {};
}

// A kind of figure: the file and columns of a series that names none, and the labels.
struct FigureRow {
  const char* name;
  const char* file;
  const char *x, *y;
  const char *x_label, *y_label;
  bool from_zero = true;
  const char* fit_label = "";
};
// In the order of Kind.
constexpr const char* pressed = "force_indentation.csv";
constexpr const char* strained = "strain_time.csv";
constexpr std::array<FigureRow, 9> figure_rows{{
    {"force_indentation", pressed, "travel_mm", "force_N", "Displacement (mm)", "Force F (N)"},
    {"force_indentation", pressed, "indentation_mm", "force_N", "Effective depth h (mm)",
     "Force F (N)"},
    {"force_curvature", "findings.csv", "local_curvature_per_m", "peak_force_N",
     "Mean curvature, convex positive (1/m)", "Force F (N)"},
    {"force_slide", pressed, "slide_mm", "force_N", "Slide (mm)", "Force F (N)"},
    {"displacement_slide", pressed, "slide_mm", "travel_mm", "Slide (mm)", "Displacement (mm)",
     false},
    {"strain_time", strained, "time_s", "strain", "Time (s)", "Strain", true, "Kelvin-Voigt fit"},
    {"stress_time", strained, "time_s", "stress_kPa", "Time (s)", "Stress (kPa)", true,
     "Standard linear solid fit"},
    {"stress_strain", strained, "strain", "stress_kPa", "Strain", "Stress (kPa)"},
    {"force_time", pressed, "time_s", "force_N", "Time (s)", "Force F (N)"},
}};

}  // namespace

plot::Figure figure_of(Kind kind, std::vector<plot::Series> series) {
  const FigureRow& row = figure_rows[static_cast<std::size_t>(kind)];
  for (plot::Series& each : series) {
    if (each.csv_file.empty()) each.csv_file = row.file;
    if (each.x_column.empty()) each.x_column = row.x;
    if (each.y_column.empty()) each.y_column = row.y;
  }
  return {.name = std::string("figure_") + row.name,
          .x_label = row.x_label,
          .y_label = row.y_label,
          .fit_label = row.fit_label,
          .from_zero = row.from_zero,
          .series = std::move(series)};
}

std::optional<plot::FittedCurve> fitted_curve(const fit::Fit& fit) {
  std::vector<std::string> parameters;
  for (const fit::Estimate& parameter : fit.parameters) {
    if (!std::isfinite(parameter.estimate)) return std::nullopt;
    parameters.push_back(operand(parameter.estimate));
  }
  return plot::FittedCurve{formula(fit.model, parameters), fit.x_origin, fit.range_low,
                           fit.range_high};
}

namespace {

struct CaseColours {
  plot::ColourBar bar = {};
  std::string others = {};  // the keys in the labels
  // By the case's name: the number, and a label made of the other swept values.
  std::map<std::string, std::pair<double, std::string>> cases = {};
};

// The names of keys, over a legend.
std::string labels_of(std::vector<std::string> keys) {
  for (std::string& key : keys) key = plot::key_label(key);
  return joined(keys, ", ");
}

constexpr std::size_t most_named_cases = 8;
constexpr std::size_t most_labels = 12;

struct Numbers {
  std::vector<double> values = {};  // one per case
  std::string unit = {};
};

// The values of swept key k as numbers with one unit; nothing if one of them is something else.
std::optional<Numbers> numbers_of(const scenario::Family& family, std::size_t k) {
  Numbers numbers;
  for (const scenario::Case& one : family.cases) {
    const std::string& word = one.swept[k].second;
    const auto number = leading_number(word);
    if (!number || number->out_of_range) return std::nullopt;
    const std::string unit = trimmed(number->rest);
    if (!numbers.values.empty() && unit != numbers.unit) return std::nullopt;
    numbers.unit = unit;
    numbers.values.push_back(number->value);
  }
  return numbers;
}

// Nothing for up to eight cases, which a legend can name, and if no swept key is a number with one
// unit and at least three values. Of several such keys the one with the most values is taken. If
// the others have more than a dozen combinations, their labels are equal and the bar's label says
// so.
std::optional<CaseColours> case_colours(const scenario::Family& family) {
  if (family.cases.size() <= most_named_cases) return std::nullopt;
  std::optional<Numbers> best;
  std::size_t key = 0, most = 2;
  for (std::size_t k = 0; k < family.cases.front().swept.size(); ++k) {
    std::optional<Numbers> numbers = numbers_of(family, k);
    if (!numbers) continue;
    const std::size_t count = std::set(numbers->values.begin(), numbers->values.end()).size();
    if (count <= most) continue;
    most = count;
    key = k;
    best = std::move(numbers);
  }
  if (!best) return std::nullopt;
  CaseColours colours;
  const auto [low, high] = std::ranges::minmax_element(best->values);
  colours.bar = {.label = plot::key_label(family.cases.front().swept[key].first) +
                          (best->unit.empty() ? "" : " (" + best->unit + ")"),
                 .low = *low,
                 .high = *high};
  constexpr double wide = 30.0;  // as for the axes of a figure
  if (*low > 0.0 && *high > wide * *low) colours.bar.scale = plot::Axis::logarithmic;
  std::set<std::string> labels;
  std::vector<std::string> keys = family.design.keys();
  keys.erase(keys.begin() + static_cast<std::ptrdiff_t>(key));
  colours.others = labels_of(keys);
  for (std::size_t i = 0; i < family.cases.size(); ++i) {
    std::vector<std::string> others;
    for (std::size_t k = 0; k < family.cases[i].swept.size(); ++k)
      if (k != key) others.push_back(family.cases[i].swept[k].second);
    const std::string label = others.empty() ? "all cases" : joined(others, ", ");
    labels.insert(label);
    colours.cases[family.cases[i].name] = {best->values[i], label};
  }
  if (labels.size() > most_labels) {
    for (auto& [name, one] : colours.cases) one.second = "all cases";
    colours.bar.label += "; other keys vary too";
    colours.others.clear();
  }
  return colours;
}

using Records = std::vector<record::CaseRecord>;

template <class Kind>
bool has_step(const scenario::Scenario& scenario) {
  return std::ranges::any_of(scenario.steps, [](const scenario::Step& step) {
    return std::holds_alternative<Kind>(step);
  });
}

double display_scale(const scenario::Family& family, const record::CaseRecord& record) {
  const auto& scales = family.base.output.display_scale;
  const auto scale = scales.find(record.name);
  return scale == scales.end() ? 1.0 : scale->second;
}

// More curves are a surface, and gnuplot reads the table once for every curve.
constexpr std::size_t most_curves = 64;

// The places of the colours of all cases by name; none where cases share a tissue.
std::map<std::string, std::size_t> tissue_colours(const scenario::Family& family) {
  std::vector<std::string> tissues;
  for (const scenario::Case& one : family.cases) tissues.push_back(one.scenario.tissue.material);
  if (std::set<std::string>(tissues.begin(), tissues.end()).size() < tissues.size()) return {};
  const std::vector<std::size_t> places = plot::tissue_colours(tissues);
  std::map<std::string, std::size_t> by_name;
  for (std::size_t i = 0; i < places.size(); ++i) by_name[family.cases[i].name] = places[i];
  return by_name;
}

// One series per case, without fits; if there are many cases, coloured by a swept number. Of more
// than most_curves cases, as many evenly chosen ones, which the title says.
plot::Figure with_cases(Kind kind, const scenario::Family& family, const Records& records) {
  const std::optional<CaseColours> colours = case_colours(family);
  std::vector<plot::Series> all;
  const std::size_t drawn = std::min(records.size(), most_curves);
  const std::map<std::string, std::size_t> places = tissue_colours(family);
  for (std::size_t i = 0; i < drawn; ++i) {
    const record::CaseRecord& record =
        records[drawn == 1 ? 0 : i * (records.size() - 1) / (drawn - 1)];
    plot::Series series{
        .case_name = record.name, .scale = display_scale(family, record), .colour = {}};
    if (records.size() == 1) series.label = "computed";
    if (const auto place = places.find(record.name); place != places.end())
      series.colour = place->second;
    if (colours) {
      const auto& [shade, label] = colours->cases.at(record.name);
      series.shade = shade;
      series.label = label;
    }
    all.push_back(series);
  }
  plot::Figure made = figure_of(kind, std::move(all));
  if (colours) made.bar = colours->bar;
  made.legend = colours ? colours->others : labels_of(family.design.keys());
  return made;
}

// Draws the fits of these curves and models; `also` is the curve that is drawn beside `curve`.
void add_fits(plot::Figure& figure, const std::vector<fit::NamedFit>& fits,
              const std::string& curve, const std::optional<fit::Model>& model = {},
              const std::string& also = {}) {
  for (plot::Series& series : figure.series)
    for (const fit::NamedFit& named : fits) {
      // The fit of a scaled curve has another name and is excluded: the figure scales this fit.
      if (named.case_name != series.case_name || (model && named.fit.model != *model) ||
          (named.curve != curve && (also.empty() || named.curve != also)))
        continue;
      if (const auto drawn = fitted_curve(named.fit)) series.fits.push_back(*drawn);
    }
}

// Chooses a logarithmic axis if the largest values of the series differ so much that some would lie
// on a linear axis. `depth` is the factor from the smallest of them down to the axis.
void choose_axis(plot::Figure& figure, const std::vector<double>& peaks, double depth) {
  constexpr double wide = 30.0;  // a curve of a thirtieth of the height cannot be told from 0
  double low = INFINITY, high = 0.0;
  for (const double peak : peaks) {
    if (!(peak > 0.0)) continue;
    low = std::min(low, peak);
    high = std::max(high, peak);
  }
  if (!(high > wide * low) || !std::isfinite(low)) return;
  figure.y_axis = plot::Axis::logarithmic;
  figure.y_low = low / depth;
  figure.y_high = 1.5 * high;
}

template <class Row>
std::vector<double> peaks(const scenario::Family& family, const Records& records,
                          std::vector<Row> record::CaseRecord::*rows, double Row::*value) {
  std::vector<double> all;
  for (const record::CaseRecord& record : records) {
    double peak = 0.0;
    for (const Row& row : record.*rows) peak = std::max(peak, row.*value);
    all.push_back(display_scale(family, record) * peak);
  }
  return all;
}

// Where curves of different decades lie on a linear axis, they stand beside it on two logarithmic
// ones as well, on which a power law is straight; alone if decades of a number are swept.
void add_decades(std::vector<plot::Figure>& figures, plot::Figure decades,
                 const scenario::Family& family, const Records& records) {
  const bool fitted = decades.series.front().x_column == "indentation_mm";
  double deepest = 0.0;
  for (const record::CaseRecord& record : records)
    for (const record::ContactRow& row : record.contact)
      deepest = std::max(deepest, unit::mm.from_si(fitted ? row.indentation : row.travel));
  if (!(deepest > 0.0)) return;
  constexpr double range = 30.0;  // of the depth
  decades.x_axis = plot::Axis::logarithmic;
  decades.x_low = deepest / range;
  decades.x_high = deepest;
  bool swept = false;
  for (std::size_t k = 0; k < family.cases.front().swept.size(); ++k)
    if (const auto numbers = numbers_of(family, k)) {
      const auto [low, high] = std::ranges::minmax_element(numbers->values);
      swept = swept || (*low > 0.0 && *high > 10.0 * *low);
    }
  if (swept) {
    figures.front() = std::move(decades);
    return;
  }
  decades.name += "_decades";
  figures.insert(figures.begin() + 1, std::move(decades));
}

bool has_measured_force(const record::CaseRecord& record) {
  return std::ranges::any_of(
      record.measured, [](const record::MeasuredRow& row) { return std::isfinite(row.force); });
}

// The regression that the scenario asks for, with the range of its R2 in the legend.
void add_regression(plot::Figure& figure, const scenario::Family& family,
                    const std::vector<fit::NamedFit>& fits) {
  using Regression = scenario::Output::Regression;
  const Regression asked = family.base.output.regression;
  if (asked == Regression::none) return;
  const fit::Model model = asked == Regression::logarithmic ? fit::Model::logarithmic
                           : asked == Regression::power     ? fit::Model::power
                                                            : fit::Model::exponential;
  add_fits(figure, fits, "force_indentation", model);
  double low = INFINITY, high = -INFINITY;
  for (const fit::NamedFit& named : fits) {
    if (named.curve != "force_indentation" || named.fit.model != model) continue;
    low = std::min(low, named.fit.r2);
    high = std::max(high, named.fit.r2);
  }
  figure.fit_label = asked == Regression::logarithmic ? "a + b ln h"
                     : asked == Regression::power     ? "A h^n"
                                                      : "B (exp(m h) - 1)";
  if (!std::isfinite(low) || !std::isfinite(high)) return;
  const std::string from = rounded_text(low, 2), to = rounded_text(high, 2);
  figure.fit_label += ", R² " + (from == to ? from : from + "–" + to);
}

// The number (from 1) of the first step of this kind; 0 if there is none.
template <class Kind>
int first_step(const scenario::Scenario& scenario) {
  for (std::size_t i = 0; i < scenario.steps.size(); ++i)
    if (std::holds_alternative<Kind>(scenario.steps[i])) return static_cast<int>(i) + 1;
  return 0;
}

// Force over curvature, with one curve per material if `tissue.material` is swept. Nothing if the
// cases have fewer than three different curvatures.
std::optional<plot::Figure> curvature_figure(const scenario::Family& family,
                                             const Records& records) {
  std::vector<double> curvatures, forces;
  for (const record::CaseRecord& record : records)
    for (const record::Finding& finding : record.findings) {
      if (finding.name == "local_curvature_per_m")
        curvatures.push_back(std::get<double>(finding.value));
      if (finding.name == "peak_force_N") forces.push_back(std::get<double>(finding.value));
    }
  std::ranges::sort(curvatures);
  curvatures.erase(std::unique(curvatures.begin(), curvatures.end()), curvatures.end());
  if (curvatures.size() < 3) return std::nullopt;
  std::vector<plot::Series> all;
  const std::vector<std::string>& keys = family.design.keys();
  const auto swept = std::ranges::find(keys, "tissue.material");
  if (swept == keys.end()) all.push_back({.label = "all cases"});
  for (const scenario::Case& one : family.cases) {
    if (swept == keys.end()) break;
    const std::string& material = one.swept[as_index(swept - keys.begin())].second;
    if (std::ranges::none_of(
            all, [&](const plot::Series& series) { return series.case_name == material; }))
      all.push_back({.case_name = material, .column = "tissue.material", .colour = {}});
  }
  std::vector<std::string> tissues;
  for (const plot::Series& series : all) tissues.push_back(series.case_name);
  const std::vector<std::size_t> places = plot::tissue_colours(tissues);
  for (std::size_t i = 0; swept != keys.end() && i < all.size(); ++i) all[i].colour = places[i];
  plot::Figure figure = figure_of(Kind::force_curvature, all);
  if (all.size() > 1) figure.legend = plot::key_label("tissue.material");
  choose_axis(figure, forces, 1.5);
  return figure;
}

// The way of a hand or a stand to the surface would leave no room for the curve; of it, a twentieth
// of the depth is drawn.
void begin_at_contact(plot::Figure& figure, const Records& records) {
  double deepest = 0.0;
  for (const record::CaseRecord& record : records)
    for (const record::ContactRow& row : record.contact) deepest = std::max(deepest, row.travel);
  if (!(deepest > 0.0)) return;
  for (plot::Series& series : figure.series)
    if (series.x_column == "travel_mm") series.x_from = -0.05 * unit::mm.from_si(deepest);
}

// Model and device over time; nothing if the run was not live or the device gave no force.
std::optional<plot::Figure> live_figure(const Records& records) {
  bool measured = false, sent = false;
  for (const record::CaseRecord& record : records) {
    measured = measured || has_measured_force(record);
    for (const record::MeasuredRow& row : record.measured)
      sent = sent || std::isfinite(row.sent[2]);
  }
  if (!measured && !sent) return std::nullopt;
  std::vector<plot::Series> all{{.y_column = "force_N", .label = "model"}};
  if (measured) all.push_back({.y_column = "measured_force_N", .label = "measured"});
  if (sent) all.push_back({.y_column = "sent_force_N", .label = "sent to the arm", .dashed = true});
  plot::Figure figure = figure_of(Kind::force_time, all);
  figure.name = "figure_live_force";
  return figure;
}

std::vector<plot::Figure> press_figures(const scenario::Family& family, const Records& records,
                                        const std::vector<fit::NamedFit>& fits) {
  std::vector<plot::Figure> figures;
  const std::vector<double> forces =
      peaks(family, records, &record::CaseRecord::contact, &record::ContactRow::force);
  constexpr double two_decades = 100.0;
  // Fits are of the effective depth, which enters the contact law. Otherwise the axis is the
  // displacement, as in every test standard: a modulus read off the other would be wrong on a mesh.
  const bool fitted = family.base.output.regression != scenario::Output::Regression::none;
  figures.push_back(
      with_cases(fitted ? Kind::force_depth : Kind::force_displacement, family, records));
  add_regression(figures.back(), family, fits);
  for (const record::CaseRecord& record : records)
    if (has_measured_force(record)) {
      plot::Series measured{.csv_file = figures.back().series.front().csv_file,
                            .case_name = record.name,
                            .x_column = figures.back().series.front().x_column,
                            .y_column = "measured_force_N",
                            .label = "measured"};
      if (records.size() == 1) figures.back().series.front().label = "model";
      figures.back().series.push_back(measured);
    }
  const std::optional<plot::Figure> live = live_figure(records);
  if (live) begin_at_contact(figures.back(), records);
  if (has_step<scenario::Hold>(family.base) && !live) {  // that of a live run is figure_live_force
    figures.push_back(with_cases(Kind::force_time, family, records));
    choose_axis(figures.back(), forces, two_decades);
  }
  if (const int slide = first_step<scenario::Slide>(family.base)) {
    const auto& step = std::get<scenario::Slide>(family.base.steps[as_index(slide) - 1]);
    const bool keeps_force = step.keep == scenario::Slide::Keep::force;
    plot::Figure along =
        with_cases(keeps_force ? Kind::displacement_slide : Kind::force_slide, family, records);
    for (plot::Series& series : along.series) series.step = slide;
    if (!keeps_force) choose_axis(along, forces, two_decades);
    figures.push_back(along);
    for (plot::Series& series : figures.front().series) series.step = 1;  // not the slide
  }
  plot::Figure decades = figures.front();
  choose_axis(decades, forces, two_decades);
  if (decades.y_axis == plot::Axis::logarithmic)
    add_decades(figures, std::move(decades), family, records);
  if (const auto figure = curvature_figure(family, records)) figures.push_back(*figure);
  if (live) figures.push_back(*live);
  const auto slide = std::ranges::find_if(
      figures, [](const plot::Figure& figure) { return figure.name.ends_with("_slide"); });
  if (slide != figures.end()) std::rotate(figures.begin(), slide, slide + 1);  // it is asked for
  return figures;
}

bool holds_a_compression(const scenario::Scenario& scenario) {
  return std::ranges::any_of(scenario.steps, [](const auto& step) {
    const auto* compress = std::get_if<scenario::Compress>(&step);
    return compress != nullptr && compress->hold_time > 0.0;
  });
}

std::vector<plot::Figure> uniform_figures(const scenario::Family& family, const Records& records,
                                          const std::vector<fit::NamedFit>& fits) {
  std::vector<plot::Figure> figures;
  constexpr double two_decades = 100.0;
  if (has_step<scenario::Creep>(family.base)) {
    const bool solid = family.base.tissue.viscosity == tissue::Viscosity::standard_linear_solid;
    plot::Figure figure = with_cases(Kind::strain_time, family, records);
    add_fits(figure, fits, "creep", {}, "recovery");
    figure.fit_label = solid ? "Standard linear solid fit" : "Kelvin-Voigt fit";
    choose_axis(figure,
                peaks(family, records, &record::CaseRecord::strain, &record::StrainRow::strain),
                two_decades);
    figures.push_back(figure);
  }
  const auto of_stress = [&](plot::Figure figure) {
    std::vector<double> stresses =
        peaks(family, records, &record::CaseRecord::strain, &record::StrainRow::stress);
    for (double& stress : stresses) stress = unit::kPa.from_si(stress);
    choose_axis(figure, stresses, two_decades);
    figures.push_back(figure);
  };
  if (has_step<scenario::Compress>(family.base))
    of_stress(with_cases(Kind::stress_strain, family, records));
  if (has_step<scenario::Relax>(family.base) || holds_a_compression(family.base)) {
    plot::Figure figure = with_cases(Kind::stress_time, family, records);
    add_fits(figure, fits, "relaxation");
    of_stress(figure);
  }
  return figures;
}

}  // namespace

std::vector<std::string> picture_formats(const scenario::Output& output) {
  std::vector<std::string> formats{"svg"};
  if (output.pdf) formats.emplace_back("pdf");
  if (output.png) formats.emplace_back("png");
  return formats;
}

plot::Figure gauge_figure(const scenario::Family& family) {
  plot::Figure figure = figure_of(Kind::force_time, {{.csv_file = "force_time.csv"}});
  figure.title = family.title;
  return figure;
}

std::vector<plot::Figure> family_figures(const scenario::Family& family, const Records& records,
                                         const std::vector<fit::NamedFit>& fits) {
  if (records.empty()) return {};
  std::vector<plot::Figure> figures = family.base.uniform() ? uniform_figures(family, records, fits)
                                                            : press_figures(family, records, fits);
  for (plot::Figure& figure : figures) {
    figure.title = family.title;
    if (records.size() > most_curves && figure.series.front().case_name == records.front().name)
      figure.title +=
          " (" + std::to_string(most_curves) + " of " + std::to_string(records.size()) + " cases)";
  }
  return figures;
}

}  // namespace palpate::report
