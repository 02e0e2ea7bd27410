// The unknowns of an identification, with their ranges and scales; and known numbers of a scenario
// with their uncertainty: `finger.radius=11 mm +- 0.2 mm`.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/units.h"
#include "scenario/family.h"

namespace palpate::identify {

struct Unknown {
  enum class What { key, contact_point, force_offset, force_tilt, force_gain, force_delay };
  enum class Scale { linear, logarithmic };

  std::string key;  // of the scenario, or `contact_point`, `force_offset`, `force_tilt` and so on
  std::vector<std::size_t> pairs = {0};  // of data and scenario in which it is this one unknown
  bool separate = false;                 // of one pair among several: its name ends with `@N`
  What what = What::key;
  Scale scale = Scale::linear;
  std::optional<Unit> unit;  // for input and output; nothing: a pure number
  double low = 0.0;          // SI
  double high = 0.0;

  // Maps u in [0, 1] to the value (SI): low + u (high - low), or low (high / low)^u.
  [[nodiscard]] double value(double u) const;
  [[nodiscard]] double inverse(double value) const;
  [[nodiscard]] double slope(double u) const;  // d value / du
  // The value in `unit`.
  [[nodiscard]] double shown(double si) const { return unit ? unit->from_si(si) : si; }
  [[nodiscard]] std::string name() const {
    return separate ? key + "@" + std::to_string(pairs.front() + 1) : key;
  }
  [[nodiscard]] std::string unit_text() const { return unit ? unit->symbol : ""; }
};

// Reads `KEY=LOW..HIGH`, such as `tissue.young_modulus=1 kPa..200 kPa` or `...=1..200 kPa`, with
// the scenario's list of keys. Quantities that are positive by nature get a logarithmic scale.
// Throws InputError with a sentence that names `--unknown` for an unknown key (with the nearest
// one), a key that the scenario does not use, a bound of another dimension or beyond the key's
// limits, bounds in the wrong order, and a key given twice. Of several scenarios a key is one
// unknown in all that have it; what belongs to a test or its sensor (contact_point, force_offset,
// force_tilt, force_gain, force_delay) is one unknown each. `KEY@2` is that of the second pair
// alone, `KEY@each` one each, `KEY@all` one for all.
[[nodiscard]] std::vector<Unknown> read_unknowns(
    const std::vector<std::string>& texts, std::span<const scenario::Scenario* const> scenarios);
[[nodiscard]] std::vector<Unknown> read_unknowns(const std::vector<std::string>& texts,
                                                 const scenario::Scenario& scenario);

// The number, SI, of a key with this unit. Throws std::invalid_argument with a clause "wants ...".
[[nodiscard]] double number_in(const std::string& written, const std::optional<Unit>& unit);

// Sets those unknowns that are keys of the scenario; `values` in SI, in the order of `unknowns`.
void set_unknowns(scenario::Scenario& scenario, std::span<const Unknown> unknowns,
                  std::span<const double> values);

// A key of the scenario with its value and standard deviation, SI.
struct Given {
  std::string key;
  std::optional<Unit> unit;
  double value = 0.0;
  double deviation = 0.0;
};

// Reads `KEY=VALUE +- SD`, with `+-` or the plus-minus sign. Throws InputError for unknown keys,
// for keys that are unknowns as well, for numbers outside the key's limits and for deviations that
// are not above 0.
[[nodiscard]] std::vector<Given> read_givens(const std::vector<std::string>& texts,
                                             const scenario::Scenario& scenario,
                                             const std::vector<Unknown>& unknowns);

// Sets the values in the family's first case.
void set_givens(scenario::Family& family, const std::vector<Given>& givens);

}  // namespace palpate::identify
