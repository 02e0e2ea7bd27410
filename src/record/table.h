// A table of results: named columns, rows of numbers and words.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace palpate::record {

// Nothing (an empty field), a number, or a word.
using Cell = std::variant<std::monostate, double, std::string>;

struct Table {
  std::vector<std::string> columns;  // the unit is the name's last part: `force_N`
  std::vector<std::vector<Cell>> rows;

  // The column's index, or -1.
  [[nodiscard]] int find(std::string_view column) const;
};

}  // namespace palpate::record
