// A table of results with named columns and rows of numbers and words.
#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/units.h"

namespace palpate::record {

// Missing (an empty field), a number, or a word.
using Cell = std::variant<std::monostate, double, std::string>;

// A number or a word; missing where it is not finite, not there or empty.
[[nodiscard]] inline Cell known(double value) {
  return std::isfinite(value) ? Cell(value) : Cell();
}
[[nodiscard]] inline Cell known(const std::optional<double>& value) {
  return value ? known(*value) : Cell();
}
[[nodiscard]] inline Cell known(std::string_view word) {
  return word.empty() ? Cell() : Cell(std::string(word));
}

struct Table {
  std::vector<std::string> columns;  // a name ends with its unit: `force_N`
  std::vector<std::vector<Cell>> rows;

  // The column's index, or -1.
  [[nodiscard]] int find(std::string_view column) const;
};

// The cell for the text of a swept value: a number if it is written as number_text() writes it,
// otherwise a word.
[[nodiscard]] Cell swept_cell(const std::string& text);

// The column of one swept key: `KEY_UNIT` with numbers if all values are quantities of one
// dimension, `KEY` with numbers if all are pure numbers, otherwise `KEY` with words.
class SweptColumn {
 public:
  explicit SweptColumn(std::string key) : key_(std::move(key)) {}

  // Call see() with every value before name() and cell().
  void see(const Cell& value);

  [[nodiscard]] std::string name() const;
  [[nodiscard]] Cell cell(const Cell& value) const;

 private:
  enum class Kind { unseen, numbers, quantities, words };
  std::string key_;
  Kind kind_ = Kind::unseen;
  const Unit* unit_ = nullptr;
};

// A unit as the last part of a column's name: `kg/m^3` as `kg_per_m3`, `N/mm^n` as `N_per_mm_n`.
[[nodiscard]] std::string unit_word(std::string_view symbol);

}  // namespace palpate::record
