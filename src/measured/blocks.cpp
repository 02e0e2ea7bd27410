// Divides lines into rows, and rows into tables.
#include "measured/blocks.h"

#include <algorithm>

#include "measured/table.h"
#include "measured/unit.h"

namespace palpate::measured {

bool is_units_row(std::span<const Piece> fields) {
  bool any = false;
  for (const Piece& field : fields) {
    const std::string& text = field.text;
    if (text.empty() || text == "-" || text == "[-]" || text == "(-)" || text == "[1]") continue;
    if (measured_number(text, '.') || !is_unit_word(text)) return false;
    any = true;
  }
  return any;
}

std::vector<TableRow> rows_of(std::span<const Line> lines, const Shape& shape,
                              const std::string& file) {
  std::vector<TableRow> rows;
  rows.reserve(lines.size());
  for (const Line& line : lines) {
    if (is_blank(line) || is_comment(line)) continue;
    TableRow row{&line, pieces_of(line, shape.separator, file), {}, false};
    row.numbers = numbers_in(row.fields, shape.decimal);
    row.units = !row.numbers.all && is_units_row(row.fields);
    if (row.units) row.numbers = {0, false};
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<Block> blocks_of(std::span<const TableRow> rows) {
  std::vector<Block> blocks;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].numbers.count == 0 && !rows[i].numbers.all) continue;
    const bool follows = !blocks.empty() && blocks.back().to == i;
    // Words with numbers, in another number of fields, are a heading: `Interval: 2 10`.
    if (follows && !rows[i].numbers.all && rows[i].fields.size() != rows[i - 1].fields.size() &&
        rows[i].fields.size() > 1)
      continue;
    if (!follows) blocks.push_back({i, i});
    Block& block = blocks.back();
    block.to = i + 1;
    if (rows[i].numbers.count >= 2) ++block.pairs;
    if (rows[i].numbers.count >= 2 && rows[i].numbers.all) ++block.whole;
  }
  return blocks;
}

}  // namespace palpate::measured
