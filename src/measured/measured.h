// Reads a measured curve: two columns of a text file, converted to SI units.
#pragma once

#include <string>
#include <vector>

#include "base/units.h"

namespace palpate::measured {

// The user's description of a file; empty members are determined from the file itself.
struct DataLayout {
  std::string x = {};            // a column's name, with or without its unit, or its number from 1
  std::string y = {};            // likewise
  std::string x_unit = {};       // such as `mm`; takes precedence over the file
  std::string y_unit = {};       // likewise
  int skip = -1;                 // lines to skip; the table begins there or below
  std::string separator = {};    // `,` `;` `tab` `blank`
  std::string decimal = {};      // `.` or `,`
  std::string compression = {};  // sign of the load: `positive` or empty, `negative`, `auto`
  std::string segment = {};  // `approach`, `retract`, or a value of the column `segment` or `step`
  std::string usual = "approach";  // the segment of a force over a length where none is chosen
  std::vector<std::string> beside = {};  // further columns to read from the same rows
  std::string case_name = {};  // only rows with this value in the column `case` (FEBio: `item`)

  enum class Curve { press, relaxation, creep };
  Curve curve = Curve::press;  // what x and y are where no column is chosen

  enum class Blanks { leave_out, keep };
  Blanks blanks = Blanks::leave_out;    // `keep` keeps rows without a number, as NaN
  std::vector<std::string> where = {};  // COLUMN=VALUE: only rows with this value
  std::string rows = {};                // A..B: only these rows of the table, from 1
  std::string spring_constant = {};     // of a cantilever: depth = x - force / it
  std::string compliance = {};          // of a machine: depth = x - force times it
  std::string drift = {};               // column of times: a drift of y is taken off
  int table = 0;                        // of several in the file, from 1; 0: the longest
};

struct MeasuredAxis {
  std::string column;     // its name or, if it has none, its number
  std::string unit;       // such as `um`; empty if dimensionless or unknown
  bool has_unit = false;  // whether the file or the layout gives a unit
  Dimension dimension;
  bool stretch = false;  // a ratio of lengths by its name: strain + 1
  bool mass = false;     // a unit of mass, which is no force until its weight is meant
};

struct MeasuredColumn {
  MeasuredAxis axis;
  std::vector<double> values;  // SI
};

struct MeasuredCurve {
  std::string file;
  MeasuredAxis x_axis;
  MeasuredAxis y_axis;
  std::vector<double> x;          // SI, in the order of the file
  std::vector<double> y;          // SI
  std::vector<double> x_written;  // the same in the unit of the axis
  std::vector<double> y_written;
  std::vector<MeasuredColumn> beside;  // in the order of the layout
  std::vector<int> lines;              // line numbers of the points in the file
  bool guessed = false;                // a column was not named, and the table has more than two
  int excluded = 0;                    // number of rows without two finite numbers
  double bending = 0.0;                // m/N of a cantilever, which is taken off x
  std::vector<std::string> notes;      // sentences on what was decided or excluded
};

// Reads two columns of a table in text, separated by commas, semicolons, tabs or blanks, with
// decimal points or commas, with or without a header, with units in the names or below them.
// A drift is a straight line over time between the means of y at both ends of the record, where x
// is within a tenth of its range of its first and its last value. afmformats' .tab, Optics11
// Chiaro's text and FEBio's log data have special rules (docs/data.md). Throws InputError with
// file:line:column and a remedy for a missing table or column, a name that occurs twice, a word
// instead of a number, an unknown unit, and everything that is ambiguous.
[[nodiscard]] MeasuredCurve read_measured(const std::string& path, const DataLayout& layout);

// The same for a text; `file` is its name in messages.
[[nodiscard]] MeasuredCurve parse_measured(std::string_view bytes, const std::string& file,
                                           const DataLayout& layout);

}  // namespace palpate::measured
