// Which columns and rows of a measured table are meant.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "record/measured_table.h"
#include "record/measured_unit.h"

namespace palpate::record {

struct Column {
  std::size_t index = 0;
  std::string name;                 // as the file names it, or its number
  std::optional<WrittenUnit> unit;  // where the layout or the file says one
  bool falls = false;               // a height: it falls as the tip goes in
};

enum class Role { x, y };

// The column of a name (with or without its unit) or a number from 1; where `wanted` is empty, the
// one that the format or the units leave for the role. `unit` goes before the file's own. Throws
// InputError: no such column (and the nearest), two of the name, an unknown unit, no telling.
[[nodiscard]] Column find_column(const RawTable& table, const std::string& wanted,
                                 const std::string& unit, Role role);

struct Rows {
  std::vector<std::size_t> kept;  // rows of the table, in order
  std::vector<std::string> notes;
};

// The rows of the layout's case and segment; without a column of segments, the approach ends at the
// row of the largest load (as afmformats parts Chiaro's curves).
[[nodiscard]] Rows chosen_rows(const RawTable& table, const DataLayout& layout, const Column& y);

}  // namespace palpate::record
