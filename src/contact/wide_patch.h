// The wide patch, through which a moving mesh is loaded and its displacement averaged.
#pragma once

#include <algorithm>
#include <array>

#include "contact/patch.h"

namespace palpate::contact {

// Size of the wide patch in semi-axes of the contact, and its least size in spacings of the
// surface. At this size the mesh is finer than its load, and its static compliance is below that of
// the contact, as docs/theory.md [inertia] requires.
inline constexpr double wide_semi_axes = 3.0;
inline constexpr double wide_spacings = 1.5;

// The widened patch about the same point. `axes` are the contact's semi-axes and `spacing` is the
// edge length of the surface's triangles there, all in m.
[[nodiscard]] inline Patch wide_patch(Patch patch, const std::array<double, 2>& axes,
                                      double spacing) {
  patch.a = std::max(wide_semi_axes * axes[0], wide_spacings * spacing);
  patch.b = std::max(wide_semi_axes * axes[1], wide_spacings * spacing);
  return patch;
}

}  // namespace palpate::contact
