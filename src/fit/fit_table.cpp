// Writes the table of fits.csv.
#include "fit/fit_table.h"

#include <cmath>

namespace palpate::fit {
namespace {

record::Cell number(double value) {
  if (std::isnan(value)) return std::monostate{};
  return value;
}

record::Cell text(std::string_view value) {
  if (value.empty()) return std::monostate{};
  return std::string(value);
}

}  // namespace

record::Table fit_table(std::span<const NamedFit> fits) {
  record::Table table;
  table.columns = {"case",     "curve",     "model",     "parameter",  "unit",
                   "estimate", "std_error", "ci95_low",  "ci95_high",  "r2",
                   "rmse",     "n",         "range_low", "range_high", "termination"};
  for (const NamedFit& named : fits) {
    const Fit& fit = named.fit;
    for (const Estimate& parameter : fit.parameters)
      table.rows.push_back({text(named.case_name), text(named.curve),
                            text(fit.name.empty() ? info(fit.model).name : fit.name),
                            text(parameter.name), text(parameter.unit), number(parameter.estimate),
                            number(parameter.std_error), number(parameter.ci95_low),
                            number(parameter.ci95_high), number(fit.r2), number(fit.rmse),
                            number(fit.n), number(fit.range_low), number(fit.range_high),
                            text(word(fit.termination))});
  }
  return table;
}

}  // namespace palpate::fit
