// CSV by RFC 4180 with one addition: a quoted field is a word, even if it looks like a number.
#include "record/csv.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "base/error.h"
#include "base/text.h"

namespace palpate::record {
namespace {

// Whether a word would be read as something else without quotes.
bool needs_quotes(const std::string& word) {
  if (word.empty() || word.find_first_of(",;\t\"\r\n") != std::string::npos) return true;
  if (trimmed(word) != word || word.starts_with("\xEF\xBB\xBF")) return true;
  const auto number = leading_number(word);
  return number && number->rest.empty();
}

std::string field_text(const std::string& word) {
  if (!needs_quotes(word)) return word;
  std::string text = "\"";
  for (const char c : word) {
    if (c == '"') text += c;
    text += c;
  }
  text += '"';
  return text;
}

std::string cell_text(const Cell& cell) {
  if (const auto* number = std::get_if<double>(&cell)) return number_text(*number);
  if (const auto* word = std::get_if<std::string>(&cell)) return field_text(*word);
  return {};
}

struct Field {
  std::string text;
  bool quoted = false;
};

// Splits a CSV text into fields, row by row.
class Scanner {
 public:
  Scanner(std::string_view text, const std::string& file) : text_(text), file_(file) {
    if (text_.starts_with("\xEF\xBB\xBF")) text_.remove_prefix(3);  // byte order mark, as of Excel
  }

  [[nodiscard]] bool at_end() const { return at_ == text_.size(); }
  [[nodiscard]] int line() const { return line_; }

  [[nodiscard]] bool only_blank_left() const { return trimmed(text_.substr(at_)).empty(); }

  [[nodiscard]] std::vector<Field> next_row() {
    std::vector<Field> fields;
    do fields.push_back(next_field());
    while (take(','));
    take('\r');
    if (take('\n')) ++line_;
    return fields;
  }

  [[noreturn]] void refuse(int line, const std::string& message) const {
    throw InputError({file_, line, 0}, message);
  }

 private:
  bool take(char c) {
    if (at_end() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  Field next_field() {
    const std::size_t start = std::min(text_.find_first_not_of(" \t", at_), text_.size());
    if (start < text_.size() && text_[start] == '"') {
      at_ = start;
      return quoted_field();
    }
    const std::size_t end = std::min(text_.find_first_of(",\n", at_), text_.size());
    const std::string field = trimmed(text_.substr(at_, end - at_));
    if (field.find('"') != std::string::npos)
      refuse(line_, "a quote stands inside the field `" + field +
                        "`; put quotes around the whole field and double those inside");
    at_ = end;
    return {field, false};
  }

  Field quoted_field() {
    const int opened = line_;
    ++at_;
    Field field{{}, true};
    while (true) {
      if (at_end()) refuse(opened, "the quote opened on this line is not closed; end it with `\"`");
      const char c = text_[at_++];
      if (c == '"' && !take('"')) break;
      if (c == '\n') ++line_;
      field.text += c;
    }
    while (take(' ') || take('\t')) {
    }
    const bool ends = at_end() || text_[at_] == ',' || text_[at_] == '\n' || text_[at_] == '\r';
    if (!ends)
      refuse(line_, "text follows a closing quote; put a comma between them, or double the quote");
    return field;
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  int line_ = 1;
};

std::vector<std::string> header(Scanner& scanner) {
  const int line = scanner.line();
  const std::vector<Field> fields = scanner.next_row();
  std::vector<std::string> names;
  for (const Field& field : fields) {
    if (field.text.empty())
      scanner.refuse(line, "column " + std::to_string(names.size() + 1) +
                               " has no name; the first row names every column");
    if (std::ranges::find(names, field.text) != names.end())
      scanner.refuse(line, "the column name `" + field.text + "` occurs twice; rename one");
    names.push_back(field.text);
  }
  if (fields.size() == 1 && !fields[0].quoted &&
      fields[0].text.find_first_of(";\t") != std::string::npos)
    scanner.refuse(line, "the columns are not separated by commas; save the table with commas");
  return names;
}

Cell cell(const Scanner& scanner, int line, const Field& field) {
  if (field.quoted) return field.text;
  if (field.text.empty()) return std::monostate{};
  const auto number = leading_number(field.text);
  if (!number || !number->rest.empty()) return field.text;
  if (number->out_of_range) scanner.refuse(line, out_of_range_text(field.text));
  return number->value;
}

}  // namespace

std::string csv_text(const Table& table) {
  assert(!table.columns.empty());
  std::string text;
  for (const std::string& column : table.columns) text += field_text(column) + ",";
  text.back() = '\n';
  for (const std::vector<Cell>& row : table.rows) {
    assert(row.size() == table.columns.size());
    for (const Cell& value : row) text += cell_text(value) + ",";
    text.back() = '\n';
  }
  return text;
}

Table parse_csv(std::string_view text, const std::string& file) {
  Scanner scanner(text, file);
  if (scanner.only_blank_left())
    scanner.refuse(1, "the file is empty; its first row names the columns");
  Table table;
  table.columns = header(scanner);
  const std::size_t width = table.columns.size();
  while (!scanner.at_end()) {
    if (width > 1 && scanner.only_blank_left()) break;
    const int line = scanner.line();
    std::vector<Cell> row;
    for (const Field& field : scanner.next_row()) row.push_back(cell(scanner, line, field));
    if (row.size() != width)
      scanner.refuse(line, "this row has " + std::to_string(row.size()) +
                               " fields, the header names " + std::to_string(width) +
                               "; give every row one field per column");
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table read_csv(const std::string& path) { return parse_csv(read_text(path), path); }

CsvFile::CsvFile(const std::string& path, std::vector<std::string> columns)
    : file_(path), held_{std::move(columns), {}} {}

void CsvFile::add(std::vector<Cell> row) {
  held_.rows.push_back(std::move(row));
  if (held_.rows.size() >= 2000) flush();
}

void CsvFile::flush() {
  const std::string text = csv_text(held_);
  file_.append(std::string_view(text).substr(begun_ ? text.find('\n') + 1 : 0));
  begun_ = true;
  held_.rows.clear();
}

void CsvFile::finish() {
  flush();
  file_.sync();
}

}  // namespace palpate::record
