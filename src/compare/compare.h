// Comparison of two tables: which columns differ, and in which row most.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "compare/tolerances.h"
#include "record/table.h"

namespace palpate::compare {

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
// rows and columns are differences, unless the column is ignored. With a tube, see tube.h.
[[nodiscard]] Comparison compare(const record::Table& got, const record::Table& want,
                                 const Tolerances& tolerances);

// Which columns a text lists: all of them, or those that differ.
enum class Show { all, differing };

// One line per column with its worst row; each line ends with `\n`.
[[nodiscard]] std::string comparison_text(const Comparison& comparison, Show show = Show::all);
// The part of the line after the column's name: what differs, where, and both values.
[[nodiscard]] std::string verdict_text(const ColumnComparison& column);
[[nodiscard]] std::string rows_text(const Comparison& comparison);  // the numbers of rows differ

}  // namespace palpate::compare
