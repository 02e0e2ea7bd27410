// The wide patch through which a contact loads and reads a mesh in motion.
#pragma once

#include <algorithm>
#include <array>

#include "contact/patch.h"

namespace palpate::contact {

// So many semi-axes of the contact, and at least so many spacings of the skin: there the mesh is
// finer than what it carries, and in statics gives way by less than the contact does by itself,
// which docs/theory.md (74) needs.
inline constexpr double wide_semi_axes = 3.0;
inline constexpr double wide_spacings = 1.5;

// The patch widened so, about the same point. `axes` are the contact's semi-axes, `spacing` the
// edge of the skin's triangles there, all in m.
[[nodiscard]] inline Patch wide_patch(Patch patch, const std::array<double, 2>& axes,
                                      double spacing) {
  patch.a = std::max(wide_semi_axes * axes[0], wide_spacings * spacing);
  patch.b = std::max(wide_semi_axes * axes[1], wide_spacings * spacing);
  return patch;
}

}  // namespace palpate::contact
