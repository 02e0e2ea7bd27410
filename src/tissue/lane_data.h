// What the loops of LaneSprings read and write. For lane_springs.cpp and its loops alone.
#pragma once

#include <cstddef>
#include <cstdint>

#include "tissue/springs.h"
#include "tissue/viscous.h"

namespace palpate::tissue {

// One number a lane, in one cache line.
struct alignas(64) Eight {
  double lane[8] = {};
};

// Where "8 a spring" stands, a spring has one number a lane.
struct LaneData {
  std::size_t nodes = 0;
  std::size_t springs = 0;
  std::size_t branches = 0;
  bool coupled = false;
  const std::int32_t* first = nullptr;  // node, as `second` one a spring
  const std::int32_t* second = nullptr;
  const std::int32_t* beginning = nullptr;     // the springs of which a node is the first end
  const std::int32_t* ending_start = nullptr;  // and those of which it is the second,
  const std::int32_t* ending = nullptr;        // in a list
  const double* along = nullptr;        // three a spring: direction, or unless linear span at rest
  const double* rest_length = nullptr;  // m
  const double* stiffness = nullptr;    // N/m, 8 a spring
  double* displacement = nullptr;       // m, 24 a node
  double* moved = nullptr;              // m, 24 a node: w of the last step
  double* force = nullptr;              // N, 24 a node
  double* scale = nullptr;              // 8 a spring: times `along` it is the pull
  double* memory = nullptr;             // 8 (1 + branches) a spring, where there are any
  double* elongation = nullptr;         // m, 8 a spring, where coupled
  const double* keep = nullptr;         // 8 a branch, as the next three
  const double* begin = nullptr;
  const double* end = nullptr;
  const double* ratio = nullptr;
  const double* mass = nullptr;         // kg, 8 a node
  const double* inverse = nullptr;      // 1/kg, 24 a node; 0 where held
  const double* square = nullptr;       // s^2, 8
  const double* rate = nullptr;         // 1/s, 8
  const double* drag = nullptr;         // 1/s, 8
  const double* jumped = nullptr;       // 8: not 0 where the work is of the load after alone
  const double* drag_step = nullptr;    // s, 8: the time step, 0 in a consistent first one
  const double* load_before = nullptr;  // N, 24 a node
  const double* load_after = nullptr;
  const std::int32_t* loaded = nullptr;  // entries of both loads at a node, of all lanes
  std::size_t tetrahedra = 0;
  const std::int32_t* six_springs = nullptr;  // 6 a tetrahedron
  const double* six_stiffness = nullptr;      // 8 * 21 a tetrahedron: the lower triangle
  std::size_t volumes = 0;
  const std::int32_t* volume_start = nullptr;
  const std::int32_t* volume_springs = nullptr;
  const double* dilation = nullptr;          // 1/m
  const double* volume_stiffness = nullptr;  // N m, 8 a volume
  double* kinetic = nullptr;                 // J, 8 each: what the last step did
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
