// Each test is one linear solve: with the top lowered by the height, or under tractions.
#include "tissue/uniaxial.h"

#include "base/error.h"
#include "base/symmetric_solver.h"
#include "geometry/surface.h"

namespace palpate::tissue {
namespace {

// The mean increase of the distance between the two outer faces along an axis, over that distance.
double widening(const geometry::TetMesh& mesh, const Vector& displacement, int axis) {
  double low = mesh.nodes.front()[axis];
  double high = low;
  for (const Vec3& node : mesh.nodes) {
    low = std::min(low, node[axis]);
    high = std::max(high, node[axis]);
  }
  const double near = 1e-9 * (high - low);
  double apart = 0.0;
  for (const auto& [plane, sign] : {std::pair(low, -1.0), std::pair(high, 1.0)}) {
    double sum = 0.0;
    int count = 0;
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      if (std::abs(mesh.nodes[i][axis] - plane) > near) continue;
      sum += displacement[3 * static_cast<Eigen::Index>(i) + axis];
      ++count;
    }
    apart += sign * sum / count;
  }
  return apart / (high - low);
}

constexpr const char* not_rigid =
    "the spring network is not rigid: some nodes can move without stretching a spring; use more "
    "cells or another mesh kind";

// The static displacement under a load; of `held` degrees of freedom none.
Vector solve(const BlockMatrix& stiffness, const std::vector<char>& held, const Vector& load) {
  SymmetricSolver solver;
  Vector displacement;
  if (!solver.prepare(stiffness, held) || !solver.solve(load, displacement))
    throw MeshError(not_rigid);
  return displacement;
}

// Six degrees of freedom that prevent exactly the rigid motions of a body.
std::vector<char> held_lightly(const geometry::TetMesh& mesh) {
  std::vector<char> held(3 * mesh.nodes.size(), 0);
  const auto hold = [&](std::size_t node, Eigen::Index axis) {
    held[3 * node + as_index(axis)] = 1;
  };
  const auto farthest = [&](const auto& measure) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < mesh.nodes.size(); ++i)
      if (measure(mesh.nodes[i]) > measure(mesh.nodes[best])) best = i;
    return best;
  };
  const Vec3 first = mesh.nodes.front();
  const std::size_t second = farthest([&](const Vec3& x) { return (x - first).norm(); });
  const Vec3 line = mesh.nodes[second] - first;
  const std::size_t third = farthest([&](const Vec3& x) { return line.cross(x - first).norm(); });
  Eigen::Index along = 0;
  line.cwiseAbs().maxCoeff(&along);
  Eigen::Index around = 0;
  line.cross(mesh.nodes[third] - first).cwiseAbs().maxCoeff(&around);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    hold(0, axis);
    if (axis != along) hold(second, axis);
  }
  hold(third, around);
  return held;
}

}  // namespace

Uniaxial traction_test(const Network& network, const geometry::TetMesh& mesh) {
  const std::vector<char> held = held_lightly(mesh);
  const geometry::Skin skin = geometry::skin(mesh);
  const auto node = [&](int vertex) { return skin.nodes[as_index(vertex)]; };
  Vector load = Vector::Zero(3 * network.nodes());
  for (std::size_t t = 0; t < skin.surface.triangles.size(); ++t) {
    const Vec3 face = 0.5 * geometry::twice_area(skin.surface, static_cast<int>(t));
    for (const int vertex : skin.surface.triangles[t]) load[3 * node(vertex) + 2] += face.z() / 3.0;
  }
  // The tractions balance, so that the supports bear nothing.
  const Vector displacement = solve(stiffness_matrix(network), held, load);
  // mean strain = 1/V sum over the surface of (mean displacement) x (area vector)
  //                                                                       docs/theory.md [traction]
  Vec3 stretch = Vec3::Zero();
  for (std::size_t t = 0; t < skin.surface.triangles.size(); ++t) {
    const Vec3 face = 0.5 * geometry::twice_area(skin.surface, static_cast<int>(t));
    for (const int vertex : skin.surface.triangles[t])
      stretch += displacement.segment<3>(3 * node(vertex)).cwiseProduct(face) / 3.0;
  }
  stretch /= geometry::volume(mesh);
  Uniaxial result;
  result.young_modulus = 1.0 / stretch.z();
  result.poisson_ratio = -0.5 * (stretch.x() + stretch.y()) / stretch.z();
  return result;
}

Uniaxial uniaxial_test(const Network& network, const geometry::TetMesh& mesh, Base base, double top,
                       double area, Base platen) {
  double low = top;
  for (const Vec3& node : mesh.nodes) low = std::min(low, node.z());
  Uniaxial result;
  result.height = top - low;
  result.area = area;
  result.top = geometry::nodes_at_height(mesh, top);

  const std::vector<char> held = held_between_platens(mesh, base, top, platen);
  Vector prescribed = Vector::Zero(3 * network.nodes());
  for (const int node : result.top) prescribed[3 * node + 2] = -result.height;

  // K u = 0 at the free degrees of freedom: u = prescribed - K_ff^-1 (K prescribed)_f
  const BlockMatrix stiffness = stiffness_matrix(network);
  result.displacement = prescribed - solve(stiffness, held, stiffness * prescribed);

  const Vector force = stiffness * result.displacement;
  double reaction = 0.0;
  for (const int node : result.top) reaction -= force[3 * node + 2];
  for (const int node : result.top) result.shares.push_back(-force[3 * node + 2] / reaction);
  result.young_modulus = reaction / area;
  result.poisson_ratio =
      0.5 * (widening(mesh, result.displacement, 0) + widening(mesh, result.displacement, 1));
  return result;
}

}  // namespace palpate::tissue
