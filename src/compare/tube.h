// Comparison of a column with a tube around that of another result, for results shifted in time.
#pragma once

#include <string>

#include "compare/compare.h"

namespace palpate::compare {

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
