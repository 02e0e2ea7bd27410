// Two results side by side: which columns differ, and where most.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "record/table.h"
#include "report/tolerances.h"

namespace palpate::report {

// The row that differs most, in units of what is allowed.
struct WorstRow {
  std::size_t row = 0;  // counted from 1 below the header
  record::Cell got = {};
  record::Cell want = {};
  double relative = 0.0;  // |got - want| / |want|; infinite between a number and anything else
  double allowed = 0.0;   // abs + rel |want|
};

struct ColumnComparison {
  enum class State { compared, ignored, missing, extra };

  std::string name = {};
  State state = State::compared;
  std::size_t differing = 0;           // rows beyond the tolerance
  std::optional<WorstRow> worst = {};  // empty where every row is exactly the same

  [[nodiscard]] bool equal() const;
};

struct Comparison {
  std::vector<ColumnComparison> columns = {};  // WANT's order, then what GOT has besides
  std::size_t rows_got = 0;
  std::size_t rows_want = 0;
  bool rows_compared = true;  // one by one; not in a tube

  [[nodiscard]] bool equal() const;
};

// Compares row by row, columns by name in any order. NaN equals NaN, infinities of one sign are
// equal, nothing equals nothing, words are equal letter by letter. Missing and extra rows and
// columns are differences, unless the column is ignored. With a tube, see tube.h.
[[nodiscard]] Comparison compare(const record::Table& got, const record::Table& want,
                                 const Tolerances& tolerances);

// One line a column, the worst row named; `\n` at the end of each.
[[nodiscard]] std::string comparison_text(const Comparison& comparison);

}  // namespace palpate::report
