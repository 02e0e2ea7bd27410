// Van Gelder's rule, and the fit that makes each node's neighbourhood isotropic.
#include "tissue/stiffness.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "base/symmetric_solver.h"
#include "geometry/surface.h"
#include "tissue/network.h"

namespace palpate::tissue {
namespace {

// A fully symmetric tensor of fourth order: 15 components, each times the square root of its number
// of occurrences in the full tensor, so that the dot product is that of the full tensors.
using SymmetricTensor = std::array<double, 15>;

// n n n n for a unit vector; its length is 1.
SymmetricTensor fourth_power(const Vec3& n) {
  const double x = n.x();
  const double y = n.y();
  const double z = n.z();
  const double r4 = 2.0;
  const double r6 = std::sqrt(6.0);
  const double r12 = std::sqrt(12.0);
  return {x * x * x * x,       y * y * y * y,       z * z * z * z,      r4 * x * x * x * y,
          r4 * x * x * x * z,  r4 * y * y * y * x,  r4 * y * y * y * z, r4 * z * z * z * x,
          r4 * z * z * z * y,  r6 * x * x * y * y,  r6 * x * x * z * z, r6 * y * y * z * z,
          r12 * x * x * y * z, r12 * y * y * x * z, r12 * z * z * x * y};
}

// C / E at nu = 1/4, where lambda = mu = 0.4 E: C_xxxx = 3 mu, C_xxyy = mu, the rest 0.
SymmetricTensor isotropic() {
  const double r6 = std::sqrt(6.0);
  return {1.2, 1.2, 1.2, 0, 0, 0, 0, 0, 0, 0.4 * r6, 0.4 * r6, 0.4 * r6, 0, 0, 0};
}

// The moduli divided by the first one; they weight the volumes in all sums.
std::vector<double> relative(std::span<const double> young_modulus) {
  std::vector<double> weights(young_modulus.begin(), young_modulus.end());
  for (double& weight : weights) weight /= young_modulus[0];
  return weights;
}

// The weighted volume of the tetrahedra around each sorted edge, m^3.
std::vector<double> edge_volumes(const geometry::TetMesh& mesh,
                                 const std::vector<std::array<int, 2>>& edges,
                                 const std::vector<double>& weight) {
  std::vector<double> volumes(edges.size(), 0.0);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const double volume = geometry::signed_volume(mesh, static_cast<int>(t)) *
                          weight[as_index(mesh.region(static_cast<int>(t)))];
    for (const auto& [i, j] : geometry::corner_edges) {
      const int a = mesh.tetrahedra[t][as_index(i)];
      const int b = mesh.tetrahedra[t][as_index(j)];
      const std::array<int, 2> edge{std::min(a, b), std::max(a, b)};
      const auto found = std::ranges::lower_bound(edges, edge);
      volumes[as_index(found - edges.begin())] += volume;
    }
  }
  return volumes;
}

Vec3 span_of(const geometry::TetMesh& mesh, const std::array<int, 2>& edge) {
  return mesh.nodes[as_index(edge[1])] - mesh.nodes[as_index(edge[0])];
}

}  // namespace

std::vector<double> van_gelder_stiffness(const geometry::TetMesh& mesh,
                                         std::span<const double> young_modulus) {
  const auto edges = geometry::edges(mesh);
  std::vector<double> stiffness = edge_volumes(mesh, edges, relative(young_modulus));
  for (std::size_t e = 0; e < edges.size(); ++e)
    stiffness[e] *= young_modulus[0] / span_of(mesh, edges[e]).squaredNorm();
  return stiffness;
}

SpringFit fit_springs(const geometry::TetMesh& mesh) {
  const auto edges = geometry::edges(mesh);
  const auto regions =
      mesh.regions.empty() ? std::size_t{1} : as_index(*std::ranges::max_element(mesh.regions)) + 1;
  const std::vector<double> alike(regions, 1.0);
  const std::vector<double> start = edge_volumes(mesh, edges, alike);
  const std::vector<double> volumes = node_volumes(mesh, alike);
  std::vector<SymmetricTensor> powers;
  powers.reserve(edges.size());
  for (const auto& edge : edges) powers.push_back(fourth_power(span_of(mesh, edge).normalized()));

  // The unknowns are y_e = k_e l_e^2 / E, in m^3; `missing` is V_v C/E - sum 1/2 y_e nnnn.
  std::vector<double> y = start;
  std::vector<SymmetricTensor> missing(volumes.size());
  const SymmetricTensor target = isotropic();
  for (std::size_t v = 0; v < volumes.size(); ++v)
    for (std::size_t c = 0; c < target.size(); ++c) missing[v][c] = volumes[v] * target[c];
  const auto add = [&](std::size_t e, double change) {
    for (const int node : edges[e])
      for (std::size_t c = 0; c < target.size(); ++c)
        missing[as_index(node)][c] -= 0.5 * change * powers[e][c];
  };
  for (std::size_t e = 0; e < edges.size(); ++e) add(e, y[e]);

  // Projected coordinate descent: each y_e in turn is set to its best value. The weak second term
  // of [fitted] makes the problem strictly convex: the sweeps converge to its only solution.
  constexpr double pull = 1e-3;
  constexpr double least = 0.1;  // of Van Gelder's: without it flat cells lose springs and rigidity
  constexpr int most_sweeps = 2000;
  // On large meshes, steps beyond the best value of one unknown settle in fewer sweeps.
  const bool large = volumes.size() >= 2000;
  const double beyond = large ? 1.8 : 1.0;
  const double settled = large ? 1e-6 : 1e-9;
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double largest_change = 0.0;
    for (std::size_t e = 0; e < edges.size(); ++e) {
      double slope = pull * (start[e] - y[e]);
      for (const int node : edges[e])
        for (std::size_t c = 0; c < target.size(); ++c)
          slope += 0.5 * missing[as_index(node)][c] * powers[e][c];
      const double change = std::max(least * start[e], y[e] + beyond * slope / (0.5 + pull)) - y[e];
      if (change == 0.0) continue;
      y[e] += change;
      add(e, change);
      largest_change = std::max(largest_change, std::abs(change) / start[e]);
    }
    if (largest_change < settled) break;
  }
  return {std::move(y), start};
}

std::vector<double> fitted_stiffness(const geometry::TetMesh& mesh, const SpringFit& fit,
                                     std::span<const double> young_modulus) {
  const auto edges = geometry::edges(mesh);
  const std::vector<double> stiffer = edge_volumes(mesh, edges, relative(young_modulus));
  std::vector<double> stiffness(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e)
    stiffness[e] = fit.fitted[e] * (stiffer[e] / fit.van_gelder[e]) * young_modulus[0] /
                   span_of(mesh, edges[e]).squaredNorm();
  return stiffness;
}

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
    "the springs are not rigid together: some nodes can move without stretching a spring; use more "
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
  const geometry::OuterSurface outer_surface = geometry::outer_surface(mesh);
  const auto node = [&](int vertex) { return outer_surface.nodes[as_index(vertex)]; };
  Vector load = Vector::Zero(3 * network.nodes());
  for (std::size_t t = 0; t < outer_surface.surface.triangles.size(); ++t) {
    const Vec3 face = 0.5 * geometry::twice_area(outer_surface.surface, static_cast<int>(t));
    for (const int vertex : outer_surface.surface.triangles[t])
      load[3 * node(vertex) + 2] += face.z() / 3.0;
  }
  // The tractions balance, so that the supports bear nothing.
  const Vector displacement = solve(stiffness_matrix(network), held, load);
  // mean strain = 1/V sum over the surface of (mean displacement) x (area vector)
  //                                                                       docs/theory.md [traction]
  Vec3 stretch = Vec3::Zero();
  for (std::size_t t = 0; t < outer_surface.surface.triangles.size(); ++t) {
    const Vec3 face = 0.5 * geometry::twice_area(outer_surface.surface, static_cast<int>(t));
    for (const int vertex : outer_surface.surface.triangles[t])
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
