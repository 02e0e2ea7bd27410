// How far two results may differ and still be called equal, column by column.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace palpate::report {

// Numbers are equal where |got - want| <= abs + rel |want|; `abs` is in the column's own unit.
struct Tolerance {
  double rel = 1e-9;
  double abs = 0.0;
  bool ignore = false;
  std::string reason = {};
};

// Rows are not compared one by one: a value is equal where it lies, within its tolerance, between
// the least and the greatest that the other result has within `width` of the same x.
struct Tube {
  std::string x = {};
  double width = 0.0;  // in the column's own unit
};

struct Tolerances {
  Tolerance standard;
  std::map<std::string, Tolerance> columns = {};
  std::optional<Tube> tube = {};

  [[nodiscard]] const Tolerance& of(const std::string& column) const;
};

// Reads `[default] rel, abs` and `[column.NAME] rel, abs, ignore, reason`; what a column does not
// say is as in the default. `[tube] x, width` makes a tube. Throws InputError with every problem at
// file:line:column.
[[nodiscard]] Tolerances parse_tolerances(std::string_view text, const std::string& file);
[[nodiscard]] Tolerances read_tolerances(const std::string& path);

}  // namespace palpate::report
