// The only file that includes OpenMesh.
#include "geometry/half_edges.h"

#include <OpenMesh/Core/Mesh/Traits.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>
#include <string>

#include "base/error.h"

namespace palpate::geometry {
namespace {

struct Traits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using Mesh = OpenMesh::TriMesh_ArrayKernelT<Traits>;

OpenMesh::VertexHandle vertex_handle(int vertex) { return OpenMesh::VertexHandle(vertex); }

// Why add_face() refused a triangle.
Joints::Refused refused(const Mesh& mesh, int triangle, const std::array<int, 3>& corners) {
  Joints::Refused found{.triangle = triangle, .from = -1, .to = -1, .others = {}};
  for (std::size_t i = 0; i < 3; ++i) {
    found.from = corners[i];
    found.to = corners[(i + 1) % 3];
    const auto taken = mesh.find_halfedge(vertex_handle(found.from), vertex_handle(found.to));
    if (!taken.is_valid() || taken.is_boundary()) continue;
    found.others = {taken.face().idx()};
    if (!taken.opp().is_boundary()) found.others.push_back(taken.opp().face().idx());
    std::ranges::sort(found.others);
    return found;
  }
  // Triangles all around a vertex leave no gap for another; otherwise there are several gaps.
  const auto shut = [&](int vertex) { return !mesh.is_boundary(vertex_handle(vertex)); };
  const auto torn = [&](int vertex) { return !mesh.is_manifold(vertex_handle(vertex)); };
  const auto* at = std::ranges::find_if(corners, shut);
  if (at == corners.end()) at = std::ranges::find_if(corners, torn);
  found.from = at == corners.end() ? corners[0] : *at;
  found.to = -1;
  for (const auto face : mesh.vf_range(vertex_handle(found.from)))
    found.others.push_back(face.idx());
  found.others = {*std::ranges::min_element(found.others)};
  return found;
}

// Adds triangles until one is refused.
std::optional<Joints::Refused> join(const Surface& surface, Mesh& mesh) {
  // It reports refused faces on the standard error output.
  [[maybe_unused]] static const bool silent = (omerr().disable(), true);
  mesh.reserve(surface.vertices.size(), surface.triangles.size() * 3 / 2 + 2,
               surface.triangles.size());
  for (const Vec3& vertex : surface.vertices)
    mesh.add_vertex(Mesh::Point(vertex.x(), vertex.y(), vertex.z()));
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const auto& [a, b, c] = surface.triangles[t];
    if (!mesh.add_face(vertex_handle(a), vertex_handle(b), vertex_handle(c)).is_valid())
      return refused(mesh, static_cast<int>(t), surface.triangles[t]);
  }
  return std::nullopt;
}

// Stores lists in one array, for list_of().
void pack(std::vector<int>&& list, std::vector<int>& starts, std::vector<int>& items) {
  if (starts.empty()) starts.push_back(0);
  std::ranges::sort(list);
  items.insert(items.end(), list.begin(), list.end());
  starts.push_back(static_cast<int>(items.size()));
}

}  // namespace

Joints joints(const Surface& surface) {
  Mesh mesh;
  Joints found;
  found.refused = join(surface, mesh);
  if (found.refused) return found;

  std::vector<char> seen(mesh.n_halfedges(), 0);
  for (const auto start : mesh.halfedges()) {
    if (!start.is_boundary() || seen[as_index(start.idx())] != 0) continue;
    std::vector<Joints::OpenEdge>& hole = found.holes.emplace_back();
    for (auto edge = start; seen[as_index(edge.idx())] == 0; edge = edge.next()) {
      seen[as_index(edge.idx())] = 1;
      hole.push_back({edge.to().idx(), edge.from().idx(), edge.opp().face().idx()});
    }
  }

  found.part.assign(surface.triangles.size(), -1);
  for (const auto first : mesh.faces()) {
    if (found.part[as_index(first.idx())] >= 0) continue;
    const int part = static_cast<int>(found.first_triangles.size());
    found.first_triangles.push_back(first.idx());
    found.part[as_index(first.idx())] = part;
    std::vector<OpenMesh::FaceHandle> reached{first};
    for (std::size_t i = 0; i < reached.size(); ++i)
      for (const auto next : mesh.ff_range(reached[i]))
        if (int& own = found.part[as_index(next.idx())]; own < 0) {
          own = part;
          reached.push_back(next);
        }
  }
  return found;
}

Neighbours::Neighbours(const Surface& surface) {
  Mesh mesh;
  if (const auto refused = join(surface, mesh))
    throw MeshError("face " + std::to_string(refused->triangle) +
                    " of a surface cannot be joined to the faces before it at vertex " +
                    std::to_string(refused->from) +
                    "; keep at most two faces at every edge, and one fan of faces at every vertex");
  for (const auto vertex : mesh.vertices()) {
    std::vector<int> triangles, vertices;
    for (const auto face : mesh.vf_range(vertex)) triangles.push_back(face.idx());
    for (const auto other : mesh.vv_range(vertex)) vertices.push_back(other.idx());
    pack(std::move(triangles), triangle_starts_, triangles_);
    pack(std::move(vertices), vertex_starts_, vertices_);
    on_boundary_.push_back(!vertices_.empty() && mesh.is_boundary(vertex) ? 1 : 0);
  }
  for (const auto face : mesh.faces()) {
    auto edge = face.halfedge();
    while (edge.from().idx() != surface.triangles[as_index(face.idx())][0]) edge = edge.next();
    std::array<int, 3>& across = across_.emplace_back();
    for (int& other : across) {
      other = edge.opp().face().idx();  // -1 if there is none
      edge = edge.next();
    }
  }
}

std::vector<SurfacePart> parts_of(const Surface& surface) {
  const Joints whole = joints(surface);
  std::vector<SurfacePart> parts(whole.first_triangles.size());
  for (std::size_t t = 0; t < whole.part.size(); ++t)
    parts[as_index(whole.part[t])].triangles.push_back(static_cast<int>(t));
  for (SurfacePart& part : parts) part.surface = piece_of(surface, part.triangles);
  return parts;
}

}  // namespace palpate::geometry
