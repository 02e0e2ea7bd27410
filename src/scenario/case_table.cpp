// Parses rows of a CSV file into the settings of cases.
#include "scenario/case_table.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string_view>

#include "base/text.h"

namespace palpate::scenario {
namespace {

struct Cell {
  std::string text;
  int column = 0;  // of its first byte in the line, from 1
};

// The cells of one line. Throws InputError for a quote that is not closed.
std::vector<Cell> cells_of(std::string_view line, const Place& place) {
  std::vector<Cell> cells;
  std::size_t at = 0;
  while (true) {
    while (at < line.size() && line[at] == ' ') ++at;
    Cell cell{{}, static_cast<int>(at) + 1};
    if (at < line.size() && line[at] == '"') {
      for (++at; at < line.size(); ++at) {
        if (line[at] != '"') {
          cell.text += line[at];
        } else if (at + 1 < line.size() && line[at + 1] == '"') {
          cell.text += line[at++];
        } else {
          break;
        }
      }
      const std::size_t comma = std::min(line.find(',', at), line.size());
      if (at == line.size() || !trimmed(line.substr(at + 1, comma - at - 1)).empty())
        throw InputError({place.file, place.line, cell.column},
                         "a quoted cell does not end before its comma; close it by `\"`, and "
                         "double the quotes inside it");
      at = comma;
    } else {
      const std::size_t comma = std::min(line.find(',', at), line.size());
      cell.text = trimmed(line.substr(at, comma - at));
      at = comma;
    }
    cells.push_back(cell);
    if (at == line.size()) return cells;
    ++at;
  }
}

Node value_of(const std::string& text, const std::string& unit, const Place& place) {
  Node node;
  const auto number = whole_number(text);
  if (number && unit.empty()) {
    const bool digits = text.find_first_not_of("+-0123456789") == std::string::npos;
    node.kind = digits ? Node::Kind::integer : Node::Kind::real;
    node.number = *number;
  } else if (number) {
    node.kind = Node::Kind::text;
    node.text = text + " " + unit;
  } else if (text == "true" || text == "false") {
    node.kind = Node::Kind::boolean;
    node.boolean = text == "true";
  } else if (text.starts_with('[') || text.starts_with('{')) {
    node = parse_assignment("cell=" + text).second;
  } else {
    node.kind = Node::Kind::text;
    node.text = text;
  }
  set_place(node, place);
  return node;
}

// A result contains the table with its files beside it, so the table must not name other folders.
void refuse_folders(const std::string& key, const Node& value) {
  if (value.kind != Node::Kind::text || !names_file(key)) return;
  if (value.text.substr(0, value.text.find('#')).find('/') != std::string::npos)
    throw InputError(value.place, "`" + value.text +
                                      "` lies in another folder, where a copy of this table among "
                                      "results would not find it; put the file beside the scenario "
                                      "and write its bare name");
}

}  // namespace

bool names_file(std::string_view key) {
  const std::string_view last = key.substr(key.rfind('.') + 1);
  return last == "material" || last == "file";
}

std::string value_word(const std::string& key, const Node& value, std::size_t index) {
  const auto holds_more = [](const Node& node) {
    return node.kind == Node::Kind::table || node.kind == Node::Kind::array;
  };
  if (value.kind == Node::Kind::table ||
      std::any_of(value.items.begin(), value.items.end(), holds_more))
    return key.substr(key.rfind('.') + 1) + std::to_string(index + 1);
  if (value.kind == Node::Kind::array && !value.items.empty()) {
    std::vector<std::string> words;
    for (const Node& item : value.items) words.push_back(item.shown());
    const std::set<std::string> different(words.begin(), words.end());
    return different.size() == 1 ? words.front() : joined(words, " x ");
  }
  const std::string shown = value.shown();
  return names_file(key) ? std::filesystem::path(shown).filename().string() : shown;
}

void CommonUnit::add(const Node& value) {
  std::optional<std::string> unit;
  if (value.is_number()) {
    unit = "";
  } else if (value.kind == Node::Kind::text) {
    const std::string text = trimmed(value.text);
    const auto number = leading_number(text);
    if (number && !trimmed(number->rest).empty()) unit = trimmed(number->rest);
  }
  if (!begun_)
    unit_ = unit;
  else if (unit_ != unit)
    unit_.reset();
  begun_ = true;
}

CaseTable::CaseTable(std::string text, std::string path)
    : text_(std::move(text)), path_(std::move(path)) {
  refuse_no_text(text_, path_, "give a CSV file");
  int line = 0;
  std::size_t at = text_.starts_with("\xef\xbb\xbf") ? 3 : 0;  // a byte order mark of spreadsheets
  while (at < text_.size()) {
    const std::size_t end = std::min(text_.find('\n', at), text_.size());
    ++line;
    const Row row{at, line};
    const std::string given = trimmed(std::string_view(text_).substr(at, end - at));
    at = end + 1;
    if (given.empty()) continue;
    if (!columns_.empty()) {
      rows_.push_back(row);
      continue;
    }
    for (const Cell& cell : cells_of(given, {path_, line, 0})) {
      Column column{cell.text, {path_, line, cell.column}, {}, {}};
      const std::size_t open = cell.text.rfind('[');
      if (open != std::string::npos && cell.text.ends_with(']')) {
        column.unit = trimmed(cell.text.substr(open + 1, cell.text.size() - open - 2));
        column.key = trimmed(cell.text.substr(0, open));
      }
      if (column.key.empty())
        throw InputError(column.place,
                         "the header has an empty cell; name a key, as `tissue.young_modulus "
                         "[kPa]`");
      if (column.key.find(';') != std::string::npos || column.key.find('\t') != std::string::npos)
        throw InputError(column.place,
                         "the header has one cell, `" + column.key + "`; separate cells by commas");
      if (std::any_of(columns_.begin(), columns_.end(),
                      [&](const Column& other) { return other.key == column.key; }))
        throw InputError(column.place, "`" + column.key + "` has two columns; keep one of the two");
      columns_.push_back(column);
    }
  }
  if (columns_.empty())
    throw InputError(
        {path_, 1, 1},
        "the file has no header; name a key a column, as `tissue.young_modulus [kPa]`");
  if (rows_.empty())
    throw InputError({path_, line, 1}, "the file has a header alone; add a row for every case");
  std::vector<CommonUnit> units(columns_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const std::vector<Setting> settings = row(i);
    for (std::size_t c = 0; c < columns_.size(); ++c) units[c].add(settings[c].value);
  }
  for (std::size_t c = 0; c < columns_.size(); ++c) columns_[c].common_unit = units[c].unit();
}

std::vector<Setting> CaseTable::row(std::size_t i) const {
  const Row& row = rows_[i];
  const std::size_t end = std::min(text_.find('\n', row.at), text_.size());
  std::string_view line = std::string_view(text_).substr(row.at, end - row.at);
  if (line.ends_with('\r')) line.remove_suffix(1);
  const std::vector<Cell> cells = cells_of(line, {path_, row.line, 0});
  if (cells.size() != columns_.size())
    throw InputError({path_, row.line, cells.back().column},
                     "this row has " + std::to_string(cells.size()) +
                         " cells, and the header has " + std::to_string(columns_.size()) +
                         "; give a value for every column");
  std::vector<Setting> settings;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const Column& column = columns_[c];
    const Place place{path_, row.line, cells[c].column};
    if (cells[c].text.empty())
      throw InputError(place, "`" + column.key + "` has no value here; give one in every row");
    Setting setting{column.key, column.place, value_of(cells[c].text, column.unit, place), {}};
    refuse_folders(setting.key, setting.value);
    setting.word = value_word(setting.key, setting.value, i);
    settings.push_back(setting);
  }
  return settings;
}

}  // namespace palpate::scenario
