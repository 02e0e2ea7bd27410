// A table of results with named columns and rows of numbers and words.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace palpate::record {

// Missing (an empty field), a number, or a word.
using Cell = std::variant<std::monostate, double, std::string>;

struct Table {
  std::vector<std::string> columns;  // a name ends with its unit: `force_N`
  std::vector<std::vector<Cell>> rows;

  // The column's index, or -1.
  [[nodiscard]] int find(std::string_view column) const;
};

}  // namespace palpate::record
