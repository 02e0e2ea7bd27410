// Finds edges and faces by sorting, so that their order depends on the mesh only.
#include "geometry/tet_mesh.h"

#include <algorithm>
#include <cmath>

#include "geometry/box.h"

namespace palpate::geometry {

double signed_volume(const TetMesh& mesh, int tetrahedron) {
  const auto& corner = mesh.tetrahedra[as_index(tetrahedron)];
  const Vec3& a = mesh.nodes[as_index(corner[0])];
  const Vec3& b = mesh.nodes[as_index(corner[1])];
  const Vec3& c = mesh.nodes[as_index(corner[2])];
  const Vec3& d = mesh.nodes[as_index(corner[3])];
  // V = (b - a) x (c - a) . (d - a) / 6
  return (b - a).cross(c - a).dot(d - a) / 6.0;
}

double volume(const TetMesh& mesh) {
  double sum = 0.0;
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t)
    sum += signed_volume(mesh, static_cast<int>(t));
  return sum;
}

double diagonal(const TetMesh& mesh) {
  return mesh.nodes.empty() ? 0.0 : box_of(mesh.nodes).diagonal();
}

std::vector<std::array<int, 2>> edges(const TetMesh& mesh) {
  std::vector<std::array<int, 2>> found;
  found.reserve(6 * mesh.tetrahedra.size());
  for (const auto& corner : mesh.tetrahedra)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = i + 1; j < 4; ++j)
        found.push_back({std::min(corner[i], corner[j]), std::max(corner[i], corner[j])});
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::vector<FaceUse> face_uses(const TetMesh& mesh) {
  std::vector<FaceUse> uses;
  uses.reserve(4 * mesh.tetrahedra.size());
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const auto& corner = mesh.tetrahedra[t];
    for (const auto& [i, j, k] : outward_faces) {
      FaceUse use;
      use.nodes = {corner[as_index(i)], corner[as_index(j)], corner[as_index(k)]};
      use.key = use.nodes;
      std::ranges::sort(use.key);
      use.tetrahedron = static_cast<int>(t);
      uses.push_back(use);
    }
  }
  std::ranges::stable_sort(uses, {}, &FaceUse::key);
  return uses;
}

std::vector<std::array<int, 3>> boundary_faces(const TetMesh& mesh) {
  const std::vector<FaceUse> uses = face_uses(mesh);
  std::vector<FaceUse> single;
  for (std::size_t i = 0; i < uses.size(); ++i) {
    const bool like_before = i > 0 && uses[i - 1].key == uses[i].key;
    const bool like_after = i + 1 < uses.size() && uses[i + 1].key == uses[i].key;
    if (!like_before && !like_after) single.push_back(uses[i]);
  }
  const auto place = [&](const FaceUse& use) {  // the number of the face's opposite node
    const auto& corner = mesh.tetrahedra[as_index(use.tetrahedron)];
    int opposite = 0;
    while (std::ranges::count(use.key, corner[as_index(opposite)])) ++opposite;
    return opposite;
  };
  std::ranges::sort(single, [&](const FaceUse& a, const FaceUse& b) {
    if (a.tetrahedron != b.tetrahedron) return a.tetrahedron < b.tetrahedron;
    return place(a) < place(b);
  });
  std::vector<std::array<int, 3>> faces;
  faces.reserve(single.size());
  for (const FaceUse& use : single) faces.push_back(use.nodes);
  return faces;
}

std::vector<int> nodes_at_height(const TetMesh& mesh, double z) {
  const double tolerance = 1e-9 * diagonal(mesh);
  std::vector<int> found;
  for (std::size_t n = 0; n < mesh.nodes.size(); ++n)
    if (std::abs(mesh.nodes[n].z() - z) <= tolerance) found.push_back(static_cast<int>(n));
  return found;
}

}  // namespace palpate::geometry
