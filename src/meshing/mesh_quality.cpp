// Computes the quality in one pass over the tetrahedra.
#include "meshing/mesh_quality.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace palpate::meshing {
namespace {

struct Extremes {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;

  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

}  // namespace

Quality quality(const geometry::TetMesh& mesh) {
  Quality found;
  Extremes angles;
  Extremes volumes;
  Extremes lengths;
  found.smallest_mean_ratio = 1.0;
  found.shortest_altitude = std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto at = [&](int local) -> const Vec3& {
      return mesh.nodes[as_index(mesh.tetrahedra[t][as_index(local)])];
    };
    const double volume = geometry::signed_volume(mesh, static_cast<int>(t));
    volumes.add(volume);

    std::array<Vec3, 4> twice_face;  // outward normals with twice the faces' areas as lengths
    for (std::size_t f = 0; f < 4; ++f) {
      const auto& [a, b, c] = geometry::outward_faces[f];
      twice_face[f] = (at(b) - at(a)).cross(at(c) - at(a));
      const double altitude = 6.0 * volume / twice_face[f].norm();
      if (altitude < found.shortest_altitude) {
        found.shortest_altitude = altitude;
        found.limiting_tetrahedron = static_cast<int>(t);
      }
    }

    Extremes edges;
    double squares = 0.0;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j) {
        const Vec3 edge = at(static_cast<int>(j)) - at(static_cast<int>(i));
        edges.add(edge.norm());
        squares += edge.squaredNorm();
        // The faces opposite to i and j meet in the other edge, at pi minus their normals' angle.
        const double angle = std::numbers::pi - angle_between(twice_face[i], twice_face[j]);
        angles.add(angle);
        const auto bins = static_cast<double>(found.angles.size());
        const double bin = std::clamp(angle / std::numbers::pi * bins, 0.0, bins - 1.0);
        ++found.angles[static_cast<std::size_t>(bin)];
      }
    lengths.add(edges.low);
    lengths.add(edges.high);
    found.largest_edge_ratio = std::max(found.largest_edge_ratio, edges.high / edges.low);
    const double root = std::cbrt(3.0 * volume);
    found.smallest_mean_ratio = std::min(found.smallest_mean_ratio, 12.0 * root * root / squares);
  }
  found.smallest_angle = angles.low;
  found.largest_angle = angles.high;
  found.smallest_volume = volumes.low;
  found.largest_volume = volumes.high;
  found.shortest_edge = lengths.low;
  found.longest_edge = lengths.high;
  return found;
}

}  // namespace palpate::meshing
