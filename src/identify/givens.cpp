// Central differences of the estimates with respect to the givens.
#include "identify/givens.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/error.h"
#include "base/text.h"
#include "scenario/numeric_keys.h"

namespace palpate::identify {
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
  const auto known =
      std::find_if(keys.begin(), keys.end(), [&](const auto& one) { return one.path == key; });
  if (known == keys.end()) {
    std::vector<std::string> names;
    for (const auto& one : keys) names.push_back(one.path);
    const auto near = nearest(key, names);
    refuse_given(text, "names no number of this scenario" +
                           (near ? "; did you mean `" + *near + "`?"
                                 : std::string("; `palpate manual` lists the keys")));
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
