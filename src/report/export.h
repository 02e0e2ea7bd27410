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
  std::string_view wants;   // the required columns, for messages
  // Returns the file's text. Throws InputError if the curve lacks a required column.
  std::string (*text)(const ExportCurve& curve);
};

// All formats; docs/data.md describes their uses.
[[nodiscard]] std::span<const ExportFormat> export_formats();

// The column of that name. Throws InputError with what `format` (a name) needs if there is none.
[[nodiscard]] const ExportColumn& wanted(const ExportCurve& curve, std::string_view column,
                                         std::string_view format);

// .tab of afmformats: force, segment, time and tip position (decreasing with the indentation).
[[nodiscard]] std::string afm_tab_text(const ExportCurve& curve);
// Text file of an Optics11 Chiaro in ISO 8859-1, which afmformats (fmt_chiaro_txt) can read.
[[nodiscard]] std::string chiaro_text(const ExportCurve& curve);
// RHEOS: stress, strain and time without a header, in the order of its exportcsv.
[[nodiscard]] std::string rheos_text(const ExportCurve& curve);
// FEBio log data: every column except time and step, as values of item 1.
[[nodiscard]] std::string febio_log_text(const ExportCurve& curve);
// Every column in SI, with units in the names.
[[nodiscard]] std::string csv_si_text(const ExportCurve& curve);

}  // namespace palpate::report
