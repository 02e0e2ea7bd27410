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

}  // namespace

std::string why_no_number(const std::string& text) {
  const std::string word = lower_case(text);
  const bool digits = text.find_first_of("0123456789") != std::string::npos;
  const bool only =
      digits && text.find_first_not_of("0123456789:.,' \u00a0-+/") == std::string::npos;
  if (only && text.find(':') != std::string::npos)
    return "which is a time of day or minutes and seconds; write the column in seconds, or name a "
           "column of numbers";
  if (only && text.find_first_of(",' ") != std::string::npos)
    return "whose marks between thousands are no part of a number; save the numbers without them, "
           "as `1234.5`";
  for (const char* range :
       {"over", "ovl", "ovf", "sat", "out of range", "off scale", "under", "o.l", "****", "----"})
    if (word.find(range) != std::string::npos)
      return "which says that the instrument was out of its range there; leave such rows out by "
             "`--rows` or `--where`, or delete them";
  return "which is no number; name a column of numbers";
}

std::vector<std::size_t> columns_named(const RawTable& table, const std::string& word) {
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
  if (index < table.units.size() && !table.units[index].empty()) {
    const auto unit = written_unit(table.units[index]);
    return unit ? std::optional(unit_under(name, *unit)) : std::nullopt;
  }
  return named_column(name).unit;
}

namespace {

// Heights and tip positions of cantilevers fall as the tip goes in.
bool is_height(const RawTable& table, const std::string& name) {
  if (table.kind == RawTable::Kind::afm_tab)
    return name == "tip position" || name.starts_with("height (");
  if (table.kind != RawTable::Kind::jpk) return false;
  const std::string low = lower_case(name);
  return low.find("height") != std::string::npos || low == "tip position" ||
         low.find("tipposition") != std::string::npos;
}

Column column_at(const RawTable& table, std::size_t index, const std::string& unit, Role role) {
  Column column;
  column.index = index;
  column.name = names_of(table)[index];
  column.unit = file_unit(table, index);
  column.falls = is_height(table, column.name);
  if (unit.empty()) return column;
  column.unit = written_unit(unit);
  if (!column.unit)
    throw InputError({}, "palpate: `" + option(role) + "-unit " + unit +
                             "` is no unit; write it as `mm`, `uN`, `kPa` or `1`");
  column.unit = unit_under(column.name, *column.unit);
  return column;
}

// The names that a format gives to depth and force.
std::vector<std::string> usual_names(const RawTable& table, Role role) {
  const bool x = role == Role::x;
  switch (table.kind) {
    case RawTable::Kind::afm_tab:
      return x ? std::vector<std::string>{"tip position", "height (measured)"}
               : std::vector<std::string>{"force"};
    case RawTable::Kind::chiaro: return {x ? "Indentation (nm)" : "Load (uN)"};
    case RawTable::Kind::jpk:
      return x ? std::vector<std::string>{"tip position",   "verticalTipPosition",    "tipPosition",
                                          "measuredHeight", "capacitiveSensorHeight", "height"}
               : std::vector<std::string>{"vDeflection"};
    default: break;
  }
  // force_indentation.csv of `palpate run`: what a device would measure.
  if (!columns_named(table, "contact_force_N").empty()) return {x ? "travel_mm" : "force_N"};
  return {};
}

// Whether the bare name of a column is one that testing machines give to depth or force.
bool is_usual(const std::string& name, Role role) {
  const std::string bare = lower_case(named_column(name).bare);
  for (const char* word :
       {"displacement", "extension", "compressive extension", "indentation", "depth", "crosshead",
        "compression", "travel", "pd", "penetration depth", "tip depth", "distance", "stroke"})
    if (role == Role::x && bare == word) return true;
  for (const char* word : {"load", "force", "compressive load", "normal force", "fn",
                           "standard force", "stress", "shear stress"})
    if (role == Role::y && bare == word) return true;
  return false;
}

// Whether a column is an x by its nature: a time, a length, a strain or a stretch.
bool is_abscissa(const RawTable& table, std::size_t index) {
  const std::string name = index < table.names.size() ? table.names[index] : std::string();
  if (is_stretch(name) || lower_case(name).find("strain") != std::string::npos) return true;
  const auto unit = file_unit(table, index);
  if (!unit) return false;
  const Dimension& dimension = unit->factor.dimension;
  return dimension == length || dimension == time;
}

// The column for a role without a given name: the format's usual one, the first (x) or second (y)
// of two columns, or the only length (x) or force (y). Over time x is the only time, and y the only
// force or, without one, stress; in creep the only length or, without one, strain.
std::size_t only_column(const RawTable& table, const DataLayout& layout, Role role) {
  const bool timed = layout.curve != DataLayout::Curve::press;
  const bool creeps = layout.curve == DataLayout::Curve::creep;
  const std::vector<std::string> names = names_of(table);
  if (!timed)
    for (const std::string& usual : usual_names(table, role))
      for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == usual) return i;
  std::vector<std::size_t> numeric;  // columns of words are no curve, nor are empty ones
  for (std::size_t i = 0; i < names.size(); ++i)
    if (std::any_of(table.rows.begin(), table.rows.end(), [&](const RawRow& row) {
          const auto number = measured_number(row.fields[i].text, table.decimal);
          return number && std::isfinite(*number);
        }))
      numeric.push_back(i);
  for (std::size_t i = 0; i < names.size() && numeric.size() < 2; ++i)
    if (const Piece& word = table.rows.front().fields[i];
        std::find(numeric.begin(), numeric.end(), i) == numeric.end())
      throw InputError({table.file, table.rows.front().line, word.column},
                       "`" + names[i] + "` holds `" + word.text + "`, " + why_no_number(word.text));
  if (numeric.size() == 2) {
    const bool turned = is_abscissa(table, numeric[1]) && !is_abscissa(table, numeric[0]);
    return numeric[(role == Role::x) == turned ? 1 : 0];
  }
  const auto of = [&](const Dimension& dimension) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < names.size(); ++i)
      if (const auto unit = file_unit(table, i); unit && unit->factor.dimension == dimension)
        found.push_back(i);
    return found;
  };
  std::vector<std::size_t> fitting =
      of(role == Role::x ? (timed ? time : length) : (creeps ? length : force));
  if (fitting.empty() && role == Role::y && timed && !creeps) fitting = of(stress);
  if (fitting.empty() && role == Role::y && creeps)
    for (std::size_t i = 0; i < names.size(); ++i)
      if (lower_case(names[i]).find("strain") != std::string::npos) fitting.push_back(i);
  if (fitting.size() == 1) return fitting.front();
  // TRIOS counts `Run time` from the first step of a protocol and `Step time` from this one.
  if (role == Role::x && timed)
    for (const char* word : {"step time", "time"})
      for (const std::size_t i : fitting)
        if (lower_case(named_column(names[i]).bare) == word) return i;
  std::vector<std::size_t> usual;
  for (const std::size_t i : fitting)
    if (is_usual(names[i], role)) usual.push_back(i);
  if (usual.size() == 1) return usual.front();
  throw InputError({table.file, table.header_line, 0},
                   "has " + std::to_string(names.size()) +
                       " columns, and it is not clear which is " + (role == Role::x ? "x" : "y") +
                       "; set `" + option(role) + "` to one of " + joined(names, ", "));
}

}  // namespace

std::size_t named_index(const RawTable& table, const std::string& word, const std::string& asked) {
  const std::vector<std::size_t> found = columns_named(table, word);
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

Column find_column(const RawTable& table, const DataLayout& layout, Role role) {
  const bool x = role == Role::x;
  const std::string& wanted = x ? layout.x : layout.y;
  const std::size_t index =
      wanted.empty() ? only_column(table, layout, role) : named_index(table, wanted, option(role));
  return column_at(table, index, x ? layout.x_unit : layout.y_unit, role);
}

}  // namespace palpate::measured
