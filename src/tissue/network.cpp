// Masses and springs from tetrahedra.
#include "tissue/network.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace palpate::tissue {

std::vector<double> node_volumes(const geometry::TetMesh& mesh, std::span<const double> weight) {
  std::vector<double> volumes(mesh.nodes.size(), 0.0);
  for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
    const double quarter = 0.25 * geometry::signed_volume(mesh, static_cast<int>(t)) *
                           weight[as_index(mesh.region(static_cast<int>(t)))];
    for (const int node : mesh.tetrahedra[t]) volumes[as_index(node)] += quarter;
  }
  return volumes;
}

Network make_network(const geometry::TetMesh& mesh, std::span<const double> density,
                     std::vector<double> stiffness) {
  Network network;
  network.rest = mesh.nodes;
  network.node_mass = node_volumes(mesh, density);
  network.ends = geometry::edges(mesh);
  network.stiffness = std::move(stiffness);
  for (const auto& [a, b] : network.ends) {
    const Vec3 span = mesh.nodes[as_index(b)] - mesh.nodes[as_index(a)];
    network.rest_length.push_back(span.norm());
    network.direction.emplace_back(span / span.norm());
  }
  return network;
}

namespace {

// Copies the couplings that can load a moving node of the part. Those excluded cannot be strained:
// both ends of their springs are held or outside. If a tetrahedron has a moving corner, all its
// springs are in the part. A volume may be averaged around a node that is in the edge or just
// outside it; some of its springs are then missing, and these do not change their length.
void restrict_couplings(const Network& whole, const std::vector<int>& node_number, Part& part) {
  std::vector<int> number(whole.ends.size(), -1);
  for (std::size_t s = 0; s < part.springs.size(); ++s)
    number[as_index(part.springs[s])] = static_cast<int>(s);
  const auto in_part = [&](int spring) { return number[as_index(spring)]; };
  const auto moves = [&](int spring) {
    const auto& [a, b] = part.network.ends[as_index(spring)];
    return part.edge[as_index(a)] == 0 || part.edge[as_index(b)] == 0;
  };
  for (const CoupledSprings& six : whole.coupled) {
    CoupledSprings kept{.springs = {}, .stiffness = six.stiffness};
    std::transform(six.springs.begin(), six.springs.end(), kept.springs.begin(), in_part);
    if (std::all_of(kept.springs.begin(), kept.springs.end(), [](int s) { return s >= 0; }))
      part.network.coupled.push_back(kept);
  }
  for (const SharedVolume& volume : whole.volumes) {
    SharedVolume kept{
        .springs = {}, .dilation = {}, .stiffness = volume.stiffness, .volume = volume.volume};
    for (std::size_t k = 0; k < volume.springs.size(); ++k) {
      const int spring = in_part(volume.springs[k]);
      if (spring < 0) continue;
      kept.springs.push_back(spring);
      kept.dilation.push_back(volume.dilation[k]);
    }
    if (kept.springs.size() == volume.springs.size() && volume.node >= 0)
      kept.node = node_number[as_index(volume.node)];
    if (std::any_of(kept.springs.begin(), kept.springs.end(), moves))
      part.network.volumes.push_back(std::move(kept));
  }
}

}  // namespace

void reach_around(const Network& whole, std::span<const int> start, int rings, Reach& reach) {
  auto& [inside, moving] = reach;
  inside.assign(whole.rest.size(), 0);
  for (const int node : start) inside[as_index(node)] = 1;
  for (int ring = 0; ring <= rings; ++ring) {
    moving = inside;
    for (const auto& [a, b] : whole.ends) {
      if (moving[as_index(a)] != 0) inside[as_index(b)] = 1;
      if (moving[as_index(b)] != 0) inside[as_index(a)] = 1;
    }
  }
}

bool spans(const Part& part, const Reach& reach) {
  std::size_t next = 0;
  for (std::size_t n = 0; n < reach.inside.size(); ++n) {
    const bool known = next < part.nodes.size() && part.nodes[next] == static_cast<int>(n);
    if (known != (reach.inside[n] != 0)) return false;
    if (known && (part.edge[next++] != 0) != (reach.moving[n] == 0)) return false;
  }
  return true;
}

Part part_around(const Network& whole, std::span<const int> start, int rings) {
  Reach reach;
  reach_around(whole, start, rings, reach);
  const auto& [inside, moving] = reach;
  Part part;
  std::vector<int> number(whole.rest.size(), -1);
  for (std::size_t n = 0; n < inside.size(); ++n) {
    if (inside[n] == 0) continue;
    number[n] = static_cast<int>(part.nodes.size());
    part.nodes.push_back(static_cast<int>(n));
    part.edge.push_back(moving[n] == 0 ? 1 : 0);
    part.network.rest.push_back(whole.rest[n]);
    part.network.node_mass.push_back(whole.node_mass[n]);
  }
  for (std::size_t s = 0; s < whole.ends.size(); ++s) {
    const auto& [a, b] = whole.ends[s];
    const int first = number[as_index(a)];
    const int second = number[as_index(b)];
    if (first < 0 || second < 0) continue;
    part.springs.push_back(static_cast<int>(s));
    part.network.ends.push_back({first, second});
    part.network.rest_length.push_back(whole.rest_length[s]);
    part.network.direction.push_back(whole.direction[s]);
    part.network.stiffness.push_back(whole.stiffness[s]);
  }
  restrict_couplings(whole, number, part);
  return part;
}

Part whole_part(const Network& whole) {
  Part part;
  part.nodes.resize(whole.rest.size());
  std::iota(part.nodes.begin(), part.nodes.end(), 0);
  part.springs.resize(whole.ends.size());
  std::iota(part.springs.begin(), part.springs.end(), 0);
  part.edge.assign(whole.rest.size(), 0);
  part.network = whole;
  return part;
}

}  // namespace palpate::tissue
