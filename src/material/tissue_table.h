// Tables of tissues: what a material is made of, and who says so.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/document.h"

namespace palpate::material {

struct Sourced {
  double value = 0.0;  // SI
  std::string source;
};

struct Tissue {
  std::string title;
  Sourced density;        // kg/m^3
  Sourced young_modulus;  // Pa, of the relaxed material (E_inf)
  Sourced poisson_ratio;
  // Viscosity; a material without it answers elastically.
  std::optional<Sourced> retardation_time;     // s, Kelvin-Voigt tau = eta / E
  std::optional<Sourced> relaxation_time;      // s, standard linear solid
  std::optional<Sourced> instantaneous_ratio;  // E_0 / E_inf of the standard linear solid
  std::optional<Sourced> drag;                 // 1/s, nodal drag d / m of eq. (10)
};

// A material found by name, and the text it came from (empty for the built-in tables).
struct Found {
  Tissue tissue;
  std::string file_text;
};

// `name` is a table of the built-in Chen 2007 tissues, or `file.toml#name` with the file relative
// to `folder`. Throws InputError at `place` for an unknown name (with the nearest known one), and
// at the table's own lines for what is wrong in it.
[[nodiscard]] Found find(const std::string& name, const std::string& folder, const Place& place);

}  // namespace palpate::material
