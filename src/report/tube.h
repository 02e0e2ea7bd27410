// A column of one result in a tube about that of another: for times that are shifted.
#pragma once

#include <string>

#include "report/compare.h"

namespace palpate::report {

// Every value of GOT against what WANT has within the tube's width of the same x, along straight
// lines between its rows, of the same `case` where both tables have that column; the rows of a case
// stand by rising x. Words and what is not finite are to be the same as in one of those rows, or,
// where the tube holds none, as in one of the two around it. The worst row's `want` is the nearest
// value that would have been equal. Both have the columns.
[[nodiscard]] ColumnComparison compare_in_tube(const record::Table& got, const record::Table& want,
                                               const std::string& name,
                                               const Tolerances& tolerances);

// The column of x itself: whether both begin and end within the tube's width of each other.
[[nodiscard]] ColumnComparison compare_ends(const record::Table& got, const record::Table& want,
                                            const Tube& tube);

}  // namespace palpate::report
