// A node as the loops over four numbers at a time see it. Included only by the .cpp files of such
// loops.
#pragma once

namespace palpate::tissue {

using Four = double __attribute__((vector_size(32)));

// A node's displacement and force share a cache line.
struct alignas(64) FastNode {
  double displacement[4] = {};  // m; the fourth is padding or, in edge_loops.h, a pressure
  double force[4] = {};         // N; the fourth is unused
};

}  // namespace palpate::tissue
