// Rows of a file in text, and the tables into which words between them divide it.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "measured/shape.h"
#include "measured/text.h"

namespace palpate::measured {

// A line that is neither blank nor a comment, divided into fields.
struct TableRow {
  const Line* line = nullptr;
  std::vector<Piece> fields;
  Numbers numbers;     // none in a row of units, in which `-` is a unit
  bool units = false;  // a row of units
};
[[nodiscard]] std::vector<TableRow> rows_of(std::span<const Line> lines, const Shape& shape,
                                            const std::string& file);

// Whether at least one field is a unit and the others are units, `-` or empty.
[[nodiscard]] bool is_units_row(std::span<const Piece> fields);

// Neighbouring rows with numbers, [from, to).
struct Block {
  std::size_t from = 0, to = 0;
  std::size_t pairs = 0;  // rows with at least two numbers
  std::size_t whole = 0;  // rows of nothing but numbers, at least two

  // Whether this block is more of a table than the other.
  [[nodiscard]] bool above(const Block& other) const {
    return std::pair(pairs, whole) > std::pair(other.pairs, other.whole);
  }
};
[[nodiscard]] std::vector<Block> blocks_of(std::span<const TableRow> rows);

}  // namespace palpate::measured
