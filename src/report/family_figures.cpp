// Chooses the figures of a family, with one series per case and its fits.
#include "report/family_figures.h"

#include <algorithm>
#include <cmath>

#include "report/figures.h"

namespace palpate::report {
namespace {

bool has_step(const scenario::Scenario& scenario, bool (*is)(const scenario::Step&)) {
  return std::any_of(scenario.steps.begin(), scenario.steps.end(), is);
}

bool is_logarithmic(const fit::NamedFit& named) {
  // The fit of a scaled curve is left out: the figure scales this fit instead.
  return named.curve == "force_indentation" && named.fit.model == fit::Model::logarithmic;
}
bool is_creep(const fit::NamedFit& named) {
  return named.curve == "creep" || named.curve == "recovery";
}
bool is_relaxation(const fit::NamedFit& named) { return named.curve == "relaxation"; }

std::vector<plot::Series> series_of(const scenario::Family& family,
                                    const std::vector<record::CaseRecord>& records,
                                    const std::vector<fit::NamedFit>& fits,
                                    bool (*wanted)(const fit::NamedFit&)) {
  std::vector<plot::Series> all;
  for (const record::CaseRecord& record : records) {
    plot::Series series;
    series.case_name = record.name;
    const auto& scales = family.base.output.display_scale;
    const auto scale = scales.find(record.name);
    if (scale != scales.end()) series.scale = scale->second;
    for (const fit::NamedFit& named : fits) {
      if (named.case_name != record.name || !wanted(named)) continue;
      if (const auto curve = fitted_curve(named.fit)) series.fits.push_back(*curve);
    }
    all.push_back(series);
  }
  return all;
}

bool has_measured_force(const record::CaseRecord& record) {
  return std::any_of(record.measured.begin(), record.measured.end(),
                     [](const auto& row) { return std::isfinite(row.force); });
}

// The number (from 1) of the first step for which `is` is true; 0 if there is none.
int first_step(const scenario::Scenario& scenario, bool (*is)(const scenario::Step&)) {
  const auto found = std::find_if(scenario.steps.begin(), scenario.steps.end(), is);
  return found == scenario.steps.end() ? 0 : static_cast<int>(found - scenario.steps.begin()) + 1;
}

bool is_slide(const scenario::Step& step) { return std::holds_alternative<scenario::Slide>(step); }

// Force over curvature, with one curve per material if `tissue.material` is swept. Nothing if the
// cases have fewer than three different curvatures.
std::optional<plot::Figure> curvature_figure(const scenario::Family& family,
                                             const std::vector<record::CaseRecord>& records) {
  std::vector<double> curvatures;
  for (const record::CaseRecord& record : records)
    for (const record::Finding& finding : record.findings)
      if (finding.name == "local_curvature_per_m")
        curvatures.push_back(std::get<double>(finding.value));
  std::sort(curvatures.begin(), curvatures.end());
  curvatures.erase(std::unique(curvatures.begin(), curvatures.end()), curvatures.end());
  if (curvatures.size() < 3) return std::nullopt;
  std::vector<plot::Series> all;
  const std::vector<std::string>& keys = family.design.keys();
  const auto swept = std::find(keys.begin(), keys.end(), "tissue.material");
  if (swept == keys.end()) return figure_force_curvature({{.label = "all cases"}});
  for (const scenario::Case& one : family.cases) {
    const std::string& material = one.swept[as_index(swept - keys.begin())].second;
    if (std::none_of(all.begin(), all.end(),
                     [&](const plot::Series& series) { return series.case_name == material; }))
      all.push_back({.case_name = material, .column = "tissue.material"});
  }
  return figure_force_curvature(all);
}

}  // namespace

std::vector<plot::Figure> family_figures(const scenario::Family& family,
                                         const std::vector<record::CaseRecord>& records,
                                         const std::vector<fit::NamedFit>& fits) {
  std::vector<plot::Figure> figures;
  if (records.empty()) return figures;
  if (!family.base.uniform()) {
    std::vector<plot::Series> forces = series_of(family, records, fits, is_logarithmic);
    for (const record::CaseRecord& record : records)
      if (has_measured_force(record))
        forces.push_back(
            {.case_name = record.name, .y_column = "measured_force_N", .label = "measured"});
    figures.push_back(figure_force_indentation(forces));
    if (const int slide = first_step(family.base, is_slide)) {
      const auto nothing = [](const fit::NamedFit&) { return false; };
      std::vector<plot::Series> along = series_of(family, records, fits, nothing);
      for (plot::Series& series : along) series.step = slide;
      const auto& step = family.base.steps[as_index(slide) - 1];
      const bool keeps_force = std::get<scenario::Slide>(step).keep == scenario::Slide::Keep::force;
      figures.push_back(keeps_force ? figure_travel_slide(along) : figure_force_slide(along));
      for (plot::Series& series : figures.front().series) series.step = 1;  // not the slide
    }
    if (const auto figure = curvature_figure(family, records)) figures.push_back(*figure);
  } else {
    const bool solid = family.base.tissue.viscosity == tissue::Viscosity::standard_linear_solid;
    const char* const fit_label = solid ? "Standard linear solid fit" : "Kelvin-Voigt fit";
    if (has_step(family.base, [](const scenario::Step& step) {
          return std::holds_alternative<scenario::Creep>(step);
        })) {
      plot::Figure figure = figure_strain_time(series_of(family, records, fits, is_creep));
      figure.fit_label = fit_label;
      figures.push_back(figure);
    }
    if (has_step(family.base, [](const scenario::Step& step) {
          return std::holds_alternative<scenario::Relax>(step);
        })) {
      plot::Figure figure = figure_strain_time(series_of(family, records, fits, is_relaxation));
      figure.name = "figure_stress_time";
      figure.y_label = "Stress (kPa)";
      figure.fit_label = "Standard linear solid fit";
      for (plot::Series& series : figure.series) series.y_column = "stress_kPa";
      figures.push_back(figure);
    }
  }
  for (plot::Figure& figure : figures) figure.title = family.title;
  return figures;
}

}  // namespace palpate::report
