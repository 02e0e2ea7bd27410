// Compiles a pattern to parts, and matches lines to them from the left with one way back: `{any}`.
#include "device/line_pattern.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>
#include <stdexcept>
#include <utility>

#include "base/text.h"
#include "device/line_buffer.h"

namespace palpate::device {
namespace {

constexpr std::array<const char*, measures> names{"force", "travel", "time"};

struct UnitFactor {
  std::string_view unit;
  double factor;  // SI
};
// Exact by definition: 1 lb = 0.45359237 kg, weighed with 9.80665 m/s^2; 1 oz = 1/16 lb.
// NIST SP 811 B.8
constexpr double kilogram = 9.80665;             // N
constexpr double pound = 0.45359237 * kilogram;  // N
constexpr std::array force_units{UnitFactor{"N", 1.0},
                                 UnitFactor{"mN", 1e-3},
                                 UnitFactor{"kN", 1e3},
                                 UnitFactor{"uN", 1e-6},
                                 UnitFactor{"g", 1e-3 * kilogram},
                                 UnitFactor{"kg", kilogram},
                                 UnitFactor{"mg", 1e-6 * kilogram},
                                 UnitFactor{"gF", 1e-3 * kilogram},
                                 UnitFactor{"kgF", kilogram},
                                 UnitFactor{"lb", pound},
                                 UnitFactor{"lbF", pound},
                                 UnitFactor{"oz", pound / 16.0},
                                 UnitFactor{"ozF", pound / 16.0}};
constexpr std::array travel_units{UnitFactor{"mm", 1e-3}, UnitFactor{"um", 1e-6},
                                  UnitFactor{"cm", 1e-2}, UnitFactor{"m", 1.0},
                                  UnitFactor{"in", 25.4e-3}};
constexpr std::array time_units{UnitFactor{"s", 1.0}, UnitFactor{"ms", 1e-3},
                                UnitFactor{"us", 1e-6}, UnitFactor{"min", 60.0}};

std::span<const UnitFactor> units_of(Measure measure) {
  switch (measure) {
    case Measure::force: return force_units;
    case Measure::travel: return travel_units;
    case Measure::time: return time_units;
  }
  return {};
}

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

[[noreturn]] void refuse(const std::string& sentence) { throw std::invalid_argument(sentence); }

}  // namespace

LinePattern::LinePattern(std::string_view text, Decimal decimal)
    : decimal_(decimal == Decimal::comma ? ',' : '.') {
  text = without_outer_spaces(text);
  using Kind = Part::Kind;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool doubled = i + 1 < text.size() && text[i + 1] == c;
    if (c == '{' && !doubled) {
      const auto end = text.find('}', i);
      if (end == std::string_view::npos)
        refuse("wants `}` after `" + std::string(text.substr(i)) + "`; write `{{` for a brace");
      add_name(text.substr(i + 1, end - i - 1));
      i = end;
    } else if (is_blank(c)) {
      if (parts_.back().kind != Kind::space) add({.kind = Kind::space, .text = " "});
    } else {
      if (c == '}' && !doubled) refuse("wants `{` before `}`; write `}}` for a brace");
      if (c == '{' || c == '}') ++i;
      if (parts_.empty() || parts_.back().kind != Kind::text) add({.kind = Kind::text});
      parts_.back().text += c;
    }
  }
  if (!has_number(Measure::force))
    refuse("wants `{force}` where the line has the force; write it as `{force} {force_unit}`");
}

void LinePattern::add_name(std::string_view name) {
  if (name == "any") return add({.kind = Part::Kind::any, .text = "{any}"});
  if (name == "force_sign") {
    if (std::exchange(has_sign_, true)) refuse("wants `{force_sign}` once");
    return add({.kind = Part::Kind::sign, .text = "{force_sign}"});
  }
  for (std::size_t i = 0; i < measures; ++i) {
    const std::string_view number = names[i];
    const bool unit = name.size() > number.size() && name.substr(number.size()) == "_unit";
    if (!name.starts_with(number) || (!unit && name != number)) continue;
    bool& has = unit ? has_unit_[i] : has_number_[i];
    if (has) refuse("wants `{" + std::string(name) + "}` once; write `{any}` for the others");
    has = true;
    return add({.kind = unit ? Part::Kind::unit : Part::Kind::number,
                .measure = static_cast<Measure>(i),
                .text = "{" + std::string(name) + "}"});
  }
  refuse("wants a name that it knows in braces, got `{" + std::string(name) +
         "}`; write `{force}`, `{travel}`, `{time}`, one of these with `_unit`, `{force_sign}` or "
         "`{any}`");
}

void LinePattern::add(const Part& part) {
  if (!parts_.empty() && parts_.back().kind == part.kind)
    refuse("wants something between `" + parts_.back().text + "` and `" + part.text +
           "`, which cannot be told apart; write what the line has between them");
  parts_.push_back(part);
}

std::optional<std::size_t> LinePattern::take_number(const Part& part, std::string_view line,
                                                    std::size_t at, LineWords& words) const {
  const auto touches = [&](char c) { return is_digit(c) || c == '.' || c == decimal_; };
  std::array<char, 32> text{};
  std::size_t size = 0;
  std::size_t i = at;
  if (i < line.size() && (line[i] == '-' || line[i] == '+')) {
    if (line[i] == '-') text[size++] = '-';
    for (++i; i < line.size() && is_blank(line[i]);) ++i;
  }
  int digits = 0;
  int points = 0;
  for (; i < line.size() && (is_digit(line[i]) || line[i] == decimal_); ++i) {
    line[i] == decimal_ ? ++points : ++digits;
    if (digits > 15 || points > 1) return std::nullopt;
    text[size++] = line[i] == decimal_ ? '.' : line[i];
  }
  if (digits == 0) return std::nullopt;
  // An exponent, of at most two digits.
  if (i < line.size() && (line[i] == 'e' || line[i] == 'E')) {
    std::size_t end = i + 1;
    if (end < line.size() && (line[end] == '-' || line[end] == '+')) ++end;
    const std::size_t first = end;
    while (end < line.size() && is_digit(line[end])) ++end;
    if (end - first > 2) return std::nullopt;
    if (end > first) {
      text[size++] = 'e';
      if (line[i + 1] == '-') text[size++] = '-';
      for (std::size_t digit = first; digit < end; ++digit) text[size++] = line[digit];
      i = end;
    }
  }
  if (i < line.size() && touches(line[i])) return std::nullopt;
  double value = 0.0;
  if (std::from_chars(text.data(), text.data() + size, value).ec != std::errc())
    return std::nullopt;
  if (!(std::abs(value) < 1e15)) return std::nullopt;
  words.number[as_index(part.measure)] = value;
  return i - at;
}

// How many bytes of the line the part takes at `at`; nothing if it does not match there.
std::optional<std::size_t> LinePattern::take(std::size_t index, std::string_view line,
                                             std::size_t at, LineWords& words) const {
  const Part& part = parts_[index];
  switch (part.kind) {
    case Part::Kind::any: return 0;
    case Part::Kind::text:
      return line.substr(at).starts_with(part.text) ? std::optional(part.text.size())
                                                    : std::nullopt;
    case Part::Kind::space: {
      std::size_t end = at;
      while (end < line.size() && is_blank(line[end])) ++end;
      return end - at;
    }
    case Part::Kind::sign:
      if (at == line.size() || std::string_view("0+ 1-").find(line[at]) == line.npos)
        return std::nullopt;
      words.negative = line[at] == '1' || line[at] == '-';
      return 1;
    case Part::Kind::number: {
      // A text of the pattern may end with anything, and what it does not say must not be a number.
      const bool after_text = index > 0 && (parts_[index - 1].kind == Part::Kind::text ||
                                            parts_[index - 1].kind == Part::Kind::sign);
      const char before = at > 0 ? line[at - 1] : ' ';
      if (!after_text && (is_digit(before) || before == '.' || before == decimal_ ||
                          before == '-' || before == '+'))
        return std::nullopt;
      return take_number(part, line, at, words);
    }
    case Part::Kind::unit: {
      std::size_t end = at;
      while (end < line.size() && is_letter(line[end])) ++end;
      if (end == at || end - at > 7) return std::nullopt;
      words.unit[as_index(part.measure)] = line.substr(at, end - at);
      return end - at;
    }
  }
  return std::nullopt;
}

std::optional<LineWords> LinePattern::match(std::string_view line, Furthest& furthest) const {
  line = without_outer_spaces(line);
  LineWords words;
  std::size_t part = 0;
  std::size_t at = 0;
  // After a failure the last `{any}` takes one byte more, so that the time is at most the product
  // of both lengths.
  std::optional<Furthest> back;
  while (part < parts_.size() || at < line.size()) {
    if (at >= furthest.at) furthest = {part, at};
    const auto size = part < parts_.size() ? take(part, line, at, words) : std::nullopt;
    if (size) {
      if (parts_[part].kind == Part::Kind::any) back = {part, at};
      at += *size;
      ++part;
    } else {
      if (!back || back->at == line.size()) return std::nullopt;
      at = ++back->at;
      part = back->part + 1;
    }
  }
  if (words.negative) words.number[as_index(Measure::force)].value() *= -1.0;
  return words;
}

std::optional<LineWords> LinePattern::match(std::string_view line) const {
  Furthest furthest;
  return match(line, furthest);
}

std::string LinePattern::why_not(std::string_view line) const {
  line = without_outer_spaces(line);
  Furthest furthest;
  if (match(line, furthest)) return "the line matches";
  const std::string rest = printable(line.substr(furthest.at));
  const std::string wanted = furthest.part < parts_.size() ? "`" + parts_[furthest.part].text + "`"
                                                           : "the end of the line";
  return wanted + " was expected " + (rest.empty() ? "where the line ends" : "at `" + rest + "`");
}

// Displays also write units of force in capitals, `LB` or `KGF`; `MN` would be another unit.
std::optional<double> unit_of(Measure measure, std::string_view word) {
  for (const UnitFactor& one : units_of(measure)) {
    const bool same = one.unit.size() == word.size() &&
                      std::equal(word.begin(), word.end(), one.unit.begin(), [&](char a, char b) {
                        const bool capital = measure == Measure::force && one.unit != "mN" &&
                                             is_letter(b) && a == static_cast<char>(b & ~0x20);
                        return a == b || capital || (b == 'F' && a == 'f');
                      });
    if (same) return one.factor;
  }
  return std::nullopt;
}

std::string known_units(Measure measure) {
  const auto units = units_of(measure);
  std::string list;
  for (std::size_t i = 0; i < units.size(); ++i)
    list += (i == 0                  ? ""
             : i + 1 == units.size() ? " or "
                                     : ", ") +
            ("`" + std::string(units[i].unit)) + "`";
  return list;
}

}  // namespace palpate::device
