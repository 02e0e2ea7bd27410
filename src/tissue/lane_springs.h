// Springs of up to eight bodies with the same mesh, advanced together: each lane is one body.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "tissue/fast_springs.h"
#include "tissue/springs.h"
#include "tissue/viscous.h"

namespace palpate::tissue {

// A load on a few degrees of freedom, N: ascending, each freedom once.
struct SparseLoad {
  std::vector<std::int32_t> freedoms;
  std::vector<double> forces;
};
[[nodiscard]] SparseLoad sparse(const Vector& load);  // of every entry but +0

// The time step of a lane, as of integrate::CentralDifference, eq. (12) of Chen 2007.
struct LaneStep {
  double time_step = 0.0;  // s
  bool consistent = true;  // the first step is of second order; docs/theory.md (39)
};

// Energies of a lane's last step, J, each computed as in fast_vectors.h or FastSprings.
struct LaneEnergies {
  double work = 0.0;  // of its loads
  double kinetic = 0.0;
  double stored = 0.0;
  double lost = 0.0;  // by branches; for nodal drag, multiplied by the time step, J s
};

// Advances bodies with linear kinematics by central differences, without dashpots between nodes. A
// lane gives the same bits as its body alone with FastSprings and fast_vectors.h, independent of
// the other lanes; empty lanes do not move.
class LaneSprings {
 public:
  static constexpr std::size_t width = 8;

  // Takes the mesh and the spring directions from `network` and the number of branches from `law`.
  // Memory: about 40 bytes per spring and lane for independent springs, nodes included.
  LaneSprings(const Network& network, const ViscousLaw& law, Lanes lanes = Lanes::widest);
  ~LaneSprings();
  LaneSprings(LaneSprings&&) noexcept;
  LaneSprings& operator=(LaneSprings&&) noexcept;

  // Whether bodies with this law can be advanced in lanes: not with dashpots between nodes, nor
  // with branches on coupled springs.
  [[nodiscard]] static bool can(const Network& network, const ViscousLaw& law);
  // Whether two networks can be lanes of one LaneSprings: all but stiffnesses and masses is equal.
  [[nodiscard]] static bool alike(const Network& a, const Network& b);

  // Puts a body into the lane; `held` has one flag per degree of freedom.
  void enter(std::size_t lane, const Network& network, const ViscousLaw& law,
             std::span<const char> held);
  // The state of a body: m, m/s, and the force of its springs, N; memory as in viscous.h.
  struct Standing {
    const Vector* displacement;
    const Vector* velocity;
    const Vector* force;
    std::span<const double> memory;
  };
  void place(std::size_t lane, const Standing& standing);
  // Starts a series of steps; the next step is its first.                    docs/theory.md (39)
  void begin(std::size_t lane, const LaneStep& step);
  // Sets the loads at the start and at the end of the following steps, until the next load().
  void load(std::size_t lane, const SparseLoad& before, const SparseLoad& after);
  // Declares that the load jumped at the start of the following steps, so that the load at their
  // end alone does the work. Valid until the next load().
  void jump(std::size_t lane);
  // Empties the lane, which does not move any more.
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
