// The table of models: name, requirements, abilities, error and cost of each model, in
// one table for the choice, `explain`, checks and the manual.
#pragma once

#include <string>

#include "base/words.h"
#include "tissue/coupled.h"

namespace palpate::scenario {

// In the order of cost.
enum class Model { hertz, layer, mass_spring, coupled_springs, solid };

struct ModelTraits {
  enum class Springs { none, independent, coupled };

  struct Cost {
    double once = 0.0;     // s, setup
    double layered = 0.0;  // s, additional setup with several layers
    double set_ups = 0.0;  // of a mesh of linear finite elements
  };

  Model of;
  const char* word;  // in scenarios
  const char* meaning;

  // What it needs: the springs of a mesh, for any body of finite size. A model without springs is a
  // closed form, for the scenarios that scene::beyond() accepts.
  Springs springs;
  tissue::Volume volume = tissue::Volume::none;  // the default of `solver.volume`

  // What it represents. Every model represents both curvatures and the viscosity of the tissue.
  bool thickness = false;  // of the specimen, and its base
  bool sides = false;      // of the specimen: any shape
  bool inertia = false;    // of the tissue
  bool uniform = false;    // creep and relaxation between platens
  bool own_ratio = false;  // the tissue's Poisson's ratio, away from the contact too
  bool eq_2 = false;       // its elastic force on a flat is exactly eq. (2)
  bool solid = false;      // finite strain on a mesh of its own, made for the press

  // Measured against converged elasticity (docs/accuracy.md).           docs/theory.md [choice]
  double waves = 0.0;   // share of the effect of inertia that a mesh misses
  double uneven = 0.0;  // error of the strain in a uniform test that is not uniform
  Cost cost = {};

  [[nodiscard]] constexpr bool meshed() const { return springs != Springs::none; }
  [[nodiscard]] constexpr bool formula() const { return !meshed() && !solid; }
  [[nodiscard]] constexpr bool independent() const { return springs == Springs::independent; }
  [[nodiscard]] constexpr bool coupled() const { return springs == Springs::coupled; }
};

inline constexpr auto model_table = std::to_array<ModelTraits>({
    {.of = Model::hertz,
     .word = "hertz",
     .meaning = "eq. (1)-(4), no mesh",
     .springs = ModelTraits::Springs::none,
     .own_ratio = true,
     .eq_2 = true,
     .cost = {.once = 1e-6}},
    {.of = Model::layer,
     .word = "layer",
     .meaning = "flat tissue of finite thickness, exact, no mesh",
     .springs = ModelTraits::Springs::none,
     .thickness = true,
     .own_ratio = true,
     .cost = {.once = 0.01, .layered = 0.05}},
    {.of = Model::mass_spring,
     .word = "mass_spring",
     .meaning = "the paper's springs along tetrahedron edges",
     .springs = ModelTraits::Springs::independent,
     .thickness = true,
     .sides = true,
     .inertia = true,
     .uniform = true,
     .waves = 0.15,
     .cost = {.set_ups = 2.5}},  // the springs' fit and test besides the finite elements
    {.of = Model::coupled_springs,
     .word = "coupled_springs",
     .meaning = "the same springs, coupled so that they have the tissue's E and nu",
     .springs = ModelTraits::Springs::coupled,
     .volume = tissue::Volume::nodal,
     .thickness = true,
     .sides = true,
     .inertia = true,
     .uniform = true,
     .own_ratio = true,
     .waves = 0.1,
     .uneven = 0.02,
     .cost = {.set_ups = 1.0}},
    {.of = Model::solid,
     .word = "solid",
     .meaning = "quadratic tetrahedra of its own with large strains, at rest: depth, edges, "
                "layers, inclusions",
     .springs = ModelTraits::Springs::none,
     .thickness = true,
     .sides = true,
     .own_ratio = true,
     .solid = true,
     .cost = {.once = 3.0}},
});
static_assert(is_complete<Model>(model_table),
              "the table has a row for every model, in their order");

[[nodiscard]] constexpr const ModelTraits& traits(Model model) {
  return model_table[as_index(model)];
}

// The most complete model of any scenario, with which the others are compared.
inline constexpr const ModelTraits& strongest = traits(Model::coupled_springs);

// The models for any scenario that satisfy `serves`, as part of a sentence: `solver.model = "a"` or
// `"b"`.
template <class Serves>
[[nodiscard]] std::string models_that(const Serves& serves) {
  std::string text;
  for (const ModelTraits& traits : model_table)
    if (serves(traits) && !traits.solid)
      text += (text.empty() ? "`solver.model = \"" : " or `\"") + std::string(traits.word) + "\"`";
  return text;
}

}  // namespace palpate::scenario
