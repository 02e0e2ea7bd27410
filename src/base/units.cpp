// Parses unit expressions: symbols with prefixes, joined by `*`, `/`, spaces and powers (`kg/m^3`).
#include "base/units.h"

#include <array>
#include <cctype>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "base/text.h"

namespace palpate {
namespace {

struct Symbol {
  std::string_view name;
  UnitFactor scale;
  bool prefixed;
};

constexpr std::array symbols{
    Symbol{"m", {1, 1, {1, 0, 0}}, true},       Symbol{"g", {1, 1e3, {0, 1, 0}}, true},
    Symbol{"s", {1, 1, {0, 0, 1}}, true},       Symbol{"N", {1, 1, {1, 1, -2}}, true},
    Symbol{"Pa", {1, 1, {-1, 1, -2}}, true},    Symbol{"J", {1, 1, {2, 1, -2}}, true},
    Symbol{"W", {1, 1, {2, 1, -3}}, true},      Symbol{"Hz", {1, 1, {0, 0, -1}}, true},
    Symbol{"bar", {1e5, 1, {-1, 1, -2}}, true}, Symbol{"min", {60, 1, {0, 0, 1}}, false},
    Symbol{"h", {3600, 1, {0, 0, 1}}, false},
};

struct Prefix {
  std::string_view name;
  double times;
  double per;
};
constexpr std::array prefixes{Prefix{"T", 1e12, 1},     Prefix{"p", 1, 1e12}, Prefix{"f", 1, 1e15},
                              Prefix{"G", 1e9, 1},      Prefix{"M", 1e6, 1},  Prefix{"k", 1e3, 1},
                              Prefix{"h", 1e2, 1},      Prefix{"d", 1, 1e1},  Prefix{"c", 1, 1e2},
                              Prefix{"m", 1, 1e3},      Prefix{"u", 1, 1e6},  Prefix{"n", 1, 1e9},
                              Prefix{"\u00b5", 1, 1e6},   // the micro sign
                              Prefix{"\u03bc", 1, 1e6}};  // the Greek letter mu

std::optional<UnitFactor> symbol_scale(std::string_view text) {
  for (const Symbol& symbol : symbols)
    if (text == symbol.name) return symbol.scale;
  for (const Prefix& prefix : prefixes) {
    if (!text.starts_with(prefix.name)) continue;
    for (const Symbol& symbol : symbols)
      if (symbol.prefixed && text.substr(prefix.name.size()) == symbol.name)
        return UnitFactor{symbol.scale.times * prefix.times, symbol.scale.per * prefix.per,
                          symbol.scale.dimension};
  }
  return std::nullopt;
}

void multiply(UnitFactor& product, const UnitFactor& factor, int power) {
  for (int i = 0; i < std::abs(power); ++i) {
    product.times *= power > 0 ? factor.times : factor.per;
    product.per *= power > 0 ? factor.per : factor.times;
  }
  product.dimension.m += power * factor.dimension.m;
  product.dimension.kg += power * factor.dimension.kg;
  product.dimension.s += power * factor.dimension.s;
}

// Combines `times` and `per` into one number if that is exact. Without this, `kg` (1000 g, a gram
// being a thousandth of the SI unit) would be multiplied and divided by 1000 and rounded twice.
UnitFactor reduced(UnitFactor scale) {
  const auto divides = [](double part, double whole) {
    return whole < 9007199254740992.0 && std::fmod(whole, part) == 0.0;
  };
  if (divides(scale.per, scale.times)) return {scale.times / scale.per, 1.0, scale.dimension};
  if (divides(scale.times, scale.per)) return {1.0, scale.per / scale.times, scale.dimension};
  return scale;
}

// The same with units that palpate does not take: `inches`, `lbf`, `cm2`.
std::optional<UnitFactor> foreign_scale(std::string_view text) {
  if (const auto known = symbol_scale(text)) return known;
  if (const UnitWord* word = unit_word(text)) return word->factor;
  if (text.size() < 2 || (text.back() != '2' && text.back() != '3')) return std::nullopt;
  const auto one = foreign_scale(text.substr(0, text.size() - 1));
  if (!one) return std::nullopt;
  UnitFactor power;
  multiply(power, *one, text.back() - '0');
  return power;
}

// The same with pounds of mass: `lb/ft3`.
std::optional<UnitFactor> mass_scale(std::string_view text) {
  if (text == "lb" || text == "lbs" || text == "lbm") return UnitFactor{0.45359237, 1, {.kg = 1}};
  return foreign_scale(text);
}

// Parses a unit expression; empty if it is not one.
std::optional<UnitFactor> parse_unit(
    std::string_view text, std::optional<UnitFactor> (*scale_of)(std::string_view) = symbol_scale) {
  UnitFactor scale;
  int sign = 1;
  bool wants_factor = true;
  std::size_t at = 0;
  while (at < text.size()) {
    const char c = text[at];
    if (c == ' ') {
      ++at;
    } else if (c == '*' || c == '/') {
      if (wants_factor) return std::nullopt;
      sign = c == '/' ? -1 : 1;
      wants_factor = true;
      ++at;
    } else if (c == '1' && at == 0 && (text.size() == 1 || text[1] == '/')) {
      wants_factor = false;
      ++at;
    } else {
      const std::size_t end = std::min(text.find_first_of(" */^", at), text.size());
      const auto factor = scale_of(text.substr(at, end - at));
      if (!factor) return std::nullopt;
      int power = 1;
      at = end;
      if (at < text.size() && text[at] == '^') {
        const auto exponent = leading_number(text.substr(at + 1));
        if (!exponent || exponent->out_of_range || exponent->value != std::round(exponent->value) ||
            std::abs(exponent->value) > 9)
          return std::nullopt;
        power = static_cast<int>(exponent->value);
        at = text.size() - exponent->rest.size();
      }
      multiply(scale, *factor, sign * power);
      sign = 1;
      wants_factor = false;
    }
  }
  if (wants_factor) return std::nullopt;
  return reduced(scale);
}

// The common unit of `dimension` whose name is most similar to `written`.
std::optional<std::string> nearest_unit(std::string_view written, const Dimension& dimension) {
  std::vector<std::string> known;
  for (const char* usual :
       {"mm", "cm", "m",  "um",   "Pa",  "kPa",  "MPa", "GPa", "s",      "ms",    "us",
        "N",  "mN", "kN", "mm/s", "m/s", "cm/s", "1/s", "Hz",  "kg/m^3", "g/cm^3"})
    if (parse_unit(usual)->dimension == dimension) known.emplace_back(usual);
  return nearest(written, known);
}

// The pound-force and the kilogram-force are exact by definition (standard gravity 9.80665 m/s^2,
// the pound 0.45359237 kg); the inch is 25.4 mm. The psi is lbf / in^2; the conventional millimetre
// of mercury is 133.322387415 Pa and the torr 101325 / 760 Pa (NIST Special Publication 811).
const std::vector<UnitWord>& unit_words() {
  constexpr Dimension length = unit::mm.dimension, force = unit::N.dimension,
                      time = unit::s.dimension, stress = unit::kPa.dimension,
                      rate = unit::per_second.dimension;
  static const std::vector<UnitWord> table{
      {"mph", "mph", {0.44704, 1, unit::mm_per_s.dimension}},
      {"sec", "s", {1, 1, time}},
      {"second", "s", {1, 1, time}},
      {"msec", "ms", {1, 1e3, time}},
      {"millisecond", "ms", {1, 1e3, time}},
      {"mins", "min", {60, 1, time}},
      {"minute", "min", {60, 1, time}},
      {"hour", "h", {3600, 1, time}},
      {"newton", "N", {1, 1, force}},
      {"gf", "gf", {9.80665, 1e3, force}},
      {"kp", "kgf", {9.80665, 1, force}},
      {"dyn", "dyn", {1, 1e5, force}},
      {"dyne", "dyn", {1, 1e5, force}},
      {"ozf", "ozf", {0.27801385095378125, 1, force}},
      {"hr", "h", {3600, 1, time}},
      {"hrs", "h", {3600, 1, time}},
      {"rad/s", "1/s", {1, 1, rate}},
      {"kgf", "kgf", {9.80665, 1, force}},
      {"lbf", "lbf", {4.4482216152605, 1, force}},
      {"in", "in", {25.4, 1e3, length}},
      {"inch", "in", {25.4, 1e3, length}},
      {"inches", "in", {25.4, 1e3, length}},
      {"micron", "um", {1, 1e6, length}},
      {"millimeter", "mm", {1, 1e3, length}},
      {"millimetre", "mm", {1, 1e3, length}},
      {"micrometer", "um", {1, 1e6, length}},
      {"nanometer", "nm", {1, 1e9, length}},
      {"meter", "m", {1, 1, length}},
      {"angstrom", "Angstrom", {1, 1e10, length}},
      {"ang", "Angstrom", {1, 1e10, length}},
      {"\u00c5", "Angstrom", {1, 1e10, length}},
      {"\u00e5", "Angstrom", {1, 1e10, length}},
      {"ft", "ft", {304.8, 1e3, length}},
      {"lb", "lbf", {4.4482216152605, 1, force}},
      {"lbs", "lbf", {4.4482216152605, 1, force}},
      {"millinewton", "mN", {1, 1e3, force}},
      {"kilonewton", "kN", {1e3, 1, force}},
      {"pascal", "Pa", {1, 1, stress}},
      {"kilopascal", "kPa", {1e3, 1, stress}},
      {"megapascal", "MPa", {1e6, 1, stress}},
      {"psi", "psi", {6894.757293168361, 1, stress}},
      {"ksi", "ksi", {6894757.293168361, 1, stress}},
      {"mmhg", "mmHg", {133.322387415, 1, stress}},
      {"torr", "Torr", {101325, 760, stress}},
      {"atm", "atm", {101325, 1, stress}},
      {"%", "%", {1, 1e2, {}}},
  };
  return table;
}

std::string article(std::string_view noun) {
  const bool vowel = std::string_view("aeiou").find(noun.front()) != std::string_view::npos;
  return (vowel ? "an " : "a ") + std::string(noun);
}

const std::vector<const Unit*>& named_units() {
  static const std::vector<const Unit*> units{&unit::mm,        &unit::kPa, &unit::density,
                                              &unit::s,         &unit::N,   &unit::mm_per_s,
                                              &unit::per_second};
  return units;
}

[[noreturn]] void refuse(const Unit& wanted, const std::string& what) {
  throw std::invalid_argument("wants " + article(wanted.quantity) + what);
}

}  // namespace

std::optional<UnitFactor> unit_factor(std::string_view text) { return parse_unit(text); }

const UnitWord* unit_word(std::string_view text) {
  const std::string small = lower_case(text);
  for (const UnitWord& one : unit_words())
    if (small == one.word || (small.size() > 3 && small == std::string(one.word) + "s"))
      return &one;
  return nullptr;
}

double metres_per(const std::string& unit) {
  const UnitWord* word = unit_word(unit);
  return word != nullptr && word->factor.dimension == unit::mm.dimension
             ? word->factor.to_si(1.0)
             : parse_quantity("1 " + unit, unit::mm);
}

std::string_view plausible_unit(double number, std::string_view unit) {
  if (unit == "kPa" && std::abs(number) >= 1000.0) return "Pa";
  if (unit == "mm" && number != 0.0 && std::abs(number) < 0.1) return "m";
  return unit;
}

std::string si_unit(const Dimension& dimension) {
  if (dimension == unit::kPa.dimension) return "Pa";
  if (dimension == unit::N.dimension) return "N";
  std::string text;
  const auto add = [&](const char* name, int power) {
    if (power == 0) return;
    if (!text.empty()) text += "*";
    text += name;
    if (power != 1) text += "^" + std::to_string(power);
  };
  add("m", dimension.m);
  add("kg", dimension.kg);
  add("s", dimension.s);
  return text;
}

std::string unit_pattern(const Dimension& dimension) {
  std::string any_prefix;
  for (const Prefix& prefix : prefixes)
    any_prefix += (any_prefix.empty() ? "" : "|") + std::string(prefix.name);
  std::string pattern;
  for (const Symbol& symbol : symbols)
    if (symbol.scale.dimension == dimension)
      pattern += (symbol.prefixed ? "(" + any_prefix + ")?" : "") + std::string(symbol.name) + "|";
  return pattern + R"([^\s*/^]*[*/^].*|\S+\s+\S.*)";
}

std::string pressure_text(double pascal) {
  double shown = pascal;
  const char* unit = "Pa";
  for (const char* larger : {"kPa", "MPa", "GPa"}) {
    if (std::abs(shown) < 999.95) break;
    shown /= 1e3;
    unit = larger;
  }
  return rounded_text(shown) + " " + unit;
}

std::string dimension_name(const Dimension& dimension) {
  for (const Unit* unit : named_units())
    if (unit->dimension == dimension) return article(unit->quantity);
  return dimension == Dimension{} ? "a pure number" : "a quantity in " + si_unit(dimension);
}

bool is_quantity(std::string_view text, const Dimension& dimension) {
  const auto number = leading_number(trimmed(text));
  const auto unit = number ? parse_unit(trimmed(number->rest), foreign_scale) : std::nullopt;
  return unit && unit->dimension == dimension;
}

double parse_quantity(std::string_view given, const Unit& wanted) {
  const std::string text = trimmed(given);
  const auto number = leading_number(text);
  const auto got = [&] { return ", got `" + text + "`"; };
  if (!number) refuse(wanted, got() + "; write it as `1 " + wanted.symbol + "`");
  if (number->out_of_range)
    refuse(wanted,
           got() + ", which no double can hold; write a number between 1e-300 and 1e300 in size");
  if (!std::isfinite(number->value))
    refuse(wanted, got() + "; write a finite number, as `1 " + wanted.symbol + "`");
  const std::string unit_text = trimmed(number->rest);
  const auto parsed = parse_unit(unit_text);
  if (!parsed || !(parsed->dimension == wanted.dimension)) {
    const std::string digits = text.substr(0, text.size() - number->rest.size());
    const std::string_view meant =
        unit_text.empty() ? plausible_unit(number->value, wanted.symbol) : wanted.symbol;
    const std::string remedy = "; write it as `" + digits + " " + std::string(meant) + "`";
    if (unit_text.empty()) refuse(wanted, " with its unit" + got() + remedy);
    if (parsed) refuse(wanted, got() + ", " + dimension_name(parsed->dimension) + remedy);
    for (const auto& scale_of : {foreign_scale, mass_scale})
      if (const auto foreign = parse_unit(unit_text, scale_of);
          foreign && foreign->dimension == wanted.dimension)
        refuse(wanted, got() + " with the unknown unit `" + unit_text + "`; write it as `" +
                           rounded_text(wanted.from_si(foreign->to_si(number->value)), 15) + " " +
                           wanted.symbol + "`");
    if (unit_text.size() > 1 && unit_text[0] == ',' && std::isdigit(unit_text[1]) != 0) {
      std::string whole = digits;
      std::erase(whole, '.');  // between thousands
      refuse(wanted, got() + "; write it with a decimal point, as `" + whole + "." +
                         unit_text.substr(1) + "`");
    }
    const auto near = nearest_unit(unit_text, wanted.dimension);
    const bool short_unit = unit_text.size() <= 100;
    refuse(wanted, got() + " with " +
                       (short_unit ? "the unknown unit `" + unit_text + "`" : "an unknown unit") +
                       (near ? "; did you mean `" + digits + " " + *near + "`?" : remedy));
  }
  const double si = number->value / parsed->per * parsed->times;
  if (!std::isfinite(si))
    refuse(wanted, got() + ", which no double can hold in SI units; write a smaller number");
  return si;
}

std::string quantity_text(double si, const Unit& shown) {
  double value = shown.from_si(si);
  for (const double candidate :
       {value, std::nextafter(value, -INFINITY), std::nextafter(value, INFINITY)})
    if (shown.to_si(candidate) == si) return number_text(candidate) + " " + shown.symbol;
  return number_text(si) + " " + si_unit(shown.dimension);
}

}  // namespace palpate
