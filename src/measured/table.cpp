// Finds the first row of numbers and the header above it, and checks the width of every row.
#include "measured/table.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "base/error.h"
#include "base/index.h"
#include "base/text.h"
#include "measured/shape.h"
#include "measured/unit.h"

namespace palpate::measured {
namespace {

bool says_nothing(const std::string& cell) {
  const std::string text = lower_case(cell);
  for (const char* word : {"", "-", "--", "na", "n/a", "#n/a", "null", "none"})
    if (text == word) return true;
  return false;
}

}  // namespace

std::optional<double> measured_number(std::string_view given, char decimal) {
  std::string text(given);
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

// A line that is neither blank nor a comment, divided into fields.
struct Row {
  const Line* line = nullptr;
  std::vector<Piece> fields;
  Numbers numbers;
};

void drop_empty_ends(std::vector<Piece>& fields, std::size_t width) {
  while (fields.size() > width && fields.back().text.empty()) fields.pop_back();
}

std::string plural(std::size_t count, const std::string& noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

class Reader {
 public:
  Reader(std::span<const Line> lines, const std::string& file, const Shape& shape)
      : lines_(lines), shape_(shape) {
    table_.file = file;
    table_.decimal = shape.decimal;
    for (const Line& line : lines) {
      if (is_blank(line) || is_comment(line)) continue;
      Row row{&line, pieces_of(line, shape.separator, file), {}};
      row.numbers = numbers_in(row.fields, shape.decimal);
      rows_.push_back(std::move(row));
    }
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
    const auto fits = [&](const Row& row) {
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
  std::optional<std::vector<Piece>> heading(const Line& line, const std::string& text) const {
    std::vector<Piece> fields = pieces_of({line.number, text}, shape_.separator, table_.file);
    drop_empty_ends(fields, width_);
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

  static bool all_units(const std::vector<Piece>& fields) {
    bool any = false;
    for (const Piece& field : fields) {
      if (field.text.empty()) continue;
      if (!written_unit(field.text)) return false;
      any = true;
    }
    return any;
  }

  static std::vector<std::string> texts(const std::vector<Piece>& fields) {
    std::vector<std::string> words;
    for (const Piece& field : fields) words.push_back(field.text);
    return words;
  }

  void find_header() {
    if (start_ > 0) {
      const Row& above = rows_[start_ - 1];
      const auto names = heading(*above.line, above.line->text);
      if (names && above.numbers.count == 0) {
        const auto higher = start_ > 1 && all_units(*names)
                                ? heading(*rows_[start_ - 2].line, rows_[start_ - 2].line->text)
                                : std::nullopt;
        if (higher && numbers_in(*higher, shape_.decimal).count == 0) {
          table_.units = texts(*names);
          table_.names = texts(*higher);
          table_.header_line = rows_[start_ - 2].line->number;
        } else {
          table_.names = texts(*names);
          table_.header_line = above.line->number;
          if (all_units(*names)) table_.units = table_.names;
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
      Row& row = rows_[i];
      const int number = row.line->number;
      if (row.numbers.count == 0 && !row.numbers.all && !followed_by_numbers(i)) {
        table_.notes.push_back("the lines from line " + std::to_string(number) +
                               " on contain no numbers and are left out");
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
               "` could be two whole numbers or one with a decimal comma; give "
               "`--separator ,` for the first, and save the table with semicolons for "
               "the second");
  }

  std::span<const Line> lines_;
  Shape shape_;
  RawTable table_;
  std::vector<Row> rows_;
  std::size_t start_ = 0;
  std::size_t width_ = 0;
};

RawTable::Kind kind_of(std::span<const Line> lines) {
  for (const Line& line : lines) {
    if (line.text.starts_with("# BEGIN METADATA")) return RawTable::Kind::afm_tab;
    if (line.text.find("Device:\tChiaro") != std::string::npos) return RawTable::Kind::chiaro;
  }
  return RawTable::Kind::plain;
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
  const std::span<const Line> kept = std::span<const Line>(lines).subspan(skipped);
  RawTable table = Reader(kept, file, shape_of(kept, file, layout)).read();
  table.kind = kind;
  return table;
}

}  // namespace palpate::measured
