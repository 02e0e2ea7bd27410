// Recognises units in the names of columns, in the spellings of makers of testing machines.
#include "measured/unit.h"

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

}  // namespace palpate::measured
