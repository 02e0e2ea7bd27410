// Results in the formats of other tools.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "record/table.h"

namespace palpate::report {

// One column in SI; what is missing is NaN.
struct ExportColumn {
  std::string name;  // without its unit: `indentation`
  std::string unit;  // of SI: `m`; empty: a pure number
  std::vector<double> values;
};

// The curve of one case.
struct ExportCurve {
  std::string name;
  std::string source;                     // the result it comes from
  std::optional<double> tip_radius = {};  // m, where it is known
  std::vector<ExportColumn> columns;      // all of one size

  [[nodiscard]] const ExportColumn* find(std::string_view column) const;
};

// The curves of a result's table, one a case in the order of their first rows; a table without the
// column `case` is one curve of the name `fallback`. Columns of words are left out.
[[nodiscard]] std::vector<ExportCurve> export_curves(const record::Table& table,
                                                     const std::string& fallback);

struct ExportFormat {
  std::string_view name;    // the word of the command line
  std::string_view ending;  // of its files: `.tab`
  std::string_view wants;   // for people
  // The file's text. Throws InputError where the curve has no column for it.
  std::string (*text)(const ExportCurve& curve);
};

// All formats; docs/data.md says what each is for.
[[nodiscard]] std::span<const ExportFormat> export_formats();

// afmformats' .tab: force, segment, time and tip position over the press, tip position falling.
[[nodiscard]] std::string afm_tab_text(const ExportCurve& curve);
// Optics11 Chiaro's text in ISO 8859-1, as afmformats' fmt_chiaro_txt reads it.
[[nodiscard]] std::string chiaro_text(const ExportCurve& curve);
// RHEOS: stress, strain and time, without a header, as its exportcsv orders them.
[[nodiscard]] std::string rheos_text(const ExportCurve& curve);
// FEBio's log data: every column but the time as a value of item 1.
[[nodiscard]] std::string febio_log_text(const ExportCurve& curve);
// Every column in SI, units in the names.
[[nodiscard]] std::string csv_si_text(const ExportCurve& curve);

}  // namespace palpate::report
