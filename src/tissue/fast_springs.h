// The loops of springs.h and viscous.h combined in one vectorised pass that gives the same bits.
#pragma once

#include <memory>
#include <span>

#include "tissue/lanes.h"
#include "tissue/springs.h"
#include "tissue/viscous.h"

namespace palpate::tissue {

// Whether turn_as() will be called. Coupled springs that never turn are much faster.
enum class Turning { never, sometimes };

// A network laid out for such passes: a node's displacement and force share a cache line, and
// springs are processed four at a time in the order of the network. Use one copy per thread.
class FastSprings {
 public:
  // Copies the network: about 48 bytes per spring and 112 per node for independent springs. Coupled
  // springs with linear kinematics, of a law without memory, are passed by FastEdges, whose forces
  // differ from those of the loops by rounding.
  FastSprings(const Network& network, Kinematics kinematics, const ViscousLaw& law,
              Turning turning = Turning::never, Lanes lanes = Lanes::widest);
  ~FastSprings();
  FastSprings(FastSprings&&) noexcept;
  FastSprings& operator=(FastSprings&&) noexcept;

  // One step to `displacement` (m): elongations(), remember() with `steps`, elastic_elongations(),
  // tensions() and gather_forces(), whose result force() returns. Changes `memory` (laid out as in
  // viscous.h).
  void remember(const Vector& displacement, std::span<const MemoryStep> steps,
                std::span<double> memory);

  // The same without a step: the memory does not change, and no energies are computed. Laws without
  // branches do not read it: it may be empty.
  void look(const Vector& displacement, std::span<const double> memory);

  // For linear kinematics and Turning::sometimes: gives the springs the directions that those of
  // `other`, the same network with other kinematics, had in its last pass.
  void turn_as(const FastSprings& other);

  // Whether the last pass was at this displacement and ended with this memory, so that its force is
  // valid there. The memory is compared only for laws with branches, whose forces depend on it.
  [[nodiscard]] bool knows(const Vector& displacement, std::span<const double> memory) const;
  // Whether the last pass was at this displacement.
  [[nodiscard]] bool stands_at(const Vector& displacement) const;
  void force(Vector& force) const;  // N, of the last pass

  // Energies of the last pass if it was remember(), J: `stored` as stored_energy(), and `lost` what
  // was dissipated since the pass before, as dissipated_energy() defines it for branches; for
  // Kelvin-Voigt it must be multiplied by tau / dt; nodal drag is not included. Both are summed in
  // four lanes and differ from those functions by rounding. energies() is null after look(), for
  // coupled springs with branches, and in the first pass of coupled springs.
  struct Energies {
    double stored = 0.0;
    double lost = 0.0;
  };
  [[nodiscard]] const Energies* energies() const;
  // Whether the pass before the last one was at this displacement.
  [[nodiscard]] bool came_from(const Vector& before) const;

 private:
  struct Layout;
  std::unique_ptr<Layout> layout_;
};

}  // namespace palpate::tissue
