// Reads unknowns from the command line and checks them against the scenario's list of keys.
#include "identify/unknowns.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/error.h"
#include "base/text.h"
#include "scenario/numeric_keys.h"

namespace palpate::identify {
namespace {

constexpr const char* contact_point = "contact_point";
constexpr const char* force_offset = "force_offset";

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  palpate::refuse("`--unknown " + text + "` " + why);
}

struct Parts {
  std::string key, low, high;
};

Parts parts_of(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::size_t dots = text.find("..", equals == std::string::npos ? 0 : equals);
  const char* remedy = "is written `KEY=LOW..HIGH`, as `tissue.young_modulus=1 kPa..200 kPa`";
  if (equals == std::string::npos || dots == std::string::npos) refuse(text, remedy);
  Parts parts{trimmed(std::string_view(text).substr(0, equals)),
              trimmed(std::string_view(text).substr(equals + 1, dots - equals - 1)),
              trimmed(std::string_view(text).substr(dots + 2))};
  if (parts.key.empty() || parts.low.empty() || parts.high.empty()) refuse(text, remedy);
  return parts;
}

double bound(const std::string& text, const std::string& written, const std::optional<Unit>& unit) {
  if (!unit) {
    const auto number = whole_number(written);
    if (!number) refuse(text, "wants pure numbers, got `" + written + "`; write `0.1..0.49`");
    return *number;
  }
  try {
    return parse_quantity(written, *unit);
  } catch (const std::invalid_argument& wrong) {
    refuse(text, wrong.what());
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
  if (name == contact_point) return {name, unit::mm, {}, {}};
  if (name == force_offset) return {name, unit::N, {}, {}};
  const auto known =
      std::find_if(keys.begin(), keys.end(), [&](const auto& key) { return key.path == name; });
  if (known == keys.end()) {
    std::vector<std::string> names{contact_point, force_offset};
    for (const auto& key : keys) names.push_back(key.path);
    const auto near = nearest(name, names);
    refuse(text, "names no number of this scenario" +
                     (near ? "; did you mean `" + *near + "`?"
                           : "; `palpate manual` lists the keys, and `contact_point` and "
                             "`force_offset` are accepted too"));
  }
  if (!known->use.used)
    refuse(text, "names a key that is used " + known->use.when +
                     " only, so that no measurement of this scenario can determine it");
  return *known;
}

Unknown read_unknown(const std::string& text, const std::vector<scenario::NumericKey>& keys) {
  const Parts parts = parts_of(text);
  const scenario::NumericKey key = find_key(text, parts.key, keys);
  Unknown unknown;
  unknown.key = parts.key;
  unknown.unit = key.unit;
  if (parts.key == contact_point) unknown.what = Unknown::What::contact_point;
  if (parts.key == force_offset) unknown.what = Unknown::What::force_offset;
  unknown.low = bound(text, key.unit ? with_unit(parts.low, parts.high) : parts.low, key.unit);
  unknown.high = bound(text, parts.high, key.unit);
  if (!(unknown.low < unknown.high)) refuse(text, "wants a lower bound below the upper one");
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
  const bool positive = key.unit && range.low == 0.0 && !range.low_allowed;
  if (positive) unknown.scale = Unknown::Scale::logarithmic;
  return unknown;
}

}  // namespace

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

std::vector<Unknown> read_unknowns(const std::vector<std::string>& texts,
                                   const scenario::Scenario& scenario) {
  const std::vector<scenario::NumericKey> keys = scenario::numeric_keys(scenario);
  std::vector<Unknown> unknowns;
  for (const std::string& text : texts) {
    unknowns.push_back(read_unknown(text, keys));
    for (std::size_t i = 0; i + 1 < unknowns.size(); ++i)
      if (unknowns[i].key == unknowns.back().key)
        refuse(text, "is given twice; keep one of the two ranges");
  }
  return unknowns;
}

void set_unknowns(scenario::Scenario& scenario, std::span<const Unknown> unknowns,
                  std::span<const double> values) {
  for (std::size_t i = 0; i < unknowns.size(); ++i)
    if (unknowns[i].what == Unknown::What::key)
      (void)scenario::set_number(scenario, unknowns[i].key, values[i]);
}

}  // namespace palpate::identify
