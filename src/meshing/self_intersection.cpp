// CGAL's box search with exact predicates: the only file that includes CGAL. The predicates use
// exact arithmetic by Boost where needed, so that nothing has to be linked.
#define CGAL_DISABLE_GMP 1
#include "meshing/self_intersection.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace palpate::meshing {

std::optional<std::array<int, 2>> self_intersection(const geometry::Surface& surface) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
  using Face = Mesh::Face_index;
  Mesh mesh;
  for (const Vec3& vertex : surface.vertices)
    mesh.add_vertex(Kernel::Point_3(vertex.x(), vertex.y(), vertex.z()));
  for (const auto& [a, b, c] : surface.triangles)
    mesh.add_face(Mesh::Vertex_index(static_cast<Mesh::size_type>(a)),
                  Mesh::Vertex_index(static_cast<Mesh::size_type>(b)),
                  Mesh::Vertex_index(static_cast<Mesh::size_type>(c)));
  std::vector<std::pair<Face, Face>> pairs;  // in a random order
  CGAL::Polygon_mesh_processing::self_intersections(mesh, std::back_inserter(pairs));
  std::optional<std::array<int, 2>> lowest;
  for (const auto& [f, g] : pairs) {
    const std::array<int, 2> pair{static_cast<int>(std::min(f, g)),
                                  static_cast<int>(std::max(f, g))};
    if (!lowest || pair < *lowest) lowest = pair;
  }
  return lowest;
}

}  // namespace palpate::meshing
