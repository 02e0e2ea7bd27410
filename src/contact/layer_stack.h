// Displacement of several bonded elastic layers on a rigid base under a sinusoidal pressure.
#pragma once

#include "contact/layer_integral.h"

namespace palpate::contact {

// L(u) for the wave number u = xi H > 0: the surface displacement under a sinusoidal pressure
// divided by that of a half-space of the top layer's tissue. Each layer has four plane waves, two
// that decay from its top and two from its bottom. Displacements and tractions are continuous
// between layers, the surface has no shear, and the base is that of layer.base. Exact for any nu up
// to 1/2, except for rounding of 1e-16 / u^3 near u = 0, where the waves become linearly dependent.
//                                           Mindlin's solutions; docs/theory.md [layer_stack]
[[nodiscard]] double stack_sinking(double u, const Layer& layer);

}  // namespace palpate::contact
