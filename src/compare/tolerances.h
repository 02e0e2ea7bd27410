// Tolerances of a comparison, per column.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"

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

}  // namespace palpate::compare
