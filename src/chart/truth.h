// The reference solution from which the errors of a chart are computed, with its own error.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "chart/design.h"
#include "chart/history.h"

namespace palpate::chart {

struct Extrapolated {
  double value = 0.0;
  double error = 0.0;  // estimated, in the unit of the value, not negative
  double order = 0.0;  // observed p, from 1/2 to 3; 0 if the values show no order
};

// Fits value + C h^p to the last three of `values`, computed with decreasing `spacings` h; p is the
// observed order, but at least 1/2. The error is the correction of the finest value, but at least
// half the last change. If the values oscillate or converge faster than p = 3, the value is the
// finest one, and the error their spread. Two values are extrapolated with p = 1 and twice the
// error; one value gets an infinite error. docs/theory.md [extrapolation]
[[nodiscard]] Extrapolated extrapolate(std::span<const double> spacings,
                                       std::span<const double> values);

}  // namespace palpate::chart

namespace palpate::integrate {
struct KnownModes;
}

namespace palpate::chart {

inline constexpr double most_modal_nodes = 1000.0;  // of `modal` with all modes

struct Truth {
  std::string kind;      // "closed form", "refined", "own mesh" or "modal", for the table
  std::string sentence;  // description
  History moments;       // with their errors
};

// Computes the best reference available for a case:
//   a half-space            `hertz`, with the factor of deep presses if that matters
//   a flat whose sides and  `layer`; its error is the estimated effect of sides and inertia
//   inertia change less     (refined meshes are not more accurate), if it is not deep
//   than 0.5 % of the force
//   a uniform test between  the material's creep or relaxation; its error is the effect of inertia,
//   slippery platens        computed by `modal` on a mesh of about 60 nodes
//   any other press         chart::refer() with at most 20 moments (50 if viscosity or inertia
//                           matters)
//   any other uniform test  coupled springs on three meshes, extrapolated, and what inertia adds
//   a ready mesh that moves coupled springs on it; its error is the estimated error of the model
// Says its stage by set_doing(). Throws Stopped, like with_settings(), scene::build() and
// chart::refer(), and MeshError if a run diverges.
[[nodiscard]] Truth find_truth(const Asked& asked, std::size_t of_case);

// The reference for errors of time integration: the variant's scenario by `modal` with substeps of
// 1/4 ms, in uniform tests of half a row, at the rows of coarsest_interval(); its error is the
// difference from substeps of twice that length.
// Nothing if `modal` cannot compute the scenario or was stopped. `known` keeps the modes.
[[nodiscard]] std::optional<History> exact_in_time(const Asked& asked, const Variant& variant,
                                                   integrate::KnownModes& known);

}  // namespace palpate::chart
