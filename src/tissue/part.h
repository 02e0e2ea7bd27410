// A part of a network: some of its nodes and the springs between them.
#pragma once

#include <span>
#include <vector>

#include "tissue/network.h"

namespace palpate::tissue {

struct Part {
  std::vector<int> nodes;    // numbers in the whole network, ascending: node i is nodes[i]
  std::vector<int> springs;  // numbers in the whole network, ascending
  std::vector<char> edge;    // one per node: 1 in the outermost ring, which is fixed
  Network network;
};

// The nodes at most `rings` springs away from `start`, and one more ring, which is the edge.
[[nodiscard]] Part part_around(const Network& whole, std::span<const int> start, int rings);

// The nodes of such a part, one flag per node of the whole network. Refilling allocates no memory.
struct Reach {
  std::vector<char> inside;  // in the part
  std::vector<char> moving;  // in the part and not in its edge
};
void reach_around(const Network& whole, std::span<const int> start, int rings, Reach& reach);
// Whether `part` has exactly these nodes and this edge.
[[nodiscard]] bool spans(const Part& part, const Reach& reach);

// The whole network as a part without an edge.
[[nodiscard]] Part whole_part(const Network& whole);

}  // namespace palpate::tissue
