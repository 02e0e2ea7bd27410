// Converts a result's table to curves in SI, and writes the formats that are plain columns.
#include "report/export.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/index.h"
#include "base/text.h"
#include "measured/columns.h"
#include "record/csv.h"
#include "report/manifest.h"

namespace palpate::report {
namespace {

struct SourceColumn {
  std::size_t index;
  std::string name;
  std::string unit;
  UnitFactor factor;
};

std::vector<SourceColumn> number_columns(const record::Table& table) {
  std::vector<SourceColumn> columns;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const bool words = std::ranges::any_of(
        table.rows, [&](const auto& row) { return std::holds_alternative<std::string>(row[i]); });
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
    auto curve = std::ranges::find(curves, name, &ExportCurve::name);
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

namespace {

[[noreturn]] void refuse_missing(const ExportCurve& curve, const char* column, const char* format,
                                 const char* needs) {
  std::vector<std::string> names;
  for (const ExportColumn& one : curve.columns) names.push_back(one.name);
  throw InputError({}, ticked(format) + " needs " + needs + ", and the curve " +
                           ticked(curve.name) + " has no " + ticked(column) + ", only " +
                           joined(names, ", ") + "; choose another format, such as `--to csv-si`");
}

// The column of that name; `needs` are the columns that the format needs.
const ExportColumn& wanted(const ExportCurve& curve, const char* column, const char* format,
                           const char* needs) {
  if (const ExportColumn* found = curve.find(column)) return *found;
  refuse_missing(curve, column, format, needs);
}

// RHEOS: stress, strain and time without a header, in the order of its exportcsv.
std::string rheos_text(const ExportCurve& curve) {
  const char* needs = "stress, strain and time";
  const ExportColumn& stress = wanted(curve, "stress", "rheos", needs);
  const ExportColumn& strain = wanted(curve, "strain", "rheos", needs);
  const ExportColumn& time = wanted(curve, "time", "rheos", needs);
  std::string text;
  for (std::size_t i = 0; i < time.values.size(); ++i)
    text += number_text(stress.values[i]) + "," + number_text(strain.values[i]) + "," +
            number_text(time.values[i]) + "\n";
  return text;
}

// FEBio log data: every column except time and step, as values of item 1.
std::string febio_log_text(const ExportCurve& curve) {
  const ExportColumn& time = wanted(curve, "time", "febio-log", "time and any numbers");
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

// Every column in SI, with units in the names.
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

// A press in the form of an indenter's data: approach up to the largest force, then retraction.
struct Press {
  const ExportColumn* time = nullptr;          // s; null if missing
  const ExportColumn* indentation = nullptr;   // m
  const ExportColumn* force = nullptr;         // N
  const ExportColumn* displacement = nullptr;  // m, of the finger; the indentation if missing
  std::size_t peak = 0;  // row of the largest force, the last row of the approach
  double speed = 0.0;    // m/s, mean of the approach; NaN without a time or an approach
};

// The smallest and the largest value that is not missing.
std::pair<double, double> range_of(const std::vector<double>& values) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::pair found{infinity, -infinity};
  for (const double value : values)
    found = {std::fmin(found.first, value), std::fmax(found.second, value)};
  return found;
}

double span_of(const std::vector<double>& values) {
  const auto [low, high] = range_of(values);
  return high - low;
}

Press press_of(const ExportCurve& curve, const char* format, const char* needs) {
  Press press;
  press.time = curve.find("time");
  press.indentation = &wanted(curve, "indentation", format, needs);
  press.force = &wanted(curve, "force", format, needs);
  press.displacement = curve.find("travel");
  if (press.displacement == nullptr) press.displacement = press.indentation;
  for (std::size_t i = 0; i < press.force->values.size(); ++i)
    if (press.force->values[i] > press.force->values[press.peak]) press.peak = i;
  press.speed = std::numeric_limits<double>::quiet_NaN();
  if (press.time == nullptr || press.peak == 0) return press;
  const auto& displacement = press.displacement->values;
  const auto& time = press.time->values;
  press.speed =
      (displacement[press.peak] - displacement.front()) / (time[press.peak] - time.front());
  return press;
}

// .tab of afmformats: force, segment, time and tip position (decreasing with the indentation).
// Format: AFM-analysis/afmformats, afm_data.py (_export_tab), fmt_tab.py and meta.py. CR LF,
// metadata as JSON in comments, column names in the last comment, booleans as in Python.
std::string afm_tab_text(const ExportCurve& curve) {
  const Press press = press_of(curve, "afm-tab", "indentation and force");
  const std::size_t rows = press.force->values.size();
  nlohmann::json metadata;
  metadata["curve id"] = curve.name;
  metadata["enum"] = 0;
  metadata["feedback mode"] = "contact";
  metadata["imaging mode"] = "force-distance";
  metadata["instrument"] = "simulated";
  metadata["point count"] = rows;
  metadata["session id"] = curve.source;
  metadata["setpoint"] = range_of(press.force->values).second;
  metadata["software"] = "palpate";
  metadata["software version"] = this_build().version;
  metadata["z range"] = span_of(press.displacement->values);
  if (press.time != nullptr) metadata["duration"] = span_of(press.time->values);
  if (std::isfinite(press.speed)) metadata["speed approach"] = press.speed;

  const std::string end = "\r\n";
  std::string text = "# palpate " + this_build().version + end + "#" + end;
  text += "# BEGIN METADATA" + end;
  for (const std::string& line :
       split(metadata.dump(2, ' ', false, nlohmann::json::error_handler_t::replace), '\n'))
    text += "# " + line + end;
  text += "# END METADATA" + end + "#" + end + "# force\tsegment\t";
  text += std::string(press.time != nullptr ? "time\t" : "") + "tip position" + end;
  for (std::size_t i = 0; i < rows; ++i) {
    text += number_text(press.force->values[i]) + (i > press.peak ? "\tTrue\t" : "\tFalse\t");
    if (press.time != nullptr) text += number_text(press.time->values[i]) + "\t";
    // The tip's height decreases with the indentation; 0 - x avoids a negative zero.
    text += number_text(0.0 - press.indentation->values[i]) + end;
  }
  return text;
}

std::string scaled_text(double si, double per) { return number_text(si * per); }

// Text file of an Optics11 Chiaro in ISO 8859-1, which afmformats (fmt_chiaro_txt) can read.
// Format: AFM-analysis/afmformats, fmt_chiaro_txt.py. Keys and values separated by tabs, column
// names, numbers; ISO 8859-1. There is no cantilever: its deflection is 0, its stiffness unknown.
std::string chiaro_text(const ExportCurve& curve) {
  const char* needs = "time, indentation and force";
  const Press press = press_of(curve, "chiaro", needs);
  if (press.time == nullptr) refuse_missing(curve, "time", "chiaro", needs);
  const std::string end = "\r\n";
  const std::string micro = "\xB5";
  const auto line = [&](const std::string& key, const std::string& value) {
    return key + "\t" + value + end;
  };
  // A simulation has no date and no time; every reader can parse 00:00:00.
  std::string text = line("Date", "none") + line("Time", "00:00:00");
  text += line("Device:", "Chiaro") + line("Software version", "palpate " + this_build().version);
  text += line("Sample", curve.name) + line("k (N/m)", "nan");
  text += line("Tip radius (um)",
               curve.tip_radius ? scaled_text(*curve.tip_radius, 1e6) : std::string("nan"));
  text += line("Max load (" + micro + "N)", scaled_text(range_of(press.force->values).second, 1e6));
  text +=
      line("Piezo position (nm) (Measured)", scaled_text(span_of(press.displacement->values), 1e9));
  text += line("Piezo speed  (" + micro + "m/s)", scaled_text(press.speed, 1e6)) + end;
  text += "Time (s)\tLoad (uN)\tIndentation (nm)\tCantilever (nm)\tPiezo (nm)" + end;
  for (std::size_t i = 0; i < press.force->values.size(); ++i)
    text += number_text(press.time->values[i]) + "\t" + scaled_text(press.force->values[i], 1e6) +
            "\t" + scaled_text(press.indentation->values[i], 1e9) + "\t0\t" +
            scaled_text(press.displacement->values[i], 1e9) + end;
  return text;
}

constexpr std::array formats{
    ExportFormat{"afm-tab", ".tab", afm_tab_text}, ExportFormat{"rheos", ".csv", rheos_text},
    ExportFormat{"chiaro", ".txt", chiaro_text}, ExportFormat{"febio-log", ".txt", febio_log_text},
    ExportFormat{"csv-si", ".csv", csv_si_text}};

}  // namespace

std::span<const ExportFormat> export_formats() { return formats; }

}  // namespace palpate::report
