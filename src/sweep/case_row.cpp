// Collects the row from the record of a case.
#include "sweep/case_row.h"

#include <algorithm>
#include <cmath>

#include "fit/case_fits.h"
#include "record/table.h"

namespace palpate::sweep {
namespace {

record::Cell known(double value) {
  if (std::isnan(value)) return std::monostate{};
  return value;
}

// Replaces the spaces in a curve's name, as in `force_indentation x 0.1`.
std::string column_word(std::string text) {
  std::replace(text.begin(), text.end(), ' ', '_');
  return text;
}

void add_fits(const std::vector<fit::NamedFit>& fits, SweepRow& row) {
  for (const fit::NamedFit& named : fits) {
    const std::string curve =
        column_word(named.curve) + "_" + std::string(fit::info(named.fit.model).name);
    for (const fit::Estimate& parameter : named.fit.parameters) {
      const std::string unit =
          parameter.unit.empty() ? "" : "_" + record::unit_word(parameter.unit);
      const std::string name = curve + "_" + parameter.name;
      row.values.push_back({name + unit, known(parameter.estimate)});
      row.values.push_back({name + "_std_error" + unit, known(parameter.std_error)});
    }
    row.values.push_back({curve + "_r2", known(named.fit.r2)});
  }
}

// The curve without the column `case`, because the row contains the name.
record::Table curve_of(const record::CaseRecord& record) {
  record::Table table =
      record.strain.empty() ? record::contact_table({record}) : record::strain_table({record});
  table.columns.erase(table.columns.begin());
  for (auto& row : table.rows) row.erase(row.begin());
  return table;
}

}  // namespace

SweepRow row_of(const scene::Scene& scene, const record::CaseRecord& record, bool keeps_curve) {
  SweepRow row{.reason = record.reason, .name = record.name, .warnings = record.warnings};
  if (!record.answer.complete) row.warnings.push_back(record.answer.neglected);
  if (!record.answer.uncounted.empty())
    row.warnings.push_back(std::string(not_counted) + record.answer.uncounted);
  if (record.outcome == record::Outcome::diverged) row.outcome = SweepOutcome::diverged;
  for (const record::Finding& finding : record.findings)
    if (finding.name != "outcome") row.values.push_back(finding);
  if (scene.scenario.output.fits) add_fits(fit::case_fits(scene.scenario, record), row);
  if (keeps_curve) row.curve = curve_of(record);
  return row;
}

}  // namespace palpate::sweep
