// What is sought, and between which bounds.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/units.h"
#include "scenario/scenario.h"

namespace palpate::fit {

struct Unknown {
  enum class What { key, contact_point, force_offset };
  enum class Scale { linear, logarithmic };

  std::string key;  // a scenario's, or `contact_point` or `force_offset`
  What what = What::key;
  Scale scale = Scale::linear;
  std::optional<Unit> unit;  // to be shown in; nothing: a pure number
  double low = 0.0;          // SI
  double high = 0.0;

  // Searches go over the box [0, 1]: p = low + u (high - low), or p = low (high / low)^u.
  [[nodiscard]] double value(double u) const;
  [[nodiscard]] double inverse(double value) const;
  [[nodiscard]] double slope(double u) const;  // dp / du
  // As people read it: in the unit, or bare.
  [[nodiscard]] double shown(double si) const { return unit ? unit->from_si(si) : si; }
  [[nodiscard]] std::string unit_text() const { return unit ? unit->symbol : ""; }
};

// Reads `KEY=LOW..HIGH`, as `tissue.young_modulus=1 kPa..200 kPa` or `...=1..200 kPa`, against the
// scenario's keys. Logarithmic are quantities that are positive by their nature. Throws InputError
// with a sentence that names `--unknown`: no such key (and the nearest one), a key that does not
// count in this scenario, a bound of another dimension or beyond the key's limits, bounds in the
// wrong order, a key given twice.
[[nodiscard]] std::vector<Unknown> read_unknowns(const std::vector<std::string>& texts,
                                                 const scenario::Scenario& scenario);

// The scenario with the unknowns that are keys of it set; `values` in SI, in their order.
void set_unknowns(scenario::Scenario& scenario, std::span<const Unknown> unknowns,
                  std::span<const double> values);

}  // namespace palpate::fit
