// Comparison of two tables: which columns differ, and in which row most.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"
#include "record/table.h"

namespace palpate::compare {

// Numbers are equal where |got - want| <= abs + rel |want|; `abs` is in the column's own unit.
struct Tolerance {
  double rel = 1e-9;
  double abs = 0.0;
  bool ignore = false;
  std::string reason = {};
};

// With a tube, rows are not compared one by one: a value is equal if it lies, within its tolerance,
// between the minimum and the maximum of the other result over x - width to x + width.
struct Tube {
  std::string x = {};  // name of the column of x
  double width = 0.0;  // in the unit of that column
};

struct Tolerances {
  Tolerance standard;
  std::map<std::string, Tolerance> columns = {};
  std::optional<Tube> tube = {};
  // Where the file names a column, that of the tube included.
  std::vector<std::pair<std::string, Place>> places = {};

  [[nodiscard]] const Tolerance& of(const std::string& column) const;
};

// Reads TOML with `[default]` and `[column.NAME]` (keys `rel`, `abs`, `ignore`, `reason`; a column
// takes missing keys, except `reason`, from the default) and `[tube]` (keys `x`, `width`). Throws
// InputError with all problems at file:line:column.
[[nodiscard]] Tolerances parse_tolerances(std::string_view text, const std::string& file);
[[nodiscard]] Tolerances read_tolerances(const std::string& path);

// The row with the largest difference relative to the tolerance.
struct WorstRow {
  std::size_t row = 0;         // in GOT, counted from 1 below the header
  std::string case_name = {};  // the row's word in the column `case`; empty without one
  std::string x_name = {};     // the column that tells where the row is; empty if there is none
  record::Cell x = {};
  record::Cell got = {};
  record::Cell want = {};
  double relative =
      0.0;               // |got - want| / |want|; infinite unless both are finite and want is not 0
  double allowed = 0.0;  // tolerance, abs + rel |want|
};

struct ColumnComparison {
  enum class State { compared, ignored, missing, extra };

  std::string name = {};
  State state = State::compared;
  std::size_t differing = 0;           // rows beyond the tolerance
  std::optional<WorstRow> worst = {};  // empty if no row differs at all

  [[nodiscard]] bool equal() const;
};

struct Comparison {
  std::vector<ColumnComparison> columns = {};  // in WANT's order, then those only in GOT
  std::size_t rows_got = 0;
  std::size_t rows_want = 0;
  bool rows_compared = true;  // row by row; false in a tube

  [[nodiscard]] bool rows_equal() const;  // as many rows as wanted, or compared in a tube
  [[nodiscard]] bool equal() const;
};

// Compares row by row, with columns identified by name, in any order. NaN equals NaN, an infinity
// one of the same sign, a missing value a missing one; words must be identical. Missing and extra
// rows and columns are differences, unless the column is ignored. With a tube, see compare.h.
[[nodiscard]] Comparison compare(const record::Table& got, const record::Table& want,
                                 const Tolerances& tolerances);

// One line per difference, a column with its worst row; each line ends with `\n`.
[[nodiscard]] std::string comparison_text(const Comparison& comparison);
// The part of the line after the column's name: what differs, where, and both values.
[[nodiscard]] std::string verdict_text(const ColumnComparison& column);
[[nodiscard]] std::string rows_text(const Comparison& comparison);  // the numbers of rows differ

// The order in which columns are told: first what a curve is drawn of, `force_N`, `strain` and
// `stress_kPa` (0), then its peak and other results of a case (1), then other columns of curves
// (2), then the rest (3), such as the number of nodes or a balance.
[[nodiscard]] int rank_of(const ColumnComparison& column);
inline constexpr int last_result_rank = 2;

// Whether two cells are identical; NaN equals NaN.
[[nodiscard]] bool same(const record::Cell& got, const record::Cell& want);

// A difference of `size` divided by the allowed one, both at least 0: above 1 if, and only if, it
// is beyond the allowed one; infinite beyond an allowed difference of 0.
[[nodiscard]] double excess(double size, double allowed);

// Compares every value of GOT with the range of WANT within the tube's width of the same x, with
// linear interpolation between WANT's rows. If both tables have a column `case`, only rows of the
// same case are compared. Words and non-finite values must be identical to the value of one of the
// rows in the tube or, if there is none, of one of the two rows around it. The `want` of the worst
// row is the nearest value in the range. Both tables have the columns; x rises within a case.
[[nodiscard]] ColumnComparison compare_in_tube(const record::Table& got, const record::Table& want,
                                               const std::string& name,
                                               const Tolerances& tolerances);

// Compares the column of x: both must begin and end within the tube's width of each other.
[[nodiscard]] ColumnComparison compare_ends(const record::Table& got, const record::Table& want,
                                            const Tube& tube);

}  // namespace palpate::compare
