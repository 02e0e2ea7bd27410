// Tables of tissues: material properties with their sources.
#pragma once

#include <optional>
#include <string>
#include <utility>
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
  // Viscosity; a material without any of these is elastic.
  std::optional<Sourced> retardation_time;     // s, Kelvin-Voigt tau = eta / E
  std::optional<Sourced> relaxation_time;      // s, standard linear solid
  std::optional<Sourced> instantaneous_ratio;  // E_0 / E_inf of the standard linear solid
  std::optional<Sourced> drag;                 // 1/s, nodal drag d / m of eq. (10)
};

// A material with the text of its file (empty for the built-in tables).
struct Found {
  Tissue tissue;
  std::string file_text;
};

// Finds a material. `name` is a built-in tissue of Chen 2007, or `file.toml#name` with the file
// relative to `folder`. Throws InputError: at `place` for an unknown name (with the nearest known
// one), and at the line of the file for mistakes in the table.
[[nodiscard]] Found find(const std::string& name, const std::string& folder, const Place& place);

// The names of the built-in materials with their titles.
[[nodiscard]] const std::vector<std::pair<std::string, std::string>>& builtin();

// The table of a built-in material as its file has it, with comments; empty for another name.
[[nodiscard]] std::string builtin_table(const std::string& name);

}  // namespace palpate::material
