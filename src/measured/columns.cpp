// Finds columns by name, number or dimension, and rows by case and segment.
#include "measured/columns.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/index.h"
#include "base/text.h"

namespace palpate::measured {
namespace {

std::string option(Role role) { return role == Role::x ? "--x" : "--y"; }

// The names of all columns; for a column without a name, its number.
std::vector<std::string> names_of(const RawTable& table) {
  std::vector<std::string> names = table.names;
  names.resize(table.width());
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i].empty()) names[i] = std::to_string(i + 1);
  return names;
}

// Columns with the name `word`; if there are none, ignoring case; then ignoring case and unit.
std::vector<std::size_t> matches(const RawTable& table, const std::string& word) {
  std::vector<std::size_t> found;
  const auto look = [&](const auto& is_it) {
    if (!found.empty()) return;
    for (std::size_t i = 0; i < table.names.size(); ++i)
      if (is_it(table.names[i])) found.push_back(i);
  };
  look([&](const std::string& name) { return name == word; });
  look([&](const std::string& name) { return lower_case(name) == lower_case(word); });
  look([&](const std::string& name) {
    return lower_case(named_column(name).bare) == lower_case(word);
  });
  return found;
}

std::optional<WrittenUnit> file_unit(const RawTable& table, std::size_t index) {
  // All columns of afmformats' files are in SI units: its afm_data.py, column_units.
  const std::string name = index < table.names.size() ? table.names[index] : std::string();
  if (table.kind == RawTable::Kind::afm_tab) {
    if (name == "force") return written_unit("N");
    if (name == "time") return written_unit("s");
    if (name == "tip position" || name.starts_with("height (")) return written_unit("m");
  }
  if (index < table.units.size() && !table.units[index].empty())
    return written_unit(table.units[index]);
  return named_column(name).unit;
}

Column column_at(const RawTable& table, std::size_t index, const std::string& unit, Role role) {
  Column column;
  column.index = index;
  column.name = names_of(table)[index];
  column.unit = file_unit(table, index);
  column.falls = table.kind == RawTable::Kind::afm_tab &&
                 (column.name == "tip position" || column.name.starts_with("height ("));
  if (unit.empty()) return column;
  column.unit = written_unit(unit);
  if (!column.unit)
    throw InputError({}, "palpate: `" + option(role) + "-unit " + unit +
                             "` is no unit; write it as `mm`, `uN`, `kPa` or `1`");
  return column;
}

// The column for a role without a given name: the format's usual one, the first (x) or second (y)
// of two columns, or the only length (x) or force (y).
std::size_t only_column(const RawTable& table, Role role) {
  const std::vector<std::string> names = names_of(table);
  const auto named = [&](std::string_view name) {
    return as_index(std::find(names.begin(), names.end(), name) - names.begin());
  };
  const std::vector<std::string> usual =
      table.kind == RawTable::Kind::afm_tab
          ? (role == Role::x ? std::vector<std::string>{"tip position", "height (measured)"}
                             : std::vector<std::string>{"force"})
          : (role == Role::x ? std::vector<std::string>{"Indentation (nm)"}
                             : std::vector<std::string>{"Load (uN)"});
  if (table.kind == RawTable::Kind::afm_tab || table.kind == RawTable::Kind::chiaro)
    for (const std::string& name : usual)
      if (named(name) < names.size()) return named(name);
  if (names.size() == 2) return role == Role::x ? 0 : 1;
  std::vector<std::size_t> fitting;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (const auto unit = file_unit(table, i);
        unit && unit->factor.dimension == (role == Role::x ? length : force))
      fitting.push_back(i);
  if (fitting.size() == 1) return fitting.front();
  throw InputError({table.file, table.header_line, 0},
                   "has " + std::to_string(names.size()) +
                       " columns, and it is not clear which is " + (role == Role::x ? "x" : "y") +
                       "; set `" + option(role) + "` to one of " + joined(names, ", "));
}

std::size_t named_index(const RawTable& table, const std::string& word, const std::string& asked) {
  const std::vector<std::size_t> found = matches(table, word);
  if (found.size() == 1) return found.front();
  if (found.size() > 1)
    throw InputError({table.file, table.header_line, 0},
                     "the column name `" + word + "` occurs twice, as columns " +
                         std::to_string(found[0] + 1) + " and " + std::to_string(found[1] + 1) +
                         "; give its number, as `" + asked + " " + std::to_string(found[0] + 1) +
                         "`");
  const bool digits = word.find_first_not_of("0123456789") == std::string::npos;
  if (digits && word.size() < 7) {
    const auto number = as_index(std::stoi(word));
    if (number >= 1 && number <= table.width()) return number - 1;
    throw InputError({table.file, table.header_line, 0},
                     "has " + std::to_string(table.width()) + " columns, and `" + asked + " " +
                         word + "` is not among them; columns count from 1");
  }
  if (table.names.empty())
    throw InputError({table.file, table.rows.front().line, 0},
                     "the numbers begin here without names of columns above, so that there is no "
                     "column `" +
                         word + "`; give a column's number, as `" + asked +
                         " 1`, or `--skip` the lines above the names");
  const auto near = nearest(word, table.names);
  throw InputError({table.file, table.header_line, 0},
                   "has no column `" + word + "`" +
                       (near ? "; did you mean `" + *near + "`?"
                             : "; columns: " + joined(names_of(table), ", ")));
}

}  // namespace

Column find_column(const RawTable& table, const std::string& wanted, const std::string& unit,
                   Role role) {
  const std::size_t index =
      wanted.empty() ? only_column(table, role) : named_index(table, wanted, option(role));
  return column_at(table, index, unit, role);
}

namespace {

// Whether a cell names the segment: the same word or number, or afmformats' number for it.
bool is_segment(const std::string& cell, const std::string& wanted) {
  const std::string held = lower_case(cell);
  const std::string asked = lower_case(wanted);
  if (held == asked) return true;
  if (asked == "approach") return held == "0" || held == "false";
  if (asked == "retract") return held == "1" || held == "true";
  const auto a = whole_number(held);
  const auto b = whole_number(asked);
  return a && b && *a == *b;
}

std::vector<std::string> values_in(const RawTable& table, const std::vector<std::size_t>& rows,
                                   std::size_t column) {
  std::vector<std::string> values;
  for (const std::size_t i : rows) {
    const std::string& value = table.rows[i].fields[column].text;
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
  }
  return values;
}

using Same = bool (*)(const std::string&, const std::string&);

void keep_only(const RawTable& table, Rows& rows, std::size_t column, const std::string& wanted,
               Same same) {
  const std::vector<std::string> known = values_in(table, rows.kept, column);
  std::erase_if(rows.kept,
                [&](std::size_t i) { return !same(table.rows[i].fields[column].text, wanted); });
  if (!rows.kept.empty()) return;
  const auto near = nearest(wanted, known);
  std::string remedy = "; its values are `" + known.front() + "` and others";
  if (known.size() < 10)
    remedy = "; its values are " + joined(known, ", ");
  else if (near)
    remedy = "; did you mean `" + *near + "`?";
  throw InputError(
      {table.file, table.header_line, 0},
      "the column `" + table.names[column] + "` contains no `" + wanted + "`" + remedy);
}

// Keeps the rows up to the largest change of the load (`approach`), or those after it (`retract`).
void split_at_peak(const RawTable& table, const DataLayout& layout, const Column& y, Rows& rows) {
  const bool approach = layout.segment == "approach";
  if (!approach && layout.segment != "retract")
    throw InputError({table.file, table.header_line, 0},
                     "has no column `segment` or `step` for `--segment " + layout.segment +
                         "`; give `approach` or `retract`");
  std::size_t peak = 0;
  double largest = -1.0;
  std::optional<double> start;  // a load cell with an offset does not begin at 0
  for (std::size_t k = 0; k < rows.kept.size(); ++k) {
    const auto load = measured_number(table.rows[rows.kept[k]].fields[y.index].text, table.decimal);
    if (!load || !std::isfinite(*load)) continue;
    if (!start) start = load;
    if (std::abs(*load - *start) <= largest) continue;
    largest = std::abs(*load - *start);
    peak = k + 1;
  }
  if (peak > 0)
    rows.notes.push_back("the approach ends at the largest load, on line " +
                         std::to_string(table.rows[rows.kept[peak - 1]].line));
  const auto middle = rows.kept.begin() + static_cast<std::ptrdiff_t>(peak);
  if (approach)
    rows.kept.erase(middle, rows.kept.end());
  else
    rows.kept.erase(rows.kept.begin(), middle);
  if (rows.kept.empty())
    throw InputError({table.file, 0, 0},
                     "ends at its largest load and contains no retraction; leave `--segment` out");
}

}  // namespace

Rows chosen_rows(const RawTable& table, const DataLayout& layout, const Column& y) {
  Rows rows;
  for (std::size_t i = 0; i < table.rows.size(); ++i) rows.kept.push_back(i);
  const bool febio = table.kind == RawTable::Kind::febio_log;
  const auto equal = [](const std::string& a, const std::string& b) { return a == b; };
  if (!layout.case_name.empty())
    keep_only(table, rows, named_index(table, febio ? "item" : "case", "--case"), layout.case_name,
              equal);
  else if (febio && values_in(table, rows.kept, 2).size() > 1)
    throw InputError({table.file, table.header_line, 0},
                     "contains several items per time; choose one by `--case`, as `--case " +
                         table.rows.front().fields[2].text + "`");
  if (layout.segment.empty()) return rows;
  for (const char* name : {"segment", "step"})
    if (const auto found = matches(table, name); found.size() == 1) {
      keep_only(table, rows, found.front(), layout.segment, is_segment);
      return rows;
    }
  split_at_peak(table, layout, y, rows);
  return rows;
}

}  // namespace palpate::measured
