// Coarser or more even triangles for a surface that is too fine, or has needles, for a mesh.
#pragma once

#include <optional>
#include <vector>

#include "geometry/surface.h"

namespace palpate::meshing {

// A triangle whose altitude is below a fifteenth of its longest edge: TetGen keeps it, and the flat
// tetrahedra on it limit the stable time step.
[[nodiscard]] std::size_t count_needles(const geometry::Surface& surface);

// The edge length (m) with which even triangles would be as many. An equilateral triangle of edge l
// has an area of sqrt(3) / 4 l^2.
[[nodiscard]] double spacing_of(const geometry::Surface& surface);

// The edge length (m) with which a mesh of the body inside `surface` has about `nodes` nodes.
[[nodiscard]] double cell_for(const geometry::Surface& surface, int nodes);

struct Remeshed {
  geometry::Surface surface;
  double distance = 0.0;  // m, the largest between the two surfaces, in both directions
};

// Around these places the surfaces have at most this distance from each other, m.
struct Nearer {
  std::vector<Vec3> places = {};  // m
  double radius = 0.0;            // m
  double distance = 0.0;
};

// A surface with edges of about `spacing` (m) for the same body. It has passed check_closed(), has
// the same volume within 0.5 %, keeps creases and has no needles, and its largest distance from
// `surface` is at most remeshing_limit(); where details do not allow that, its edges are shorter.
// Where no surface with half of the triangles (a sixth of 20 000 and more) is so near, one serves
// that is up to four times as far, but not around the places of `nearer`; of needles with sharp
// edges without such tries, and anywhere.
// Empty if no such surface with fewer triangles is found, or, of a surface with needles, with less
// than twice as many (or 2000). Where an edge of the body is sharper than five degrees, only 20 000
// triangles and more, whose edges are shorter around details alone and may stay needles, become
// fewer, and 2000 with needles.
// `surface` has passed check_closed(). The same arguments give the same bits.
[[nodiscard]] std::optional<Remeshed> remeshed(const geometry::Surface& surface, double spacing,
                                               const Nearer& nearer = {});

// An eighth of the spacing, but at most 0.5 % of the diagonal of the bounding box, m. A chord of
// the requested spacing on a round body with a radius of more than its length is nearer than that,
// so that a mesh of such cells does not show the difference.
[[nodiscard]] double remeshing_limit(const geometry::Surface& surface, double spacing);

}  // namespace palpate::meshing
