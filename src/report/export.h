// Exports results in the formats of other programs.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "record/table.h"

namespace palpate::report {

struct ExportColumn {
  std::string name;            // without its unit: `indentation`
  std::string unit;            // SI: `m`; empty for a pure number
  std::vector<double> values;  // SI; a missing value is NaN
};

// The curve of one case.
struct ExportCurve {
  std::string name;
  std::string source;                     // the result that contains it
  std::optional<double> tip_radius = {};  // m; none if unknown
  std::vector<ExportColumn> columns;      // of equal size

  [[nodiscard]] const ExportColumn* find(std::string_view column) const;
};

// The curves of a result's table, one per case in the order of their first rows. A table without
// the column `case` is one curve with the name `fallback`. Columns that contain words are excluded.
[[nodiscard]] std::vector<ExportCurve> export_curves(const record::Table& table,
                                                     const std::string& fallback);

struct ExportFormat {
  std::string_view name;    // on the command line
  std::string_view ending;  // of file names: `.tab`
  // Returns the file's text. Throws InputError if the curve lacks a required column.
  std::string (*text)(const ExportCurve& curve);
};

// All formats; docs/data.md describes their uses.
[[nodiscard]] std::span<const ExportFormat> export_formats();

}  // namespace palpate::report
