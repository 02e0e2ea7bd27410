// Rings by sweeping over the springs.
#include "tissue/part.h"

#include <numeric>

namespace palpate::tissue {

Part part_around(const Network& whole, std::span<const int> start, int rings) {
  std::vector<char> inside(whole.rest.size(), 0);
  for (const int node : start) inside[static_cast<std::size_t>(node)] = 1;
  std::vector<char> moving;
  for (int ring = 0; ring <= rings; ++ring) {
    moving = inside;
    for (const auto& [a, b] : whole.ends) {
      if (moving[static_cast<std::size_t>(a)] != 0) inside[static_cast<std::size_t>(b)] = 1;
      if (moving[static_cast<std::size_t>(b)] != 0) inside[static_cast<std::size_t>(a)] = 1;
    }
  }
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
    const int first = number[static_cast<std::size_t>(a)];
    const int second = number[static_cast<std::size_t>(b)];
    if (first < 0 || second < 0) continue;
    part.springs.push_back(static_cast<int>(s));
    part.network.ends.push_back({first, second});
    part.network.rest_length.push_back(whole.rest_length[s]);
    part.network.direction.push_back(whole.direction[s]);
    part.network.stiffness.push_back(whole.stiffness[s]);
  }
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
