// Extracts the curves of a case from its rows, fits them, and writes the table of fits.csv.
#include "fit/case_fits.h"

#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"

namespace palpate::fit {

using record::known;

namespace {

struct Curve {
  std::vector<double> x;
  std::vector<double> y;
};

class CaseFits {
 public:
  CaseFits(const scenario::Resolved& scenario, const record::CaseRecord& record,
           Residuals residuals)
      : scenario_(scenario), record_(record), residuals_(residuals) {}

  std::vector<NamedFit> all() {
    for (std::size_t i = 0; i < scenario_.steps.size(); ++i) {
      const int number = static_cast<int>(i) + 1;
      const scenario::Step& step = scenario_.steps[i];
      if (std::holds_alternative<scenario::Indent>(step) && number == first_indent()) press(number);
      if (const auto* creep = std::get_if<scenario::Creep>(&step)) creeps(number, *creep);
      if (std::holds_alternative<scenario::Relax>(step)) relaxes(number);
    }
    return fits_;
  }

 private:
  [[nodiscard]] int first_indent() const {
    for (std::size_t i = 0; i < scenario_.steps.size(); ++i)
      if (std::holds_alternative<scenario::Indent>(scenario_.steps[i]))
        return static_cast<int>(i) + 1;
    return 0;
  }

  void add(const std::string& name, const Curve& curve, Model model, Options options) {
    options.residuals = residuals_;
    try {
      fits_.push_back({record_.name, name, regress(curve.x, curve.y, model, options)});
    } catch (const InputError&) {  // a curve with too few points is excluded
    }
  }

  void press(int number) {
    Curve curve;
    for (const record::ContactRow& row : record_.contact) {
      if (row.step != number) continue;
      curve.x.push_back(unit::mm.from_si(row.indentation));
      curve.y.push_back(row.contact_force);
    }
    const auto found = scenario_.output.display_scale.find(record_.name);
    const double scale = found == scenario_.output.display_scale.end() ? 1.0 : found->second;
    press_models("force_indentation", curve);
    if (scale == 1.0) return;
    for (double& force : curve.y) force *= scale;
    press_models("force_indentation x " + number_text(scale), curve);
  }

  void press_models(const std::string& name, const Curve& curve) {
    for (const Model model : {Model::logarithmic, Model::power, Model::exponential})
      add(name, curve, model, {.x_unit = "mm", .y_unit = "N"});
  }

  void creeps(int number, const scenario::Creep& creep) {
    Curve loaded;
    Curve free;
    double start = -1.0;
    for (const record::StrainRow& row : record_.strain) {
      if (row.step != number) continue;
      if (start < 0.0) start = row.time;
      Curve& curve = row.stress > 0.0 ? loaded : free;
      curve.x.push_back(row.time);
      curve.y.push_back(row.strain);
    }
    // A standard linear solid deforms at once and then creeps, by the same formula as it relaxes.
    const bool solid = scenario_.tissue.viscosity == tissue::Viscosity::standard_linear_solid;
    add("creep", loaded, solid ? Model::standard_linear_solid : Model::kelvin_voigt,
        {.x_unit = "s", .y_unit = "", .x_origin = start});
    add("recovery", free, Model::kelvin_voigt_recovery,
        {.x_unit = "s", .y_unit = "", .x_origin = start + creep.load_time});
  }

  void relaxes(int number) {
    Curve curve;
    for (const record::StrainRow& row : record_.strain) {
      if (row.step != number) continue;
      curve.x.push_back(row.time);
      curve.y.push_back(unit::kPa.from_si(row.stress));
    }
    if (curve.x.empty()) return;
    add("relaxation", curve, Model::standard_linear_solid,
        {.x_unit = "s", .y_unit = "kPa", .x_origin = curve.x.front()});
  }

  const scenario::Resolved& scenario_;
  const record::CaseRecord& record_;
  Residuals residuals_;
  std::vector<NamedFit> fits_;
};

}  // namespace

std::vector<NamedFit> case_fits(const scenario::Resolved& scenario,
                                const record::CaseRecord& record, Residuals residuals) {
  return CaseFits(scenario, record, residuals).all();
}

record::Table fit_table(std::span<const NamedFit> fits) {
  record::Table table;
  table.columns = {"case",     "curve",     "model",     "parameter",  "unit",
                   "estimate", "std_error", "ci95_low",  "ci95_high",  "r2",
                   "rmse",     "n",         "range_low", "range_high", "termination"};
  for (const NamedFit& named : fits) {
    const Fit& fit = named.fit;
    for (const Estimate& parameter : fit.parameters)
      table.rows.push_back({known(named.case_name), known(named.curve), known(model_name(fit)),
                            known(parameter.name), known(parameter.unit), known(parameter.estimate),
                            known(parameter.std_error), known(parameter.ci95_low),
                            known(parameter.ci95_high), known(fit.r2), known(fit.rmse),
                            known(fit.n), known(fit.range_low), known(fit.range_high),
                            known(word(fit.termination))});
  }
  return table;
}

record::Table measured_fit_table(std::span<const NamedFit> fits) {
  record::Table table = fit_table(fits);
  for (const char* name : {"excluded", "effective_n", "durbin_watson", "law"})
    table.columns.emplace_back(name);
  std::size_t row = 0;
  for (const NamedFit& named : fits)
    for (std::size_t i = 0; i < named.fit.parameters.size(); ++i, ++row) {
      const Fit& fit = named.fit;
      for (record::Cell cell : {known(fit.excluded), known(fit.effective_size),
                                known(fit.durbin_watson), known(formula_of(fit))})
        table.rows[row].push_back(std::move(cell));
    }
  return table;
}

}  // namespace palpate::fit
