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

namespace {

// Whether a row may be one of units below a row of names: a unit at least, no number, at least half
// of the cells units, in brackets, `-` or empty, and the others short words.
bool may_be_units(std::span<const Piece> fields) {
  std::size_t units = 0;
  std::size_t silent = 0;
  for (const Piece& field : fields) {
    const std::string& text = field.text;
    if (text.empty() || text == "-" || text == "[-]" || text == "(-)") {
      ++silent;
      continue;
    }
    if (measured_number(text, '.') || text.size() > 16) return false;
    const bool brackets = (text.starts_with('[') && text.ends_with(']')) ||
                          (text.starts_with('(') && text.ends_with(')'));
    if (brackets || is_unit_word(text)) ++units;
  }
  return units > 0 && 2 * (units + silent) >= fields.size();
}

}  // namespace

std::vector<TableRow> rows_of(std::span<const Line> lines, const Shape& shape,
                              const std::string& file) {
  std::vector<TableRow> rows;
  rows.reserve(lines.size());
  for (const Line& line : lines) {
    if (is_blank(line) || is_comment(line)) continue;
    TableRow row{&line, pieces_of(line, shape.separator, file), {}, false};
    row.numbers = numbers_in(row.fields, shape.decimal);
    const bool below_names = !rows.empty() && rows.back().numbers.count == 0 &&
                             !rows.back().units && rows.back().line->number + 1 == line.number &&
                             rows.back().fields.size() >= row.fields.size() &&
                             row.fields.size() >= 2;
    row.units =
        !row.numbers.all && (is_units_row(row.fields) || (below_names && may_be_units(row.fields)));
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
