// Measured curves as people have them: two columns of a text file, in SI.
#pragma once

#include <string>
#include <vector>

#include "base/unit_factor.h"

namespace palpate::record {

// What is known of a file; whatever is empty is found out from the file itself.
struct DataLayout {
  std::string x = {};          // a column's name, with or without its unit, or its number from 1
  std::string y = {};          // the same
  std::string x_unit = {};     // `mm`; before what the file says
  std::string y_unit = {};     // the same
  int skip = -1;               // lines before the table; -1: as the file shows
  std::string separator = {};  // `,` `;` `tab` `blank`
  std::string decimal = {};    // `.` or `,`
  std::string compression =
      {};                    // how the load cell reads it: `positive` or empty, `negative`, `auto`
  std::string segment = {};  // `approach`, `retract`, or what the column `segment` or `step` holds
  std::string case_name = {};  // only rows whose column `case` (of FEBio: `item`) says so

  enum class Blanks { leave_out, keep };
  Blanks blanks = Blanks::leave_out;  // keep: rows without a number stay, as NaN
};

struct MeasuredAxis {
  std::string column;     // its name, or its number where the file names none
  std::string unit;       // as read: `um`; empty: a pure number, or none is known
  bool has_unit = false;  // whether the file or the layout says one
  Dimension dimension;
};

struct MeasuredCurve {
  std::string file;
  MeasuredAxis x_axis;
  MeasuredAxis y_axis;
  std::vector<double> x;          // SI; in the order of the file
  std::vector<double> y;          // SI
  std::vector<double> x_written;  // the same in the unit of the axis
  std::vector<double> y_written;
  std::vector<int> lines;          // of the file, one a point
  int left_out = 0;                // rows without two finite numbers
  std::vector<std::string> notes;  // what was decided or left out, in sentences
};

// Reads two columns of a table in text: separated by commas, semicolons, tabs or blanks, decimal
// points or commas, with headers above, units in the names or below them, or no header at all;
// afmformats' .tab, Optics11 Chiaro's text and FEBio's log data by their own rules
// (docs/data.md). Throws InputError with file:line:column and a remedy: no table, no such column
// (and the nearest), a name that stands there twice, a word where a number is wanted, an unknown
// unit, and whatever could be read in two ways.
[[nodiscard]] MeasuredCurve read_measured(const std::string& path, const DataLayout& layout);

// The same of a text; `file` is what places will say.
[[nodiscard]] MeasuredCurve parse_measured(std::string_view bytes, const std::string& file,
                                           const DataLayout& layout);

}  // namespace palpate::record
