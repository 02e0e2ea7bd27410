// Finds the held degrees of freedom from the nodes at the base and at the top.
#include "tissue/supports.h"

#include <algorithm>

#include "geometry/surface.h"

namespace palpate::tissue {

std::vector<char> held_by_base(const geometry::TetMesh& mesh, Base base, double base_height,
                               const Vec3& up) {
  std::vector<char> held(3 * mesh.nodes.size(), 0);
  const auto height = [&](const Vec3& node) { return node.dot(up); };
  double low = height(mesh.nodes.front());
  for (const Vec3& node : mesh.nodes) low = std::min(low, height(node));
  std::vector<int> nodes;
  const double rounding = 1e-9 * geometry::diagonal(mesh);
  for (const int node : geometry::outer_surface(mesh).nodes)
    if (height(mesh.nodes[as_index(node)]) <= low + std::max(0.0, base_height) + rounding)
      nodes.push_back(node);
  const auto hold = [&](int node, int axis) { held[as_index(3 * node + axis)] = 1; };
  for (const int node : nodes) {
    hold(node, 2);
    if (base == Base::bonded) {
      hold(node, 0);
      hold(node, 1);
    }
  }
  if (base == Base::frictionless) {
    // The node with the smallest x + y is pinned; the one with the largest x - y keeps its y.
    const auto place = [&](int node) { return mesh.nodes[as_index(node)]; };
    const int pin = *std::ranges::min_element(nodes, [&](int a, int b) {
      return place(a).x() + place(a).y() < place(b).x() + place(b).y();
    });
    const int guide = *std::ranges::max_element(nodes, [&](int a, int b) {
      return place(a).x() - place(a).y() < place(b).x() - place(b).y();
    });
    hold(pin, 0);
    hold(pin, 1);
    hold(guide, 1);
  }
  return held;
}

std::vector<char> held_between_platens(const geometry::TetMesh& mesh, Base base, double top,
                                       Base platen) {
  std::vector<char> held = held_by_base(mesh, base);
  for (const int node : geometry::nodes_at_height(mesh, top))
    for (int axis = platen == Base::bonded ? 0 : 2; axis < 3; ++axis)
      held[as_index(3 * node + axis)] = 1;
  return held;
}

}  // namespace palpate::tissue
