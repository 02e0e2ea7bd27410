// Coupled springs: strain from elongations in closed form, and from it stiffness matrices.
#include "tissue/coupled.h"

#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <tuple>
#include <utility>

namespace palpate::tissue {
namespace {

using geometry::corner_edges;

// A tetrahedron in terms of its springs. With g_i the gradient of the function that is 1 at corner
// i and 0 at the others, the strain of the elongations is
//   eps = -sum_s e_s l_s (g_i g_j^T + g_j g_i^T) / 2,  s from i to j
// because x.eps x minus its linear interpolation is -sum_s x_i x_j l_s e_s in barycentric x.
struct Element {
  double volume = 0.0;                 // m^3
  std::array<int, 6> springs{};        // in the order of corner_edges
  Eigen::Matrix<double, 6, 1> length;  // m, at rest
  Eigen::Matrix4d products;            // g_i . g_j, 1/m^2

  // tr eps = sum_s dilation_s e_s,  dilation_s = -l_s g_i . g_j                             1/m
  [[nodiscard]] double dilation(int s) const {
    const auto& [i, j] = corner_edges[as_index(s)];
    return -length[s] * products(i, j);
  }

  // eps : eps = sum_st e_s e_t l_s l_t ((g_i.g_k)(g_j.g_m) + (g_i.g_m)(g_j.g_k)) / 2       1/m^2
  [[nodiscard]] double square(int s, int t) const {
    const auto& [i, j] = corner_edges[as_index(s)];
    const auto& [k, m] = corner_edges[as_index(t)];
    return 0.5 * length[s] * length[t] *
           (products(i, k) * products(j, m) + products(i, m) * products(j, k));
  }

  // S such that e.S e / 2 is V (mu (eps : eps - (tr eps)^2 / 3) + K (tr eps)^2 / 2),        N/m
  [[nodiscard]] CoupledSprings stiffness(double shear, double bulk) const {
    CoupledSprings six;
    six.springs = springs;
    for (int s = 0; s < 6; ++s)
      for (int t = 0; t <= s; ++t) {
        const double volumes = dilation(s) * dilation(t);
        six.stiffness(s, t) =
            volume * (2.0 * shear * (square(s, t) - volumes / 3.0) + bulk * volumes);
        six.stiffness(t, s) = six.stiffness(s, t);
      }
    return six;
  }
};

Element element(const Network& network, const geometry::TetMesh& mesh, std::size_t tetrahedron) {
  const auto& corners = mesh.tetrahedra[tetrahedron];
  Element result;
  result.volume = geometry::signed_volume(mesh, static_cast<int>(tetrahedron));
  // The columns of `edges` are the corners 1 to 3 relative to corner 0. The rows of its inverse are
  // the gradients of these corners; all four gradients sum to zero.
  Eigen::Matrix3d edges;
  for (int i = 0; i < 3; ++i)
    edges.col(i) =
        mesh.nodes[as_index(corners[as_index(i) + 1])] - mesh.nodes[as_index(corners[0])];
  Eigen::Matrix<double, 4, 3> gradients;
  gradients.bottomRows<3>() = edges.inverse();
  gradients.row(0) = -gradients.bottomRows<3>().colwise().sum();
  result.products = gradients * gradients.transpose();
  for (std::size_t s = 0; s < 6; ++s) {
    const int a = corners[as_index(corner_edges[s][0])];
    const int b = corners[as_index(corner_edges[s][1])];
    const std::array<int, 2> ends{std::min(a, b), std::max(a, b)};
    const auto found = std::ranges::lower_bound(network.ends, ends);
    assert(found != network.ends.end() && *found == ends);
    const auto spring = found - network.ends.begin();
    result.springs[s] = static_cast<int>(spring);
    result.length[static_cast<Eigen::Index>(s)] = network.rest_length[as_index(spring)];
  }
  return result;
}

std::vector<Element> elements(const Network& network, const geometry::TetMesh& mesh) {
  std::vector<Element> all;
  all.reserve(mesh.tetrahedra.size());
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) all.push_back(element(network, mesh, t));
  return all;
}

// The averaged volume of a node in one region: theta = sum_t V_t theta_t / sum_t V_t over the
// tetrahedra `around` it, with a quarter of their volume.
SharedVolume average(const std::vector<Element>& all, std::span<const int> around, int node,
                     double modulus) {
  std::vector<std::pair<int, double>> terms;  // spring, V_t dilation
  double sum = 0.0;
  for (const int t : around) {
    const Element& one = all[as_index(t)];
    sum += one.volume;
    for (int s = 0; s < 6; ++s)
      terms.emplace_back(one.springs[as_index(s)], one.volume * one.dilation(s));
  }
  std::ranges::stable_sort(terms, [](const auto& a, const auto& b) { return a.first < b.first; });
  SharedVolume shared;
  shared.stiffness = modulus * 0.25 * sum;
  shared.node = node;
  shared.volume = sum;
  for (const auto& [spring, change] : terms) {
    if (shared.springs.empty() || shared.springs.back() != spring) {
      shared.springs.push_back(spring);
      shared.dilation.push_back(0.0);
    }
    shared.dilation.back() += change / sum;
  }
  return shared;
}

// Adds a volume for every node and every region at it. `modulus` (Pa) has one entry per region.
void add_averages(Network& network, const geometry::TetMesh& mesh, const std::vector<Element>& all,
                  std::span<const double> modulus) {
  struct Use {
    int node, region, tetrahedron;
    auto operator<=>(const Use& other) const = default;
  };
  std::vector<Use> uses;
  uses.reserve(4 * all.size());
  for (int t = 0; t < static_cast<int>(all.size()); ++t)
    for (const int node : mesh.tetrahedra[as_index(t)]) uses.push_back({node, mesh.region(t), t});
  std::ranges::sort(uses);
  std::vector<int> around;
  for (std::size_t i = 0; i < uses.size(); ++i) {
    around.push_back(uses[i].tetrahedron);
    const bool last = i + 1 == uses.size() || uses[i + 1].node != uses[i].node ||
                      uses[i + 1].region != uses[i].region;
    if (!last) continue;
    const double own = modulus[as_index(uses[i].region)];
    if (own != 0.0) network.volumes.push_back(average(all, around, uses[i].node, own));
    around.clear();
  }
}

}  // namespace

double shear_modulus(const Isotropic& tissue) {
  return tissue.young_modulus / (2.0 * (1.0 + tissue.poisson_ratio));
}

double bulk_modulus(const Isotropic& tissue) {
  return tissue.young_modulus / (3.0 * (1.0 - 2.0 * tissue.poisson_ratio));
}

double spring_modulus(const Isotropic& tissue) {
  return 1.25 * tissue.young_modulus / (1.0 + tissue.poisson_ratio);
}

double volume_modulus(const Isotropic& tissue) {
  const double nu = tissue.poisson_ratio;
  return tissue.young_modulus * (4.0 * nu - 1.0) / (2.0 * (1.0 + nu) * (1.0 - 2.0 * nu));
}

void couple(Network& network, const geometry::TetMesh& mesh, std::span<const Isotropic> tissues,
            Volume volume, double own_share) {
  network.stiffness.assign(network.ends.size(), 0.0);
  network.coupled.clear();
  network.volumes.clear();
  std::vector<double> own;     // Pa, one per region: bulk modulus of single tetrahedra
  std::vector<double> shared;  // Pa, and of the averaged volumes
  for (const Isotropic& tissue : tissues) {
    const double bulk = volume == Volume::none ? 0.0 : bulk_modulus(tissue);
    own.push_back(volume == Volume::nodal ? std::min(bulk, own_share * shear_modulus(tissue))
                                          : bulk);
    shared.push_back(bulk - own.back());
  }
  const std::vector<Element> all = elements(network, mesh);
  network.coupled.reserve(all.size());
  for (std::size_t t = 0; t < all.size(); ++t) {
    const auto region = as_index(mesh.region(static_cast<int>(t)));
    network.coupled.push_back(all[t].stiffness(shear_modulus(tissues[region]), own[region]));
  }
  add_averages(network, mesh, all, shared);
}

void add_volume(Network& network, const geometry::TetMesh& mesh, std::span<const Isotropic> tissues,
                Volume volume) {
  if (volume == Volume::none) return;
  std::vector<double> modulus;
  for (const Isotropic& tissue : tissues) modulus.push_back(volume_modulus(tissue));
  const std::vector<Element> all = elements(network, mesh);
  if (volume == Volume::nodal) return add_averages(network, mesh, all, modulus);
  for (std::size_t t = 0; t < all.size(); ++t) {
    const double own = modulus[as_index(mesh.region(static_cast<int>(t)))];
    if (own != 0.0) network.coupled.push_back(all[t].stiffness(0.0, own));
  }
}

std::vector<Strain> small_strain(const geometry::TetMesh& mesh,
                                 std::span<const Vec3> displacement) {
  assert(displacement.size() == mesh.nodes.size());
  std::vector<Strain> strains;
  strains.reserve(mesh.tetrahedra.size());
  for (const auto& corners : mesh.tetrahedra) {
    const auto first = as_index(corners[0]);
    Eigen::Matrix3d edges, changes;
    for (int i = 0; i < 3; ++i) {
      const auto other = as_index(corners[as_index(i) + 1]);
      edges.col(i) = mesh.nodes[other] - mesh.nodes[first];
      changes.col(i) = displacement[other] - displacement[first];
    }
    // H X = U for the edges X and their changes U.
    const Eigen::Matrix3d gradient = changes * edges.inverse();
    strains.push_back(
        {gradient(0, 0), gradient(1, 1), gradient(2, 2), 0.5 * (gradient(0, 1) + gradient(1, 0)),
         0.5 * (gradient(1, 2) + gradient(2, 1)), 0.5 * (gradient(0, 2) + gradient(2, 0))});
  }
  return strains;
}

}  // namespace palpate::tissue
