// Reads unknowns from the command line and checks them against the scenario's list of keys. Central
// differences of the estimates with respect to the givens.
#include "identify/unknowns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "base/error.h"
#include "base/text.h"
#include "identify/identify.h"

namespace palpate::identify {
namespace {

// Unknowns of a test or its sensor, which are no keys of a scenario.
struct Extra {
  const char* name;
  Unknown::What what;
  std::optional<Unit> unit;
  Range range;
};
const std::array<Extra, 5>& extras() {
  static const std::array<Extra, 5> all{{
      {"contact_point", Unknown::What::contact_point, unit::mm, {}},
      {"force_offset", Unknown::What::force_offset, unit::N, {}},
      {"force_tilt", Unknown::What::force_tilt, unit::N_per_m, {}},
      {"force_gain", Unknown::What::force_gain, std::nullopt, {.low = 0.0, .low_allowed = false}},
      {"force_delay", Unknown::What::force_delay, unit::s, {.low = 0.0, .low_allowed = true}},
  }};
  return all;
}

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  palpate::refuse("`--unknown " + shortened(text) + "` " + why);
}

struct Parts {
  std::string key, low = "", high = "";  // empty where they are missing
};

Parts parts_of(const std::string& text) {
  const std::size_t equals = std::min(text.find('='), text.size());
  const std::size_t dots = text.find("..", equals);
  Parts parts{.key = trimmed(std::string_view(text).substr(0, equals))};
  if (dots == std::string::npos) return parts;
  parts.low = trimmed(std::string_view(text).substr(equals + 1, dots - equals - 1));
  parts.high = trimmed(std::string_view(text).substr(dots + 2));
  return parts;
}

double bound(const std::string& text, const std::string& written, const std::optional<Unit>& unit) {
  try {
    return number_in(written, unit);
  } catch (const std::invalid_argument& wrong) {
    refuse(text, wrong.what() + std::string(unit ? "" : "; write `0.1..0.49`"));
  }
}

// Appends the unit of the upper bound to a lower bound without a unit, as in `1..200 kPa`.
std::string with_unit(const std::string& low, const std::string& high) {
  const auto first = leading_number(low);
  const auto second = leading_number(high);
  if (!first || !second || !trimmed(first->rest).empty()) return low;
  return low + " " + trimmed(second->rest);
}

std::string shown(double si, const std::optional<Unit>& unit) {
  return unit ? quantity_text(si, *unit) : number_text(si);
}

scenario::NumericKey find_key(const std::string& text, const std::string& name,
                              const std::vector<scenario::NumericKey>& keys) {
  for (const Extra& extra : extras())
    if (name == extra.name) return {name, extra.unit, extra.range, {}};
  const auto known = std::ranges::find_if(keys, [&](const auto& key) { return key.path == name; });
  if (known == keys.end()) {
    std::vector<std::string> names;
    for (const Extra& extra : extras()) names.emplace_back(extra.name);
    for (const auto& key : keys) names.push_back(key.path);
    const auto begun =
        std::ranges::find_if(names, [&](const std::string& one) { return one.starts_with(name); });
    std::optional<std::string> near = begun != names.end() ? *begun : nearest(name, names);
    if (!near) {  // without the table before it: `yong_modulus`
      std::vector<std::string> last;
      for (const std::string& one : names) last.push_back(one.substr(one.rfind('.') + 1));
      if (const auto part = nearest(name, last))
        near = names[as_index(std::ranges::find(last, *part) - last.begin())];
    }
    refuse(text,
           "names no number of this scenario" +
               (near ? "; did you mean `" + *near + "`?"
                     : "; `palpate manual` lists the keys, and `contact_point`, `force_offset`, "
                       "`force_tilt`, `force_gain` and `force_delay` are accepted too"));
  }
  if (!known->use.used)
    refuse(text, "names a key that is used " + known->use.when +
                     " only, so that no measurement of this scenario can determine it");
  return *known;
}

Unknown read_unknown(const std::string& text, const Parts& parts,
                     const std::vector<scenario::NumericKey>& keys) {
  const char* remedy = "is written `KEY=LOW..HIGH`, as `tissue.young_modulus=1 kPa..200 kPa`";
  if (parts.key.empty()) refuse(text, remedy);
  const scenario::NumericKey key = find_key(text, parts.key, keys);
  if (parts.low.empty() || parts.high.empty()) refuse(text, remedy);
  Unknown unknown;
  unknown.key = parts.key;
  unknown.unit = key.unit;
  for (const Extra& extra : extras())
    if (parts.key == extra.name) unknown.what = extra.what;
  unknown.low = bound(text, key.unit ? with_unit(parts.low, parts.high) : parts.low, key.unit);
  unknown.high = bound(text, parts.high, key.unit);
  if (!(unknown.low < unknown.high))
    refuse(text, "wants a lower bound below the upper one; exchange the two");
  const Range& range = key.range;
  if (!range.holds(unknown.low) || !range.holds(unknown.high)) {
    std::string limits;
    if (std::isfinite(range.low))
      limits += (range.low_allowed ? "at least " : "above ") + shown(range.low, key.unit);
    if (std::isfinite(range.high))
      limits += (limits.empty() ? "" : " and ") +
                std::string(range.high_allowed ? "at most " : "below ") +
                shown(range.high, key.unit);
    refuse(text, "leaves the limits of the key, which is " + limits + "; narrow the range");
  }
  // Quantities that must be positive are searched on a logarithmic scale.
  const bool positive = (key.unit || unknown.what == Unknown::What::force_gain) &&
                        range.low == 0.0 && !range.low_allowed;
  if (positive) unknown.scale = Unknown::Scale::logarithmic;
  return unknown;
}

}  // namespace

double number_in(const std::string& written, const std::optional<Unit>& unit) {
  if (unit) return parse_quantity(written, *unit);
  if (const auto number = whole_number(written)) return *number;
  throw std::invalid_argument("wants pure numbers, got `" + written + "`");
}

double Unknown::value(double u) const {
  return scale == Scale::logarithmic ? low * std::pow(high / low, u) : low + u * (high - low);
}

double Unknown::inverse(double value) const {
  return scale == Scale::logarithmic ? std::log(value / low) / std::log(high / low)
                                     : (value - low) / (high - low);
}

double Unknown::slope(double u) const {
  return scale == Scale::logarithmic ? value(u) * std::log(high / low) : high - low;
}

namespace {

using Keys = std::vector<scenario::NumericKey>;

bool knows(const Keys& keys, const std::string& name) {
  for (const Extra& extra : extras())
    if (name == extra.name) return true;
  return std::ranges::any_of(keys,
                             [&](const auto& key) { return key.path == name && key.use.used; });
}

// The pairs that `word` behind `@` names: a number, `each` or `all`; empty: by the key's nature.
std::vector<std::vector<std::size_t>> pairs_of(const std::string& text, const std::string& word,
                                               const std::string& key,
                                               const std::vector<Keys>& keys) {
  std::vector<std::size_t> all;
  for (std::size_t k = 0; k < keys.size(); ++k)
    if (knows(keys[k], key)) all.push_back(k);
  if (all.empty()) all = {0};
  const bool extra =
      std::ranges::any_of(extras(), [&](const Extra& one) { return key == one.name; });
  std::vector<std::vector<std::size_t>> each;
  for (const std::size_t k : all) each.push_back({k});
  if (word.empty()) return extra ? each : std::vector<std::vector<std::size_t>>{all};
  if (word == "each") return each;
  if (word == "all") return std::vector<std::vector<std::size_t>>{all};
  const auto number = whole_number(word);
  if (!number || *number != std::floor(*number) || !(*number >= 1.0) ||
      !(*number <= static_cast<double>(keys.size())))
    refuse(text, "names the pair `" + word + "`, and there are " + std::to_string(keys.size()) +
                     (keys.size() == 1 ? " pair" : " pairs") +
                     " of data and scenario; write a number, `each` or `all` behind `@`");
  return {{static_cast<std::size_t>(*number) - 1}};
}

}  // namespace

std::vector<Unknown> read_unknowns(const std::vector<std::string>& texts,
                                   std::span<const scenario::Scenario* const> scenarios) {
  std::vector<Keys> keys;
  for (const scenario::Scenario* each : scenarios) keys.push_back(scenario::numeric_keys(*each));
  std::vector<Unknown> unknowns;
  for (const std::string& text : texts) {
    Parts parts = parts_of(text);
    std::string word;
    if (const std::size_t at = parts.key.rfind('@'); at != std::string::npos) {
      word = parts.key.substr(at + 1);
      parts.key.resize(at);
    }
    for (const std::vector<std::size_t>& pairs : pairs_of(text, word, parts.key, keys)) {
      Unknown one = read_unknown(text, parts, keys[pairs.front()]);
      one.pairs = pairs;
      one.separate = scenarios.size() > 1 && pairs.size() == 1;
      for (const Unknown& other : unknowns)
        if (other.key == one.key && std::ranges::any_of(pairs, [&](std::size_t k) {
              return std::ranges::find(other.pairs, k) != other.pairs.end();
            }))
          refuse(text, "is given twice; keep one of the two ranges");
      unknowns.push_back(std::move(one));
    }
  }
  return unknowns;
}

std::vector<Unknown> read_unknowns(const std::vector<std::string>& texts,
                                   const scenario::Scenario& scenario) {
  const scenario::Scenario* const one = &scenario;
  return read_unknowns(texts, {&one, 1});
}

void set_unknowns(scenario::Scenario& scenario, std::span<const Unknown> unknowns,
                  std::span<const double> values) {
  for (std::size_t i = 0; i < unknowns.size(); ++i)
    if (unknowns[i].what == Unknown::What::key)
      (void)scenario::set_number(scenario, unknowns[i].key, values[i]);
}

namespace {

std::string quantity_or_number(double si, const std::optional<Unit>& unit) {
  return unit ? rounded_text(unit->from_si(si)) + " " + unit->symbol : rounded_text(si);
}

[[noreturn]] void refuse_given(const std::string& text, const std::string& why) {
  palpate::refuse("`--given " + text + "` " + why);
}

Given read_given(const std::string& text, const std::vector<scenario::NumericKey>& keys) {
  const std::string remedy = "is written `KEY=VALUE +- SD`, as `finger.radius=11 mm +- 0.2 mm`";
  const std::size_t equals = text.find('=');
  std::size_t sign = text.find("+-");
  std::size_t width = 2;
  if (sign == std::string::npos) sign = text.find("\u00b1");
  if (equals == std::string::npos || sign == std::string::npos || sign < equals)
    refuse_given(text, remedy);
  const std::string key = trimmed(text.substr(0, equals));
  const auto known = std::ranges::find_if(keys, [&](const auto& one) { return one.path == key; });
  if (known == keys.end()) {
    std::vector<std::string> names;
    for (const auto& one : keys) names.push_back(one.path);
    refuse_given(text, "names no number of this scenario; " +
                           did_you_mean(key, names, "`palpate manual` lists the keys"));
  }
  Given given{key, known->unit, 0.0, 0.0};
  try {
    given.value = number_in(trimmed(text.substr(equals + 1, sign - equals - 1)), known->unit);
    given.deviation = number_in(trimmed(text.substr(sign + width)), known->unit);
  } catch (const std::invalid_argument& wrong) {
    refuse_given(text, wrong.what());
  }
  if (!(given.deviation > 0.0)) refuse_given(text, "wants a deviation above 0");
  for (const double end : {given.value - given.deviation, given.value + given.deviation})
    if (!known->range.holds(end))
      refuse_given(text, "leaves the limits of the key within its deviation; give a smaller one");
  return given;
}

void set(scenario::Family& family, const Given& given, double value) {
  if (!scenario::set_number(family.cases.front().scenario, given.key, value))
    palpate::refuse("`--given` cannot set `" + given.key + "` in this scenario");
}

// Widens an end of an interval: the squares of its distance and of `spread` add up. On a
// logarithmic scale both are relative.
std::optional<double> widened(const std::optional<double>& end, const Identified& one,
                              double spread) {
  if (!end) return end;
  const bool logarithmic = one.unknown.scale == Unknown::Scale::logarithmic;
  const double away = logarithmic ? std::log(*end / one.estimate) : *end - one.estimate;
  const double more = logarithmic ? spread / one.estimate : spread;
  const double wide = std::copysign(std::hypot(away, more), away);
  return logarithmic ? one.estimate * std::exp(wide) : one.estimate + wide;
}

}  // namespace

std::vector<Given> read_givens(const std::vector<std::string>& texts,
                               const scenario::Scenario& scenario,
                               const std::vector<Unknown>& unknowns) {
  const std::vector<scenario::NumericKey> keys = scenario::numeric_keys(scenario);
  std::vector<Given> givens;
  for (const std::string& text : texts) {
    givens.push_back(read_given(text, keys));
    for (const Unknown& one : unknowns)
      if (one.key == givens.back().key)
        refuse_given(text, "names an unknown; leave one of the two out");
  }
  return givens;
}

void set_givens(scenario::Family& family, const std::vector<Given>& givens) {
  for (const Given& given : givens) set(family, given, given.value);
}

void carry_givens(Identification& found, const Measurement& measured,
                  const scenario::Family& family, const std::vector<Given>& givens, Noise noise) {
  std::vector<Unknown> unknowns;
  for (const Identified& one : found.unknowns) unknowns.push_back(one.unknown);
  const IdentifyOptions options{.noise = noise, .searches = 1, .profiles = false};
  std::vector<double> variance(unknowns.size(), 0.0);
  for (const Given& given : givens) {
    std::vector<std::vector<double>> ends;
    for (const double sign : {-1.0, 1.0}) {
      scenario::Family moved = family;
      set(moved, given, given.value + sign * given.deviation);
      const Identification end = identify(measured, moved, unknowns, options);
      ends.emplace_back();
      for (const Identified& one : end.unknowns) ends.back().push_back(one.estimate);
    }
    GivenPart part{given.key,
                   quantity_or_number(given.value, given.unit),
                   quantity_or_number(given.deviation, given.unit),
                   {}};
    for (std::size_t i = 0; i < unknowns.size(); ++i) {
      const double half = 0.5 * (ends[1][i] - ends[0][i]);
      part.deviations.push_back(std::abs(half));
      variance[i] += half * half;
    }
    found.givens.push_back(std::move(part));
  }
  constexpr double normal = 1.959963984540054;  // the quantile 0.975
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    Identified& one = found.unknowns[i];
    const double spread = normal * std::sqrt(variance[i]);
    if (one.std_error) one.std_error = std::hypot(*one.std_error, std::sqrt(variance[i]));
    for (auto* end : {&one.ci95_low, &one.ci95_high, &one.profile_low, &one.profile_high})
      *end = widened(*end, one, spread);
  }
}

}  // namespace palpate::identify
