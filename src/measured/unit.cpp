// Recognises units in the names of columns, in the spellings of makers of testing machines.
#include "measured/unit.h"

#include <vector>

#include "base/text.h"

namespace palpate::measured {
namespace {

struct Alias {
  std::string_view word;  // in small letters
  WrittenUnit unit;
};

constexpr Dimension rate{0, 0, -1};
constexpr Dimension mass{0, 1, 0};

// The pound-force and the kilogram-force are exact by definition (standard gravity 9.80665 m/s^2,
// the pound 0.45359237 kg); the inch is 25.4 mm. The psi is lbf / in^2; the conventional millimetre
// of mercury is 133.322387415 Pa and the torr 101325 / 760 Pa (NIST Special Publication 811).
const std::vector<Alias>& aliases() {
  static const std::vector<Alias> table{
      {"sec", {"s", {1, 1, time}}},
      {"secs", {"s", {1, 1, time}}},
      {"second", {"s", {1, 1, time}}},
      {"seconds", {"s", {1, 1, time}}},
      {"msec", {"ms", {1, 1e3, time}}},
      {"milliseconds", {"ms", {1, 1e3, time}}},
      {"mins", {"min", {60, 1, time}}},
      {"minute", {"min", {60, 1, time}}},
      {"minutes", {"min", {60, 1, time}}},
      {"hours", {"h", {3600, 1, time}}},
      {"newton", {"N", {1, 1, force}}},
      {"newtons", {"N", {1, 1, force}}},
      {"gf", {"gf", {9.80665, 1e3, force}}},
      {"kp", {"kgf", {9.80665, 1, force}}},
      {"dyn", {"dyn", {1, 1e5, force}}},
      {"dyne", {"dyn", {1, 1e5, force}}},
      {"ozf", {"ozf", {0.27801385095378125, 1, force}}},
      {"hr", {"h", {3600, 1, time}}},
      {"hrs", {"h", {3600, 1, time}}},
      {"rad/s", {"1/s", {1, 1, rate}}},
      {"kgf", {"kgf", {9.80665, 1, force}}},
      {"lbf", {"lbf", {4.4482216152605, 1, force}}},
      {"in", {"in", {25.4, 1e3, length}}},
      {"inch", {"in", {25.4, 1e3, length}}},
      {"inches", {"in", {25.4, 1e3, length}}},
      {"micron", {"um", {1, 1e6, length}}},
      {"microns", {"um", {1, 1e6, length}}},
      {"millimeter", {"mm", {1, 1e3, length}}},
      {"millimetre", {"mm", {1, 1e3, length}}},
      {"millimeters", {"mm", {1, 1e3, length}}},
      {"millimetres", {"mm", {1, 1e3, length}}},
      {"micrometer", {"um", {1, 1e6, length}}},
      {"micrometers", {"um", {1, 1e6, length}}},
      {"nanometer", {"nm", {1, 1e9, length}}},
      {"nanometers", {"nm", {1, 1e9, length}}},
      {"meter", {"m", {1, 1, length}}},
      {"meters", {"m", {1, 1, length}}},
      {"angstrom", {"Angstrom", {1, 1e10, length}}},
      {"angstroms", {"Angstrom", {1, 1e10, length}}},
      {"ang", {"Angstrom", {1, 1e10, length}}},
      {"\u00c5", {"Angstrom", {1, 1e10, length}}},
      {"\u00e5", {"Angstrom", {1, 1e10, length}}},
      {"ft", {"ft", {304.8, 1e3, length}}},
      {"lb", {"lbf", {4.4482216152605, 1, force}}},
      {"lbs", {"lbf", {4.4482216152605, 1, force}}},
      {"millinewtons", {"mN", {1, 1e3, force}}},
      {"kilonewtons", {"kN", {1e3, 1, force}}},
      {"pascal", {"Pa", {1, 1, stress}}},
      {"pascals", {"Pa", {1, 1, stress}}},
      {"kilopascals", {"kPa", {1e3, 1, stress}}},
      {"megapascals", {"MPa", {1e6, 1, stress}}},
      {"psi", {"psi", {6894.757293168361, 1, stress}}},
      {"ksi", {"ksi", {6894757.293168361, 1, stress}}},
      {"mmhg", {"mmHg", {133.322387415, 1, stress}}},
      {"torr", {"Torr", {101325, 760, stress}}},
      {"atm", {"atm", {101325, 1, stress}}},
      {"%", {"%", {1, 1e2, {}}}},
  };
  return table;
}

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
    return {"1/" + unit.text, {factor.per, factor.times, rate}};
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
  for (const Alias& alias : aliases())
    if (lower_case(text) == alias.word) return alias.unit;
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
  if (auto split = split_at(name.rfind(": "), 2)) return *split;
  if (auto split = split_at(name.rfind(' '), 1)) {  // `Depth nm`, `Load: uN`
    if (split->bare.ends_with(':')) split->bare.pop_back();
    return *split;
  }
  if (const auto split = split_at(name.rfind('/'), 1)) return *split;
  return {name, std::nullopt};
}

}  // namespace palpate::measured
