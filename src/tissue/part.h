// A part of a network: some of its nodes and the springs between them.
#pragma once

#include <span>
#include <vector>

#include "tissue/network.h"

namespace palpate::tissue {

struct Part {
  std::vector<int> nodes;    // of the whole, ascending: node i of the part is nodes[i]
  std::vector<int> springs;  // of the whole, ascending
  std::vector<char> edge;    // one a node: 1 in the outermost ring, which is held
  Network network;
};

// The nodes within `rings` springs of any of `start`, and one ring more: its nodes are the edge.
[[nodiscard]] Part part_around(const Network& whole, std::span<const int> start, int rings);

// Which nodes those are, one flag a node of the whole. Allocates nothing when it is filled again.
struct Reach {
  std::vector<char> inside;  // the part's
  std::vector<char> moving;  // and not its edge
};
void reach_around(const Network& whole, std::span<const int> start, int rings, Reach& reach);
// Whether a part is of just those nodes.
[[nodiscard]] bool spans(const Part& part, const Reach& reach);

// All of it.
[[nodiscard]] Part whole_part(const Network& whole);

}  // namespace palpate::tissue
