// Selection of the columns and rows of a measured table.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "measured/table.h"
#include "measured/unit.h"

namespace palpate::measured {

struct Column {
  std::size_t index = 0;
  std::string name;                 // as in the file, or its number from 1
  std::optional<WrittenUnit> unit;  // from the layout or the file; empty if neither has one
  bool falls = false;               // a height, which decreases as the tip goes in
};

enum class Role { x, y };

// The layout's x or y: the column of that name (with or without its unit) or number (from 1), in
// its unit, which takes precedence over the file's. Without a name the format, the position or the
// units determine the column. Throws InputError for an unknown column (with the nearest name), a
// name that occurs twice, an unknown unit, and if no column can be determined.
[[nodiscard]] Column find_column(const RawTable& table, const DataLayout& layout, Role role);

// Columns with the name `word`; if there are none, ignoring case; then ignoring case and unit.
[[nodiscard]] std::vector<std::size_t> columns_named(const RawTable& table,
                                                     const std::string& word);

// The only column of that name or number; `asked` is the option, for messages. Throws InputError.
[[nodiscard]] std::size_t named_index(const RawTable& table, const std::string& word,
                                      const std::string& asked);

// Why a cell holds no number, with the remedy: "which is a time of day ...; write ...".
[[nodiscard]] std::string why_no_number(const std::string& text);

// The unit that the file gives to a column.
[[nodiscard]] std::optional<WrittenUnit> file_unit(const RawTable& table, std::size_t index);

struct Rows {
  std::vector<std::size_t> kept;  // rows of the table, in order
  std::vector<std::string> notes;
};

// The rows of the layout's case, segment, `where` and `rows`; InputError if there are none, if a
// segment's name stands for several parts of the curve (`NAME:2` is the second of them), and if the
// file has several tables of the same columns of which none is chosen. Without a column of segments
// the approach ends at the largest change of load (as afmformats divides Chiaro's curves).
// Without a choice, a force over a length has the rows of its approach alone where a column of
// words such as `extend` and `retract` divides it.
struct Axes {
  const Column& x;
  const Column& y;
};
[[nodiscard]] Rows chosen_rows(const RawTable& table, const DataLayout& layout, const Axes& axes);

// Whether a load over a length is that of a retract alone, whose rest is its last row: the length
// goes one way only, the load is larger at its beginning than at its end, and half-way to its
// largest change more than half of that change is over.
[[nodiscard]] bool only_retracts(std::span<const double> x, std::span<const double> load);

}  // namespace palpate::measured
