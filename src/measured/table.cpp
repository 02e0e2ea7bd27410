// Finds the first row of numbers and the header above it, and checks the width of every row.
#include "measured/table.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include "base/error.h"
#include "base/index.h"
#include "base/text.h"
#include "measured/columns.h"

namespace palpate::measured {
namespace {

bool says_nothing(const std::string& cell) {
  const std::string text = lower_case(cell);
  for (const char* word : {"", "-", "--", "---", "na", "n/a", "#n/a", "null", "none"})
    if (text == word) return true;
  return false;
}

}  // namespace

std::optional<double> measured_number(std::string_view given, char decimal) {
  const bool plain = !given.empty() && given.find(',') == std::string_view::npos &&
                     (given[0] == '-' || given[0] == '.' || is_digit(given[0]));
  if (plain)
    if (const auto number = leading_number(given); number && number->rest.empty())
      return number->out_of_range ? std::numeric_limits<double>::infinity() : number->value;
  std::string text(given);
  for (std::size_t at = 0; (at = text.find("\u2212")) != std::string::npos;)
    text.replace(at, 3, "-");  // the minus of typesetters
  if (const auto power = text.find_first_of("Dd");
      power != std::string::npos && text.find('.') < power && is_digit(text.back()))
    text[power] = 'e';  // 1.5D+03 of Fortran
  if (says_nothing(text)) return std::numeric_limits<double>::quiet_NaN();
  if (decimal == ',') {
    const std::size_t comma = text.find(',');
    if (text.find('.') != std::string::npos) return std::nullopt;
    if (comma != std::string::npos) {
      // A comma without a digit after it is not a decimal sign.
      if (comma + 1 == text.size() || text[comma + 1] < '0' || text[comma + 1] > '9')
        return std::nullopt;
      text[comma] = '.';
    }
  }
  const auto number = leading_number(text);
  if (!number || !number->rest.empty()) return std::nullopt;
  return number->out_of_range ? std::numeric_limits<double>::infinity() : number->value;
}

namespace {

// Whether at least one field is a unit and the others are units, `-` or empty.
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

// A line that is neither blank nor a comment, divided into fields.
struct TableRow {
  const Line* line = nullptr;
  std::vector<Piece> fields;
  Numbers numbers;     // none in a row of units, in which `-` is a unit
  bool units = false;  // a row of units
};

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

void drop_empty_ends(std::vector<Piece>& fields, std::size_t width) {
  while (fields.size() > width && fields.back().text.empty()) fields.pop_back();
}

std::string plural(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

class Reader {
 public:
  Reader(std::span<const Line> lines, std::vector<TableRow> rows, const std::string& file,
         const Shape& shape)
      : lines_(lines), shape_(shape), rows_(std::move(rows)) {
    table_.file = file;
    table_.decimal = shape.decimal;
  }

  RawTable read() {
    find_start();
    find_width();
    find_header();
    take_rows();
    refuse_pairs();
    return std::move(table_);
  }

 private:
  [[noreturn]] void refuse(int line, int column, const std::string& message) const {
    throw InputError({table_.file, line, column}, message);
  }

  // Whether the table may start at row i. Sureness 0: only numbers, at least two. 1: two numbers
  // here and in the next row, if that has any. 2: likewise with one number.
  [[nodiscard]] bool starts(std::size_t i, int sureness) const {
    const auto fits = [&](const TableRow& row) {
      if (row.fields.size() < 2 || row.numbers.count == 0) return false;
      return sureness == 0 ? row.numbers.all && row.numbers.count >= 2
                           : row.numbers.count >= 3 - sureness;
    };
    if (!fits(rows_[i])) return false;
    if (sureness == 0) return true;
    return i + 1 == rows_.size() || rows_[i + 1].numbers.count == 0 || fits(rows_[i + 1]);
  }

  void find_start() {
    for (const int sureness : {0, 1, 2})
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        if (!starts(i, sureness)) continue;
        start_ = i;
        // Rows with a number directly above belong to it too: a channel started later, or an error.
        while (start_ > 0 && rows_[start_ - 1].numbers.count > 0 &&
               rows_[start_ - 1].fields.size() == rows_[i].fields.size())
          --start_;
        return;
      }
    if (rows_.empty()) refuse(1, 0, "the file is empty; its first row names the columns");
    refuse(rows_.front().line->number, 0,
           "the file contains no row of two numbers; give a table in text, and `--separator`, "
           "`--decimal` or `--skip` if its form is unusual");
  }

  [[nodiscard]] bool headed() const {
    return start_ > 0 && rows_[start_ - 1].numbers.count == 0 &&
           rows_[start_ - 1].line->number + 1 == rows_[start_].line->number;
  }

  // The width is that of the names directly above, or of the widest row, without empty ends.
  void find_width() {
    if (headed() && shape_.separator != ' ') {
      std::vector<Piece> names = rows_[start_ - 1].fields;
      drop_empty_ends(names, 0);
      width_ = names.size();
      if (rows_[start_ - 1].units && start_ > 1) {  // its last cells may be empty
        std::vector<Piece> above = rows_[start_ - 2].fields;
        drop_empty_ends(above, 0);
        width_ = std::max(width_, above.size());
      }
      if (width_ >= 2) return;
    }
    for (std::size_t i = start_; i < rows_.size(); ++i) {
      if (rows_[i].numbers.count == 0) continue;
      std::vector<Piece> fields = rows_[i].fields;
      drop_empty_ends(fields, 0);
      width_ = std::max(width_, fields.size());
    }
  }

  // The fields of a line above the numbers if it has one per column; otherwise nothing.
  std::optional<std::vector<Piece>> heading(const Line& line, const std::string& text,
                                            bool units = false) const {
    std::vector<Piece> fields = pieces_of({line.number, text}, shape_.separator, table_.file);
    drop_empty_ends(fields, width_);
    while ((units || is_units_row(fields)) && fields.size() < width_) fields.push_back({});
    if (fields.size() == width_) return fields;
    if (shape_.separator != ' ') return std::nullopt;
    return aligned_heading(text);
  }

  // Names with blanks above columns separated by blanks: two blanks or a tab separate the names.
  std::optional<std::vector<Piece>> aligned_heading(const std::string& text) const {
    std::vector<Piece> fields;
    std::string word;
    const auto close = [&] {
      if (!trimmed(word).empty()) fields.push_back({trimmed(word), 1});
      word.clear();
    };
    for (std::size_t i = 0; i < text.size(); ++i) {
      const bool apart = text[i] == '\t' || text.compare(i, 2, "  ") == 0;
      if (apart) close();
      word += text[i];
    }
    close();
    if (fields.size() != width_) return std::nullopt;
    return fields;
  }

  static std::vector<std::string> texts(const std::vector<Piece>& fields) {
    std::vector<std::string> words;
    for (const Piece& field : fields) words.push_back(field.text);
    return words;
  }

  void find_header() {
    if (start_ > 0) {
      const TableRow& above = rows_[start_ - 1];
      const auto names = heading(*above.line, above.line->text, above.units);
      if (names && above.numbers.count == 0) {
        const auto higher = start_ > 1 && (above.units || is_units_row(*names))
                                ? heading(*rows_[start_ - 2].line, rows_[start_ - 2].line->text)
                                : std::nullopt;
        if (higher && numbers_in(*higher, shape_.decimal).count == 0) {
          table_.units = texts(*names);
          table_.names = texts(*higher);
          table_.header_line = rows_[start_ - 2].line->number;
        } else {
          table_.names = texts(*names);
          table_.header_line = above.line->number;
          if (is_units_row(*names)) table_.units = table_.names;
        }
        return;
      }
    }
    // The last comment above the numbers with one word per column, as of afmformats and gnuplot.
    for (const Line& line : lines_) {
      if (line.number >= rows_[start_].line->number) break;
      if (!is_comment(line)) continue;
      const std::size_t first = line.text.find_first_not_of(" \t#");
      if (first == std::string::npos) continue;
      const auto names = heading(line, line.text.substr(first));
      if (!names || numbers_in(*names, shape_.decimal).count > 0) continue;
      table_.names = texts(*names);
      table_.header_line = line.number;
    }
  }

  void take_rows() {
    for (std::size_t i = start_; i < rows_.size(); ++i) {
      TableRow& row = rows_[i];
      const int number = row.line->number;
      if (row.numbers.count == 0 && !row.numbers.all && !followed_by_numbers(i)) {
        table_.notes.push_back("the lines from line " + std::to_string(number) +
                               " on contain no numbers and are excluded");
        return;
      }
      drop_empty_ends(row.fields, width_);
      if (row.fields.size() != width_) {
        const std::string said =
            table_.names.empty() ? "the first rows have " : "the header names ";
        const bool twice = shape_.separator == ',' && row.fields.size() == 2 * width_;
        refuse(number, 0,
               "this row has " + plural(row.fields.size(), "field") + ", " + said +
                   std::to_string(width_) +
                   (twice ? "; with decimal commas, separate the columns by semicolons or tabs"
                          : "; give every row one field per column"));
      }
      table_.rows.push_back({number, std::move(row.fields)});
    }
  }

  [[nodiscard]] bool followed_by_numbers(std::size_t i) const {
    for (std::size_t k = i + 1; k < rows_.size(); ++k)
      if (rows_[k].numbers.count > 0) return true;
    return false;
  }

  // Commas as separators and as decimal signs are unambiguous only with quotes around the numbers.
  void refuse_commas() const {
    for (const RawRow& row : table_.rows)
      for (const Piece& field : row.fields)
        if (field.text.find(',') != std::string::npos) return;
    refuse(table_.rows.front().line, 0,
           "commas cannot both separate the columns and mark the decimals; save the table with "
           "semicolons or tabs");
  }

  // `1,234,5,678` without a header may be four whole numbers or two numbers with decimal commas.
  void refuse_pairs() const {
    if (shape_.separator == ',' && shape_.decimal == ',' && shape_.decimal_given) refuse_commas();
    if (shape_.separator != ',' || shape_.separator_given || shape_.decimal_given) return;
    if (!table_.names.empty() || width_ % 2 != 0) return;
    for (const RawRow& row : table_.rows)
      for (std::size_t i = 0; i < width_; ++i) {
        const std::string& text = row.fields[i].text;
        const std::size_t sign = i % 2 == 0 && text.starts_with('-') ? 1 : 0;
        if (text.size() == sign || text.find_first_not_of("0123456789", sign) != std::string::npos)
          return;
      }
    const std::string example =
        table_.rows.front().fields[0].text + "," + table_.rows.front().fields[1].text;
    refuse(table_.rows.front().line, 1,
           "`" + example +
               "` could be two whole numbers or one with a decimal comma; give `--separator ,` for "
               "the first, and save the table with semicolons for the second");
  }

  std::span<const Line> lines_;
  Shape shape_;
  RawTable table_;
  std::vector<TableRow> rows_;
  std::size_t start_ = 0;
  std::size_t width_ = 0;
};

RawTable::Kind kind_of(std::span<const Line> lines) {
  for (const Line& line : lines.first(std::min<std::size_t>(lines.size(), 1000))) {
    if (line.text.starts_with("# BEGIN METADATA")) return RawTable::Kind::afm_tab;
    if (line.text.find("Device:\tChiaro") != std::string::npos) return RawTable::Kind::chiaro;
    if (line.text.starts_with("Interval data:")) return RawTable::Kind::anton_paar;
    if (line.text.starts_with("\"Results Table") || line.text.starts_with("Results Table"))
      return RawTable::Kind::bluehill;
  }
  return RawTable::Kind::plain;
}

std::string lines_text(const std::vector<TableRow>& rows, const Block& block) {
  return "lines " + std::to_string(rows[block.from].line->number) + " to " +
         std::to_string(rows[block.to - 1].line->number);
}

// The rows of a block and its captions: everything since the block before; the last block also
// takes what follows it.
std::vector<TableRow> rows_around(std::vector<TableRow>& rows, const std::vector<Block>& blocks,
                                  std::size_t k) {
  const std::size_t from = k == 0 ? 0 : blocks[k - 1].to;
  const std::size_t to = k + 1 == blocks.size() ? rows.size() : blocks[k].to;
  const auto at = [&](std::size_t i) {
    return std::make_move_iterator(rows.begin() + static_cast<std::ptrdiff_t>(i));
  };
  return {at(from), at(to)};
}

// The main table of the rows: the one asked for, or the longest. Tables with the same names follow
// it as further segments, in a column `segment` that counts from 1; others are excluded.
RawTable main_table(std::span<const Line> lines, std::vector<TableRow> rows,
                    const std::string& file, const Shape& shape, const DataLayout& layout) {
  const std::vector<Block> blocks = blocks_of(rows);
  if (layout.table < 0 || as_index(layout.table) > blocks.size())
    throw InputError({file, 0, 0}, "has " + plural(blocks.size(), "table") + ", and `--table " +
                                       std::to_string(layout.table) + "` is not among them");
  if (blocks.size() < 2) return Reader(lines, std::move(rows), file, shape).read();
  std::size_t main = layout.table > 0 ? as_index(layout.table - 1) : 0;
  for (std::size_t k = 0; layout.table == 0 && k < blocks.size(); ++k)
    if (blocks[k].above(blocks[main])) main = k;
  std::vector<std::string> where;
  for (const Block& block : blocks) where.push_back(lines_text(rows, block));

  std::vector<std::optional<RawTable>> tables(blocks.size());
  tables[main] = Reader(lines, rows_around(rows, blocks, main), file, shape).read();
  RawTable& table = *tables[main];
  std::vector<std::size_t> alike;
  for (std::size_t k = 0; k < blocks.size(); ++k) {
    if (k == main) alike.push_back(k);
    if (k == main || blocks[k].pairs < 2) continue;  // a line of a heading
    try {
      tables[k] = Reader(lines, rows_around(rows, blocks, k), file, shape).read();
    } catch (const InputError&) {  // numbers in a heading
      continue;
    }
    if (!table.names.empty() && tables[k]->names == table.names && layout.table == 0) {
      alike.push_back(k);
    } else if (tables[k]->names.size() == tables[k]->width()) {
      if (layout.table == 0 && 2 * blocks[k].pairs > blocks[main].pairs)
        throw InputError({file, 0, 0}, "contains tables with different columns, on " + where[main] +
                                           " and " + where[k] + "; choose one by `--table " +
                                           std::to_string(main + 1) + "` or `--table " +
                                           std::to_string(k + 1) + "`");
      table.notes.push_back("the table on " + where[k] + " has other columns and is excluded; `" +
                            "--table " + std::to_string(k + 1) + "` reads it");
    }
  }
  if (alike.size() < 2) return std::move(table);
  RawTable merged = std::move(*tables[alike.front()]);
  std::vector<RawRow> all;
  for (std::size_t k = 0; k < alike.size(); ++k) {
    std::vector<RawRow>& from = k == 0 ? merged.rows : tables[alike[k]]->rows;
    for (RawRow& row : from) {
      row.fields.push_back({std::to_string(k + 1), 0});
      all.push_back(std::move(row));
    }
  }
  merged.rows = std::move(all);
  merged.names.emplace_back("segment");
  if (!merged.units.empty()) merged.units.emplace_back();
  merged.tables = alike.size();
  return merged;
}

// LabVIEW's .lvm: headings from `Channels` to `***End_of_Header***`, one before each table, with
// the units of the columns. Takes the headings out of the lines and returns their cells of units
// and of dimensions.
struct LvmCells {
  std::vector<Piece> units, dimensions;
};
LvmCells take_lvm_headings(std::vector<Line>& lines, const std::string& file) {
  LvmCells cells;
  bool heading = true;
  std::erase_if(lines, [&](const Line& line) {
    if (line.text.starts_with("Channels\t")) heading = true;
    if (line.text.starts_with("Y_Unit_Label\t")) cells.units = pieces_of(line, '\t', file);
    if (line.text.starts_with("X_Dimension\t")) cells.dimensions = pieces_of(line, '\t', file);
    const bool ends = line.text.starts_with("***End_of_Header***");
    if (!ends) return heading;
    heading = false;
    return true;
  });
  std::ptrdiff_t tabs = 0;  // of the names; rows without a comment have one less
  for (Line& line : lines) {
    const auto here = std::ranges::count(line.text, '\t');
    if (line.text.starts_with("X_Value\t")) tabs = here;
    if (here > 0 && here < tabs) line.text.append(as_index(tabs - here), '\t');
  }
  return cells;
}

// Gives the columns their units; a column without any value, as of comments, is none.
void finish_lvm(RawTable& table, const LvmCells& cells) {
  const auto cell = [](const std::vector<Piece>& of, std::size_t i) {
    return i < of.size() ? of[i].text : std::string();
  };
  if (table.names.empty()) return;
  table.units.assign(table.width(), "");
  for (std::size_t i = table.width(); i-- > 0;) {
    const bool time = table.names[i] == "X_Value" && cell(cells.dimensions, i + 1) == "Time";
    table.units[i] = time ? "s" : i > 0 ? cell(cells.units, i) : "";
    if (!std::ranges::all_of(table.rows,
                             [&](const RawRow& row) { return row.fields[i].text.empty(); }))
      continue;
    const auto at = static_cast<std::ptrdiff_t>(i);
    table.names.erase(table.names.begin() + at);
    table.units.erase(table.units.begin() + at);
    for (RawRow& row : table.rows) row.fields.erase(row.fields.begin() + at);
  }
}

}  // namespace

RawTable raw_table(std::string_view bytes, const std::string& file, const DataLayout& layout) {
  std::vector<Line> lines = lines_of(bytes, file);
  const std::size_t skipped = as_index(std::max(layout.skip, 0));
  if (skipped > 0 && skipped >= lines.size())
    throw InputError({file, 0, 0}, "has " + plural(lines.size(), "line") + ", and `--skip " +
                                       std::to_string(skipped) + "` leaves none");
  const RawTable::Kind kind = kind_of(lines);
  if (is_febio_log(lines)) return febio_table(lines, file);
  if (is_jpk_text(lines)) return jpk_table(lines, file);
  lines.erase(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(skipped));
  const bool lvm = !lines.empty() && lines.front().text.starts_with("LabVIEW Measurement");
  const LvmCells cells = lvm ? take_lvm_headings(lines, file) : LvmCells();
  const std::span<const Line> kept = lines;
  const Shape shape = shape_of(kept, file, layout);
  RawTable table = main_table(kept, rows_of(kept, shape, file), file, shape, layout);
  table.kind = kind;
  if (lvm) finish_lvm(table, cells);
  return table;
}

}  // namespace palpate::measured
