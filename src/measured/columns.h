// Selection of the columns and rows of a measured table, and the unit in the name of a column:
// `Load (uN)`, `force_N`, `Weg in mm`, `Kraft / N`.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/units.h"
#include "measured/table.h"

namespace palpate::measured {

inline constexpr Dimension length{1, 0, 0};
inline constexpr Dimension force{1, 1, -2};
inline constexpr Dimension time{0, 0, 1};
inline constexpr Dimension stress{-1, 1, -2};

struct WrittenUnit {
  std::string text;  // palpate's spelling: `um` for `µm` and `micron`; empty if dimensionless
  UnitFactor factor;
};

// A unit as instruments write it: the units of unit_factor and words such as `sec`, `Newton`,
// `micron`, `%`, `gF`, `lbF`, `in`, `psi`, `mmHg`, `Angstrom`, with or without brackets of any
// kind. Nothing if the text is not a unit.
[[nodiscard]] std::optional<WrittenUnit> written_unit(std::string_view text);

// The unit of a column of that name: grams below a force are gram-force, and seconds below a rate
// 1/s.
[[nodiscard]] WrittenUnit unit_under(const std::string& name, const WrittenUnit& unit);
[[nodiscard]] bool is_mass(const WrittenUnit& unit);

// Whether a name stands for a stretch, length over initial length: `stretch`, `lambda`.
[[nodiscard]] bool is_stretch(std::string_view name);

// Whether a cell of a row of units names a unit, of any quantity: also `degC`, `V`, `rad`.
[[nodiscard]] bool is_unit_word(std::string_view text);

struct NamedColumn {
  std::string bare;                 // the name without its unit: `Load`, `force`
  std::optional<WrittenUnit> unit;  // if the name ends with one
};
[[nodiscard]] NamedColumn named_column(std::string_view name);

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
