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

record::Table measured_fit_table(std::span<const NamedFit> fits) {
  record::Table table = fit_table(fits);
  for (const char* name : {"excluded", "effective_n", "durbin_watson", "law"})
    table.columns.emplace_back(name);
  std::size_t row = 0;
  for (const NamedFit& named : fits)
    for (std::size_t i = 0; i < named.fit.parameters.size(); ++i, ++row) {
      const Fit& fit = named.fit;
      const std::string law = fit.name.empty() ? std::string(info(fit.model).formula) : fit.law;
      for (record::Cell cell :
           {number(fit.excluded), number(fit.effective_size), number(fit.durbin_watson), text(law)})
        table.rows[row].push_back(std::move(cell));
    }
  return table;
}

}  // namespace palpate::fit
