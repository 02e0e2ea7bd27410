// The data that the loops of LaneSprings read and write. Included only by lane_springs.cpp.
#pragma once

#include <cstddef>
#include <cstdint>

#include "tissue/springs.h"
#include "tissue/viscous.h"

namespace palpate::tissue {

// One number per lane, in one cache line.
struct alignas(64) Eight {
  double lane[8] = {};
};

// "8 per spring" means one number per lane for each spring. A node n is the first end of springs
// beginning[n] up to beginning[n + 1], and the second end of ending[ending_start[n]] and so on.
struct LaneData {
  std::size_t nodes = 0;
  std::size_t springs = 0;
  std::size_t branches = 0;
  bool coupled = false;
  const std::int32_t* first = nullptr;  // end nodes of each spring
  const std::int32_t* second = nullptr;
  const std::int32_t* beginning = nullptr;
  const std::int32_t* ending_start = nullptr;
  const std::int32_t* ending = nullptr;
  const double* along = nullptr;      // 3 per spring: direction at rest
  const double* stiffness = nullptr;  // N/m, 8 per spring
  double* displacement = nullptr;     // m, 24 per node
  double* moved = nullptr;            // m, 24 per node: w of the last step
  double* force = nullptr;            // N, 24 per node
  double* tension = nullptr;          // N, 8 per spring
  double* memory = nullptr;           // 8 (1 + branches) per spring, if there are branches
  const double* keep = nullptr;       // 8 per branch, like the next three
  const double* begin = nullptr;
  const double* end = nullptr;
  const double* ratio = nullptr;
  const double* mass = nullptr;         // kg, 8 per node
  const double* inverse = nullptr;      // 1/kg, 24 per node; 0 where held
  const double* square = nullptr;       // s^2, 8
  const double* rate = nullptr;         // 1/s, 8
  const double* drag = nullptr;         // 1/s, 8
  const double* jumped = nullptr;       // 8: if not 0, the work is that of load_after alone
  const double* drag_step = nullptr;    // s, 8: the time step, 0 in a consistent first step
  const double* load_before = nullptr;  // N, 24 per node
  const double* load_after = nullptr;
  const std::int32_t* loaded = nullptr;  // per node: entries of both loads there, of all lanes
  // Of coupled springs, as in EdgeForm. Slots beyond the nodes have forces as well, for sums.
  std::size_t edges = 0;
  std::size_t inner = 0;
  std::size_t slots = 0;  // 0 if there are no averaged volumes
  const std::int32_t* edge_ends = nullptr;
  const std::int32_t* edge_slots = nullptr;
  const double* change = nullptr;  // m^2
  const double* block = nullptr;   // N/m, 8 * 6 per edge
  const double* turn = nullptr;    // N/m, 8 * 3 per edge after the inner ones
  const double* weight = nullptr;  // Pa/m^3, 8 per slot
  double* pressure = nullptr;      // Pa, 8 per slot
  double* kinetic = nullptr;       // J, 8 each: energies of the last step
  double* work = nullptr;
  double* stored = nullptr;
  double* lost = nullptr;
  double* moved_squares = nullptr;  // J s
};

using LanePass = void (*)(const LaneData&);
struct LanePasses {
  LanePass advance = nullptr;
  LanePass springs = nullptr;
};

}  // namespace palpate::tissue
