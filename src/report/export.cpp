// Converts a result's table to curves in SI, and writes the formats that are plain columns.
#include "report/export.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/index.h"
#include "base/text.h"
#include "measured/unit.h"
#include "record/csv.h"

namespace palpate::report {
namespace {

constexpr std::array formats{
    ExportFormat{"afm-tab", ".tab", "indentation and force", afm_tab_text},
    ExportFormat{"rheos", ".csv", "stress, strain and time", rheos_text},
    ExportFormat{"chiaro", ".txt", "time, indentation and force", chiaro_text},
    ExportFormat{"febio-log", ".txt", "time and any numbers", febio_log_text},
    ExportFormat{"csv-si", ".csv", "any numbers", csv_si_text},
};

struct SourceColumn {
  std::size_t index;
  std::string name;
  std::string unit;
  UnitFactor factor;
};

std::vector<SourceColumn> number_columns(const record::Table& table) {
  std::vector<SourceColumn> columns;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const bool words = std::any_of(table.rows.begin(), table.rows.end(), [&](const auto& row) {
      return std::holds_alternative<std::string>(row[i]);
    });
    if (words) continue;
    const measured::NamedColumn named = measured::named_column(table.columns[i]);
    if (named.unit)
      columns.push_back({i, named.bare, si_unit(named.unit->factor.dimension), named.unit->factor});
    else
      columns.push_back({i, table.columns[i], "", {}});
  }
  return columns;
}

}  // namespace

const ExportColumn* ExportCurve::find(std::string_view column) const {
  for (const ExportColumn& one : columns)
    if (one.name == column) return &one;
  return nullptr;
}

std::vector<ExportCurve> export_curves(const record::Table& table, const std::string& fallback) {
  const std::vector<SourceColumn> sources = number_columns(table);
  const int name_at = table.find("case");
  std::vector<ExportCurve> curves;
  for (const auto& row : table.rows) {
    std::string name = fallback;
    if (name_at >= 0) {
      const record::Cell& cell = row[as_index(name_at)];
      if (const auto* word = std::get_if<std::string>(&cell)) name = *word;
      if (const auto* number = std::get_if<double>(&cell)) name = number_text(*number);
    }
    auto curve = std::find_if(curves.begin(), curves.end(),
                              [&](const ExportCurve& one) { return one.name == name; });
    if (curve == curves.end()) {
      curves.push_back({.name = name, .source = fallback, .columns = {}});
      curve = curves.end() - 1;
      for (const SourceColumn& source : sources)
        if (static_cast<int>(source.index) != name_at)
          curve->columns.push_back({source.name, source.unit, {}});
    }
    std::size_t k = 0;
    for (const SourceColumn& source : sources) {
      if (static_cast<int>(source.index) == name_at) continue;
      const auto* number = std::get_if<double>(&row[source.index]);
      curve->columns[k++].values.push_back(number != nullptr
                                               ? source.factor.to_si(*number)
                                               : std::numeric_limits<double>::quiet_NaN());
    }
  }
  return curves;
}

std::span<const ExportFormat> export_formats() { return formats; }

const ExportColumn& wanted(const ExportCurve& curve, std::string_view column,
                           std::string_view format) {
  if (const ExportColumn* found = curve.find(column)) return *found;
  const auto& row = *std::find_if(formats.begin(), formats.end(),
                                  [&](const ExportFormat& one) { return one.name == format; });
  std::vector<std::string> names;
  for (const ExportColumn& one : curve.columns) names.push_back(one.name);
  throw InputError({}, ticked(format) + " needs " + std::string(row.wants) + ", and the curve " +
                           ticked(curve.name) + " has no " + ticked(column) + ", only " +
                           joined(names, ", ") + "; choose another format, such as `--to csv-si`");
}

std::string rheos_text(const ExportCurve& curve) {
  const ExportColumn& stress = wanted(curve, "stress", "rheos");
  const ExportColumn& strain = wanted(curve, "strain", "rheos");
  const ExportColumn& time = wanted(curve, "time", "rheos");
  std::string text;
  for (std::size_t i = 0; i < time.values.size(); ++i)
    text += number_text(stress.values[i]) + "," + number_text(strain.values[i]) + "," +
            number_text(time.values[i]) + "\n";
  return text;
}

std::string febio_log_text(const ExportCurve& curve) {
  const ExportColumn& time = wanted(curve, "time", "febio-log");
  std::vector<const ExportColumn*> values;
  std::vector<std::string> names;
  for (const ExportColumn& column : curve.columns)
    if (column.name != "time" && column.name != "step") {
      values.push_back(&column);
      names.push_back(column.unit.empty() ? column.name : column.name + "_" + column.unit);
    }
  const std::string data = joined(names, ";");
  std::string text;
  for (std::size_t i = 0; i < time.values.size(); ++i) {
    // FEBio's DataRecord::Write has the same spaces around `=`.
    text += "*Step  = " + std::to_string(i) + "\n*Time  = " + number_text(time.values[i]) +
            "\n*Data  = " + data + "\n1";
    for (const ExportColumn* column : values) text += "," + number_text(column->values[i]);
    text += "\n";
  }
  return text;
}

std::string csv_si_text(const ExportCurve& curve) {
  record::Table table;
  for (const ExportColumn& column : curve.columns)
    table.columns.push_back(column.unit.empty() ? column.name : column.name + "_" + column.unit);
  if (table.columns.empty())
    throw InputError({}, "the curve `" + curve.name + "` has no column of numbers to export");
  const std::size_t rows = curve.columns.front().values.size();
  for (std::size_t i = 0; i < rows; ++i) {
    std::vector<record::Cell> row;
    for (const ExportColumn& column : curve.columns) {
      if (std::isnan(column.values[i]))
        row.emplace_back(std::monostate{});
      else
        row.emplace_back(column.values[i]);
    }
    table.rows.push_back(row);
  }
  return record::csv_text(table);
}

}  // namespace palpate::report
