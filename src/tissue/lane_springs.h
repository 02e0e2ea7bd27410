// Springs of up to eight bodies on one mesh, moved together: lanes are bodies.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "tissue/fast_springs.h"
#include "tissue/springs.h"
#include "tissue/viscous.h"

namespace palpate::tissue {

// A load on few degrees of freedom, N: ascending, each once.
struct SparseLoad {
  std::vector<std::int32_t> freedoms;
  std::vector<double> forces;
};
[[nodiscard]] SparseLoad sparse(const Vector& load);  // of every entry but +0

// How a lane steps: as integrate::CentralDifference does, eq. (12) of Chen 2007.
struct LaneStep {
  double time_step = 0.0;  // s
  bool consistent = true;  // its first step is of second order; docs/theory.md (39)
};

// What a lane did in the last step, J: each as its function in fast_vectors.h or FastSprings says.
struct LaneEnergies {
  double work = 0.0;  // of its loads
  double kinetic = 0.0;
  double stored = 0.0;
  double lost = 0.0;  // by branches; of nodal drag times the time step, J s
};

// Central differences without dashpots between nodes. A lane does, to the bit, what its body does
// by itself with FastSprings and fast_vectors.h, whatever its neighbours do; lanes that nobody has
// entered stand still.
class LaneSprings {
 public:
  static constexpr std::size_t width = 8;

  // The mesh is that of `network`, and so are the directions; branches are as many as `law` has.
  // Copies: about 40 bytes a spring and lane, uncoupled.
  LaneSprings(const Network& network, Kinematics kinematics, const ViscousLaw& law,
              Lanes lanes = Lanes::widest);
  ~LaneSprings();
  LaneSprings(LaneSprings&&) noexcept;
  LaneSprings& operator=(LaneSprings&&) noexcept;

  // Whether bodies of this law can be moved so at all: no dashpots between nodes, and branches
  // only where springs do not pull on each other.
  [[nodiscard]] static bool can(const Network& network, const ViscousLaw& law);
  // Whether two networks may stand in lanes side by side: all but stiffnesses and masses is equal.
  [[nodiscard]] static bool alike(const Network& a, const Network& b);

  // `network` and `law` enter the lane, with a flag a degree of freedom for what is held.
  void enter(std::size_t lane, const Network& network, const ViscousLaw& law,
             std::span<const char> held);
  // Where it stands: m, m/s, and N of its springs there; memory as in viscous.h.
  struct Standing {
    const Vector* displacement;
    const Vector* velocity;
    const Vector* force;
    std::span<const double> memory;
  };
  void place(std::size_t lane, const Standing& standing);
  // The next step is a first one, and so long.
  void begin(std::size_t lane, const LaneStep& step);
  // The loads at the start and the end of the next steps, until others are given.
  void load(std::size_t lane, const SparseLoad& before, const SparseLoad& after);
  // The load that acts at the start of the next steps is not the one that they begin with, having
  // jumped: their work is that of the load at the end. Until others are given.
  void jump(std::size_t lane);
  // The lane stands still from now on.
  void leave(std::size_t lane);

  // One step of every lane. Allocates nothing.
  void step();

  [[nodiscard]] const LaneEnergies& energies(std::size_t lane) const;
  void displacement(std::size_t lane, Vector& displacement) const;  // m
  void force(std::size_t lane, Vector& force) const;                // N, of the springs

 private:
  struct Layout;
  std::unique_ptr<Layout> layout_;
};

}  // namespace palpate::tissue
