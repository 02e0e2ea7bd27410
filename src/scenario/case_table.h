// Cases from a CSV file: one column per key, one row per case.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/document.h"

namespace palpate::scenario {

// The value of one key in one case, as if it were written in the document.
struct Setting {
  std::string key;   // dotted path
  Place place;       // of the key in [sweep] or in the CSV's header
  Node value;        // with a place of its own
  std::string word;  // for the case's name and `swept`: the value as written, without folders
};

// Whether the value of a key, given as a dotted path or its last word, may name a file.
[[nodiscard]] bool names_file(std::string_view key);

// The word for a swept value: files without their folder, lists as `3 x 4 x 6` or the one value
// that they repeat, tables as their number in the list (from 1; `index` is counted from 0).
[[nodiscard]] std::string value_word(const std::string& key, const Node& value, std::size_t index);

// Finds the unit that all added values are written in; see Varied::unit.
class CommonUnit {
 public:
  void add(const Node& value);
  [[nodiscard]] const std::optional<std::string>& unit() const { return unit_; }

 private:
  std::optional<std::string> unit_;
  bool begun_ = false;
};

// Keeps the text of the file and parses a row when it is requested, so that a million rows need no
// more memory than their file.
class CaseTable {
 public:
  struct Column {
    std::string key;
    Place place;
    std::string unit;                        // from the header, `key [unit]`; may be empty
    std::optional<std::string> common_unit;  // of all rows; see Varied::unit
  };

  CaseTable() = default;

  // `path` names the file in messages. Header cells are `key` or `key [unit]`; cells are separated
  // by commas, and quoted by RFC 4180 if they contain one. Throws InputError, with the place of the
  // cell, for rows of different length, empty cells, repeated columns, a file without rows, and a
  // file that is not text.
  CaseTable(std::string text, std::string path);

  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] const std::vector<Column>& columns() const { return columns_; }
  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const std::string& path() const { return path_; }

  // The settings of row i < size(), from 0. Cells are numbers, `true` or `false`, TOML if they
  // begin with `[` or `{`, and otherwise texts; a number below a unit in the header becomes a text.
  [[nodiscard]] std::vector<Setting> row(std::size_t i) const;

 private:
  struct Row {
    std::size_t at = 0;  // position of its first byte
    int line = 0;
  };

  std::string text_;
  std::string path_;
  std::vector<Column> columns_;
  std::vector<Row> rows_;
};

}  // namespace palpate::scenario
