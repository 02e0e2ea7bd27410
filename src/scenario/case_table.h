// Cases from a CSV file: a column a key, a row a case.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/document.h"

namespace palpate::scenario {

// One key of one case, as if it stood in the document.
struct Setting {
  std::string key;   // dotted path
  Place place;       // of the key in [sweep] or in the CSV's header
  Node value;        // with its own place
  std::string word;  // in the case's name and in `swept`: the value as written, without folders
};

// A swept value as a word: files without their folder, lists as `3 x 4 x 6` or the one value that
// they repeat, tables by their number in the list, counted from `index` = 0.
[[nodiscard]] std::string value_word(const std::string& key, const Node& value, std::size_t index);

// The unit that all values are written in; see Varied::unit.
class CommonUnit {
 public:
  void add(const Node& value);
  [[nodiscard]] const std::optional<std::string>& unit() const { return unit_; }

 private:
  std::optional<std::string> unit_;
  bool begun_ = false;
};

// The file's text is kept and a row is read when it is asked for: a million rows are as large as
// their file.
class CaseTable {
 public:
  struct Column {
    std::string key;
    Place place;
    std::string unit;                        // of the header, `key [unit]`; may be empty
    std::optional<std::string> common_unit;  // of all rows
  };

  CaseTable() = default;

  // `path` names the file in messages. Header cells are `key` or `key [unit]`; cells are separated
  // by commas, and quoted as RFC 4180 says where they hold one. Throws InputError, at the cell, for
  // rows of another length, empty cells, repeated columns, a file without rows and one that is no
  // text.
  CaseTable(std::string text, std::string path);

  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] const std::vector<Column>& columns() const { return columns_; }
  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const std::string& path() const { return path_; }

  // Row i < size(), from 0. Numbers are numbers, `true` and `false` truth values, what begins with
  // `[` or `{` is TOML, and everything else is a text, with the column's unit after a number.
  [[nodiscard]] std::vector<Setting> row(std::size_t i) const;

 private:
  struct Row {
    std::size_t at = 0;  // of its first byte
    int line = 0;
  };

  std::string text_;
  std::string path_;
  std::vector<Column> columns_;
  std::vector<Row> rows_;
};

}  // namespace palpate::scenario
