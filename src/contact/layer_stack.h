// Waves of pressure on several elastic layers, bonded to each other, on a rigid base.
#pragma once

#include "contact/layer_integral.h"

namespace palpate::contact {

// L(u) of the wave number u = xi H > 0: how far a wave of pressure sinks into the layers, over a
// half-space of the top layer's tissue. Each layer carries four plane waves, two that fade from its
// top and two from its bottom; displacements and tractions go on across the faces, the surface is
// free of shear, the base is as layer.base says. Exact, for any nu up to 1/2; near u = 0, where the
// waves grow alike, to 1e-16 / u^3.                    Mindlin's solutions; docs/theory.md
[[nodiscard]] double stack_sinking(double u, const Layer& layer);

}  // namespace palpate::contact
