// Finds columns by name, number or dimension, and rows by case, segment, condition and range.
// Recognises units in the spellings of makers of testing machines.
#include "measured/columns.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/index.h"
#include "base/text.h"

namespace palpate::measured {
namespace {

constexpr Dimension mass{0, 1, 0};

std::string without_brackets(std::string_view given) {
  const std::string text = trimmed(given);
  const bool round = text.starts_with('(') && text.ends_with(')');
  const bool square = text.starts_with('[') && text.ends_with(']');
  const bool curly = text.starts_with('{') && text.ends_with('}');
  const bool angle = text.starts_with('<') && text.ends_with('>');
  return round || square || curly || angle
             ? trimmed(std::string_view(text).substr(1, text.size() - 2))
             : text;
}

// Replaces both Unicode signs for micro by the letter u.
std::string plain_micro(std::string text) {
  for (const std::string_view sign : {"\u00b5", "\u03bc"})
    for (auto at = text.find(sign); at != std::string::npos; at = text.find(sign))
      text.replace(at, sign.size(), "u");
  return text;
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

// `Pa.s` and `s-1`, also with a raised dot or exponent, as `Pa*s` and `s^-1`.
std::string plain_product(std::string text) {
  replace_all(text, "\u00b7", "*");
  replace_all(text, "\u22c5", "*");
  replace_all(text, "\u207b\u00b9", "^-1");
  replace_all(text, "\u00b2", "^2");
  for (std::size_t i = 1; i + 1 < text.size(); ++i) {
    if (!is_letter(text[i - 1])) continue;
    if (text[i] == '.' && is_letter(text[i + 1])) text[i] = '*';
    if (text[i] == '-' && is_digit(text[i + 1])) text.insert(i, "^");
  }
  return text;
}

// Whether a column's name says that its values are forces.
bool is_force_name(const std::string& bare) {
  const std::string name = lower_case(bare);
  for (const char* word : {"force", "load", "kraft", "kracht", "fuerza", "firmness", "hardness"})
    if (name.find(word) != std::string::npos) return true;
  return name == "f" || name == "fn" || name == "fz";
}

// A unit of time below a rate is its reciprocal (`Shear rate / s`), and a unit of mass below a
// force is the weight of it under standard gravity (the grams of texture analysers).
WrittenUnit as_named(const std::string& bare, const WrittenUnit& unit) {
  const std::string name = lower_case(bare);
  const UnitFactor& factor = unit.factor;
  if (factor.dimension == time && name.find("rate") != std::string::npos)
    return {"1/" + unit.text, {factor.per, factor.times, unit::per_second.dimension}};
  if (factor.dimension == mass && is_force_name(bare))
    return {unit.text + "f", {factor.times * 9.80665, factor.per, force}};
  return unit;
}

}  // namespace

bool is_mass(const WrittenUnit& unit) { return unit.factor.dimension == mass; }

WrittenUnit unit_under(const std::string& name, const WrittenUnit& unit) {
  return as_named(named_column(name).bare, unit);
}

std::optional<WrittenUnit> written_unit(std::string_view given) {
  const std::string text = plain_micro(without_brackets(given));
  if (text.empty()) return std::nullopt;
  for (const char* pure : {"-", "1", "in/in", "mm/mm", "m/m"})
    if (text == pure) return WrittenUnit{"", {}};
  if (const auto factor = unit_factor(text)) return WrittenUnit{text, *factor};
  const std::string plain = plain_product(text);
  if (const auto factor = unit_factor(plain)) return WrittenUnit{plain, *factor};
  if (text == "S") return WrittenUnit{"s", {1, 1, time}};  // a time, not a conductance
  if (const UnitWord* word = unit_word(text)) return WrittenUnit{word->symbol, word->factor};
  return std::nullopt;
}

bool is_stretch(std::string_view name) {
  const std::string bare = lower_case(named_column(name).bare);
  for (const char* word : {"stretch", "stretch ratio", "stretch_ratio", "extension ratio", "lambda",
                           "\u03bb", "principal stretch", "axial stretch", "elongation ratio"})
    if (bare == word) return true;
  return false;
}

bool is_unit_word(std::string_view given) {
  if (written_unit(given)) return true;
  const std::string text = lower_case(without_brackets(given));
  for (const char* word :
       {"degc", "\u00b0c", "deg c", "degf", "\u00b0f", "k",   "v",    "mv",  "uv",
        "nv",   "a",       "ma",    "deg",  "\u00b0",  "rad", "mrad", "rpm", "a.u.",
        "au",   "counts",  "ohm",   "db",   "mn*m",    "mnm", "un*m", "n*m", "%/s"})
    if (text == word) return true;
  return false;
}

NamedColumn named_column(std::string_view given) {
  const std::string name = trimmed(given);
  const auto split_at = [&](std::size_t at, std::size_t skipped) -> std::optional<NamedColumn> {
    if (at == std::string::npos || at == 0) return std::nullopt;
    const auto unit = written_unit(std::string_view(name).substr(at + skipped));
    if (!unit) return std::nullopt;
    const std::string bare = trimmed(std::string_view(name).substr(0, at));
    if (whole_number(bare)) return std::nullopt;  // `1/s` names nothing
    return NamedColumn{bare, as_named(bare, *unit)};
  };
  if (name.ends_with(')') || name.ends_with(']') || name.ends_with('}') || name.ends_with('>')) {
    const std::size_t open = name.find_last_of("([{<");
    if (const auto split = split_at(open, 0)) return *split;
    return {name, std::nullopt};
  }
  if (const auto split = split_at(name.rfind('_'), 1)) return *split;
  if (const auto split = split_at(name.rfind(" / "), 3)) return *split;
  if (const auto split = split_at(name.rfind(" in "), 4)) return *split;
  if (const auto split = split_at(name.rfind(", "), 2)) return *split;
  if (const auto split = split_at(name.rfind(": "), 2)) return *split;
  if (const auto split = split_at(name.rfind(' '), 1)) return *split;  // `Depth nm`
  if (const auto split = split_at(name.rfind('/'), 1)) return *split;
  return {name, std::nullopt};
}

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
    if (std::ranges::any_of(table.rows, [&](const RawRow& row) {
          const auto number = measured_number(row.fields[i].text, table.decimal);
          return number && std::isfinite(*number);
        }))
      numeric.push_back(i);
  for (std::size_t i = 0; i < names.size() && numeric.size() < 2; ++i)
    if (const Piece& word = table.rows.front().fields[i];
        std::ranges::find(numeric, i) == numeric.end())
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
    throw InputError(
        {table.file, table.rows.front().line, 0},
        "the numbers begin here without names of columns above, so that there is no column `" +
            word + "`; give a column's number, as `" + asked +
            " 1`, or `--skip` the lines above the names");
  throw InputError(
      {table.file, table.header_line, 0},
      "has no column `" + word + "`; " +
          did_you_mean(word, table.names, "columns: " + joined(names_of(table), ", ")));
}

Column find_column(const RawTable& table, const DataLayout& layout, Role role) {
  const bool x = role == Role::x;
  const std::string& wanted = x ? layout.x : layout.y;
  const std::size_t index =
      wanted.empty() ? only_column(table, layout, role) : named_index(table, wanted, option(role));
  return column_at(table, index, x ? layout.x_unit : layout.y_unit, role);
}

// Chooses the rows of a case, a segment, a condition and a range.

namespace {

// The words of instruments for the parts of a curve.
enum class Part { approach, retract, pause, other };
Part part_of(const std::string& cell) {
  const std::string held = lower_case(cell);
  const auto one_of = [&](std::initializer_list<const char*> words) {
    return std::ranges::any_of(words, [&](const char* word) { return held == word; });
  };
  if (one_of({"approach", "extend", "extension", "loading", "load", "forward", "trace", "advance",
              "indent", "indentation", "compress", "compression", "down", "in", "approaching"}))
    return Part::approach;
  if (one_of({"retract", "retraction", "unloading", "unload", "backward", "retrace", "withdraw",
              "withdrawal", "return", "release", "up", "out", "retracting"}))
    return Part::retract;
  if (one_of({"pause", "hold", "holding", "dwell", "contact", "creep", "relax", "relaxation",
              "wait", "intermediate", "idle"}))
    return Part::pause;
  return Part::other;
}

// Whether a cell names the segment: the same word or number, or an instrument's word for it.
bool is_segment(const std::string& cell, const std::string& wanted) {
  const std::string held = lower_case(cell);
  const std::string asked = lower_case(wanted);
  if (held == asked) return true;
  if (asked == "approach") return held == "0" || held == "false" || part_of(cell) == Part::approach;
  if (asked == "retract") return held == "1" || held == "true" || part_of(cell) == Part::retract;
  const auto a = whole_number(held);
  const auto b = whole_number(asked);
  return a && b && *a == *b;
}

bool is_same(const std::string& a, const std::string& b) {
  const auto first = whole_number(a);
  const auto second = whole_number(b);
  return a == b || (first && second && *first == *second);
}

std::vector<std::string> values_in(const RawTable& table, const std::vector<std::size_t>& rows,
                                   std::size_t column) {
  std::vector<std::string> values;
  for (const std::size_t i : rows) {
    const std::string& value = table.rows[i].fields[column].text;
    if (std::find(values.rbegin(), values.rend(), value) == values.rend()) values.push_back(value);
    if (values.size() > 1000) break;
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
  const std::string remedy =
      known.size() < 10
          ? "its values are " + joined(known, ", ")
          : did_you_mean(wanted, known, "its values are `" + known.front() + "` and others");
  throw InputError(
      {table.file, table.header_line, 0},
      "the column `" + table.names[column] + "` contains no `" + wanted + "`; " + remedy);
}

// Whether all rows are those of a retract.
bool is_retract(const RawTable& table, const Axes& axes, const Rows& rows) {
  if (!axes.x.unit || !(axes.x.unit->factor.dimension == length)) return false;
  std::vector<double> x, load;
  for (const std::size_t i : rows.kept) {
    const auto number = [&](const Column& column) {
      return measured_number(table.rows[i].fields[column.index].text, table.decimal)
          .value_or(std::nan(""));
    };
    x.push_back(number(axes.x));
    load.push_back(number(axes.y));
  }
  return only_retracts(x, load);
}

// Keeps the rows up to the largest change of the load (`approach`), or those after it (`retract`).
void split_at_peak(const RawTable& table, const DataLayout& layout, const Axes& axes, Rows& rows) {
  const Column& y = axes.y;
  const bool approach = layout.segment == "approach";
  if (!approach && layout.segment != "retract")
    throw InputError({table.file, table.header_line, 0},
                     "has no column `segment` or `step` for `--segment " + layout.segment +
                         "`; give `approach` or `retract`");
  if (is_retract(table, axes, rows)) {
    if (approach)
      throw InputError({table.file, 0, 0},
                       "goes one way only in `" + axes.x.name +
                           "`, and its load changes most at its first rows: all of them are the "
                           "way back; leave `--segment` out, or give `--segment retract`");
    rows.notes.push_back("`" + axes.x.name +
                         "` goes one way only, and its load changes most at its first rows: all of "
                         "them are taken as the retract");
    return;
  }
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

// The parts of the chosen rows that follow each other in the table.
std::vector<std::vector<std::size_t>> parts_of(const std::vector<std::size_t>& before,
                                               const std::vector<std::size_t>& kept) {
  std::vector<std::vector<std::size_t>> parts;
  std::size_t at = 0;
  bool open = false;
  for (const std::size_t row : before) {
    const bool taken = at < kept.size() && kept[at] == row;
    if (taken && !open) parts.emplace_back();
    if (taken) {
      parts.back().push_back(row);
      ++at;
    }
    open = taken;
  }
  return parts;
}

// `approach` or, if the name stands for several parts, `approach:2`.
void keep_segment(const RawTable& table, const DataLayout& layout, std::size_t column, Rows& rows) {
  std::string wanted = layout.segment;
  std::size_t number = 0;
  if (const std::size_t colon = wanted.rfind(':'); colon != std::string::npos)
    if (const auto given = whole_number(wanted.substr(colon + 1)); given && *given >= 1.0) {
      number = static_cast<std::size_t>(*given);
      wanted.resize(colon);
    }
  const std::vector<std::size_t> before = rows.kept;
  keep_only(table, rows, column, wanted, is_segment);
  const auto parts = parts_of(before, rows.kept);
  if (number == 0 && parts.size() == 1) return;
  std::string lines;
  for (std::size_t k = 0; k < std::min<std::size_t>(parts.size(), 5); ++k)
    lines += (k > 0 ? ", " : "") + std::to_string(table.rows[parts[k].front()].line) + " to " +
             std::to_string(table.rows[parts[k].back()].line);
  const std::string there = "the column `" + table.names[column] + "` has " +
                            std::to_string(parts.size()) +
                            (parts.size() == 1 ? " part" : " parts") + " `" + wanted +
                            "`, on lines " + lines + (parts.size() > 5 ? ", ..." : "");
  if (number == 0)
    throw InputError({table.file, table.header_line, 0},
                     there + "; choose one, as `--segment " + wanted + ":1`");
  if (number > parts.size())
    throw InputError({table.file, table.header_line, 0},
                     there + ", and `--segment " + layout.segment + "` is not among them");
  rows.kept = parts[number - 1];
}

// The column that divides the table into segments: one of that name, or the only one in which every
// cell is an instrument's word for a part of the curve.
std::optional<std::size_t> segment_column(const RawTable& table) {
  for (const char* name : {"segment", "step"})
    if (const auto found = columns_named(table, name); found.size() == 1) return found.front();
  std::optional<std::size_t> only;
  for (std::size_t i = 0; i < table.width(); ++i) {
    const bool words = std::ranges::all_of(
        table.rows, [&](const RawRow& row) { return part_of(row.fields[i].text) != Part::other; });
    if (words && only) return std::nullopt;
    if (words) only = i;
  }
  return only;
}

// The usual segment of a force over a length, where a column of words tells it from other parts.
void keep_usual(const RawTable& table, const Axes& axes, const std::string& usual, Rows& rows) {
  const auto is = [](const Column& column, const Dimension& dimension) {
    return column.unit && column.unit->factor.dimension == dimension;
  };
  if (!is(axes.x, length) || !is(axes.y, force)) return;
  const auto column = segment_column(table);
  if (!column) return;
  const bool flags = table.kind == RawTable::Kind::afm_tab;  // of which 0 and False are approaches
  const Part part = usual == "approach" ? Part::approach : Part::retract;
  const auto wanted = [&](std::size_t i) {
    const std::string& cell = table.rows[i].fields[*column].text;
    return flags ? is_segment(cell, usual) : part_of(cell) == part;
  };
  const auto taken = std::ranges::count_if(rows.kept, wanted);
  const std::size_t all = rows.kept.size();
  if (taken == 0 || as_index(taken) == all) return;
  DataLayout layout;
  layout.segment = usual;
  keep_segment(table, layout, *column, rows);
  rows.notes.push_back("the column `" + table.names[*column] + "` divides the curve: its " +
                       std::to_string(rows.kept.size()) + " rows of the " + usual +
                       " are taken, of " + std::to_string(all) + "; `--segment " +
                       (part == Part::approach ? "retract" : "approach") +
                       "` or `--segment all` takes others");
}

void keep_where(const RawTable& table, const std::string& condition, Rows& rows) {
  const std::size_t equals = condition.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError(
        {}, "palpate: `--where " + condition + "` is written COLUMN=VALUE, as `--where Set=1`");
  const std::string name = trimmed(condition.substr(0, equals));
  keep_only(table, rows, named_index(table, name, "--where"), trimmed(condition.substr(equals + 1)),
            is_same);
}

void keep_range(const RawTable& table, const std::string& range, Rows& rows) {
  const std::size_t dots = range.find("..");
  const auto number = [&](const std::string& text, double otherwise) {
    if (trimmed(text).empty()) return otherwise;
    const auto value = whole_number(trimmed(text));
    return value && *value == std::floor(*value) && *value >= 1.0 ? *value : 0.0;
  };
  const auto last = static_cast<double>(table.rows.size());
  const double from = dots == std::string::npos ? 0.0 : number(range.substr(0, dots), 1.0);
  const double to = dots == std::string::npos ? 0.0 : number(range.substr(dots + 2), last);
  if (!(from >= 1.0 && to >= from))
    throw InputError({},
                     "palpate: `--rows " + range +
                         "` is written FROM..TO, rows of the table from 1, as `--rows 100..2000`");
  std::erase_if(rows.kept, [&](std::size_t i) {
    const auto row = static_cast<double>(i + 1);
    return row < from || row > to;
  });
  if (rows.kept.empty())
    throw InputError({table.file, 0, 0}, "has " + std::to_string(table.rows.size()) +
                                             " rows, and `--rows " + range +
                                             "` leaves none of those chosen");
}

}  // namespace

bool only_retracts(std::span<const double> x, std::span<const double> load) {
  std::vector<double> way, change;  // from the first row
  std::optional<std::size_t> first;
  std::size_t last = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(load[i])) continue;
    if (!first) first = i;
    last = i;
    way.push_back(std::abs(x[i] - x[*first]));
    change.push_back(std::abs(load[i] - load[*first]));
  }
  if (way.size() < 4 || way.back() < 0.9 * *std::ranges::max_element(way)) return false;
  if (!(std::abs(load[*first]) > std::abs(load[last]))) return false;
  const auto most = std::ranges::max_element(change);
  const auto half = std::ranges::find_if(
      way, [&](double each) { return each >= 0.5 * way[as_index(most - change.begin())]; });
  return change[as_index(half - way.begin())] > 0.5 * *most;
}

Rows chosen_rows(const RawTable& table, const DataLayout& layout, const Axes& axes) {
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
  for (const std::string& condition : layout.where) keep_where(table, condition, rows);
  if (!layout.rows.empty()) keep_range(table, layout.rows, rows);
  if (layout.segment.empty() || layout.segment == "all") {
    if (table.tables > 1 && layout.segment.empty() && layout.where.empty() && layout.rows.empty())
      throw InputError({table.file, 0, 0},
                       "contains " + std::to_string(table.tables) +
                           " tables with the same columns; choose one, as `--segment 1`, or take "
                           "the rows of all by `--segment all`");
    if (layout.segment.empty()) keep_usual(table, axes, layout.usual, rows);
    return rows;
  }
  if (const auto column = segment_column(table)) {
    keep_segment(table, layout, *column, rows);
    return rows;
  }
  split_at_peak(table, layout, axes, rows);
  return rows;
}

}  // namespace palpate::measured
