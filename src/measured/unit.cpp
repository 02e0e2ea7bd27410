// Recognises units in the names of columns, in the spellings of makers of testing machines.
#include "measured/unit.h"

#include <array>

#include "base/text.h"

namespace palpate::measured {
namespace {

struct Alias {
  std::string_view word;  // in small letters
  WrittenUnit unit;
};

constexpr Dimension time{0, 0, 1};

// The pound-force and the kilogram-force are exact by definition (standard gravity 9.80665 m/s^2,
// the pound 0.45359237 kg); the inch is 25.4 mm.
const std::array<Alias, 23>& aliases() {
  static const std::array<Alias, 23> table{{
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
      {"kgf", {"kgf", {9.80665, 1, force}}},
      {"lbf", {"lbf", {4.4482216152605, 1, force}}},
      {"in", {"in", {25.4, 1e3, length}}},
      {"inch", {"in", {25.4, 1e3, length}}},
      {"inches", {"in", {25.4, 1e3, length}}},
      {"micron", {"um", {1, 1e6, length}}},
      {"microns", {"um", {1, 1e6, length}}},
      {"millimeter", {"mm", {1, 1e3, length}}},
      {"millimetre", {"mm", {1, 1e3, length}}},
      {"%", {"%", {1, 1e2, {}}}},
  }};
  return table;
}

std::string without_brackets(std::string_view given) {
  const std::string text = trimmed(given);
  const bool round = text.starts_with('(') && text.ends_with(')');
  const bool square = text.starts_with('[') && text.ends_with(']');
  return round || square ? trimmed(std::string_view(text).substr(1, text.size() - 2)) : text;
}

// Replaces both Unicode signs for micro by the letter u.
std::string plain_micro(std::string text) {
  for (const std::string_view sign : {"\u00b5", "\u03bc"})
    for (auto at = text.find(sign); at != std::string::npos; at = text.find(sign))
      text.replace(at, sign.size(), "u");
  return text;
}

}  // namespace

std::optional<WrittenUnit> written_unit(std::string_view given) {
  const std::string text = plain_micro(without_brackets(given));
  if (text.empty()) return std::nullopt;
  if (text == "-" || text == "1") return WrittenUnit{"", {}};
  if (const auto factor = unit_factor(text)) return WrittenUnit{text, *factor};
  if (text == "S") return WrittenUnit{"s", {1, 1, time}};  // a time, not a conductance
  for (const Alias& alias : aliases())
    if (lower_case(text) == alias.word) return alias.unit;
  return std::nullopt;
}

NamedColumn named_column(std::string_view given) {
  const std::string name = trimmed(given);
  const auto split_at = [&](std::size_t at, std::size_t skipped) -> std::optional<NamedColumn> {
    if (at == std::string::npos || at == 0) return std::nullopt;
    const auto unit = written_unit(std::string_view(name).substr(at + skipped));
    if (!unit) return std::nullopt;
    return NamedColumn{trimmed(std::string_view(name).substr(0, at)), unit};
  };
  if (name.ends_with(')') || name.ends_with(']')) {
    const std::size_t open = name.find_last_of("([");
    if (const auto split = split_at(open, 0)) return *split;
    return {name, std::nullopt};
  }
  if (const auto split = split_at(name.rfind('_'), 1)) return *split;
  if (const auto split = split_at(name.rfind(" / "), 3)) return *split;
  if (const auto split = split_at(name.rfind(" in "), 4)) return *split;
  if (const auto split = split_at(name.rfind(", "), 2)) return *split;
  return {name, std::nullopt};
}

}  // namespace palpate::measured
