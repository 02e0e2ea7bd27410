// One series a case; its fits over it.
#include "report/family_figures.h"

#include <algorithm>

namespace palpate::report {
namespace {

bool has_step(const scenario::Scenario& scenario, bool (*is)(const scenario::Step&)) {
  return std::any_of(scenario.steps.begin(), scenario.steps.end(), is);
}

bool is_logarithmic(const fit::NamedFit& named) {
  // The scaled copy of a curve is drawn by scaling this one.
  return named.curve == "force_indentation" && named.fit.model == fit::Model::logarithmic;
}
bool is_creep(const fit::NamedFit& named) {
  return named.curve == "creep" || named.curve == "recovery";
}
bool is_relaxation(const fit::NamedFit& named) { return named.curve == "relaxation"; }

std::vector<Series> series_of(const scenario::Family& family,
                              const std::vector<record::CaseRecord>& records,
                              const std::vector<fit::NamedFit>& fits,
                              bool (*wanted)(const fit::NamedFit&)) {
  std::vector<Series> all;
  for (const record::CaseRecord& record : records) {
    Series series;
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

}  // namespace

std::vector<Figure> family_figures(const scenario::Family& family,
                                   const std::vector<record::CaseRecord>& records,
                                   const std::vector<fit::NamedFit>& fits) {
  std::vector<Figure> figures;
  if (records.empty()) return figures;
  if (!family.base.uniform()) {
    figures.push_back(figure_force_indentation(series_of(family, records, fits, is_logarithmic)));
  } else {
    const bool solid = family.base.tissue.viscosity == tissue::Viscosity::standard_linear_solid;
    const char* const fit_label = solid ? "Standard linear solid fit" : "Kelvin-Voigt fit";
    if (has_step(family.base, [](const scenario::Step& step) {
          return std::holds_alternative<scenario::Creep>(step);
        })) {
      Figure figure = figure_strain_time(series_of(family, records, fits, is_creep));
      figure.fit_label = fit_label;
      figures.push_back(figure);
    }
    if (has_step(family.base, [](const scenario::Step& step) {
          return std::holds_alternative<scenario::Relax>(step);
        })) {
      Figure figure = figure_strain_time(series_of(family, records, fits, is_relaxation));
      figure.name = "figure_stress_time";
      figure.y_label = "Stress (kPa)";
      figure.fit_label = "Standard linear solid fit";
      for (Series& series : figure.series) series.y_column = "stress_kPa";
      figures.push_back(figure);
    }
  }
  for (Figure& figure : figures) figure.title = family.title;
  return figures;
}

}  // namespace palpate::report
