// What springs do in one pass: the loops of springs.h and viscous.h together, to the bit, in lanes.
#pragma once

#include <memory>
#include <span>

#include "tissue/springs.h"
#include "tissue/viscous.h"

namespace palpate::tissue {

// Which instructions: those that every processor of this kind has, or the widest that this one has.
// Both give the same bits.
enum class Lanes { portable, widest };

// A network laid out for its passes: a node's displacement and force share a cache line, springs
// come four at a time, their numbers in the order of the network. One copy serves one thread.
class FastSprings {
 public:
  // The network is copied. Throws nothing; its size is that of the network, about 44 bytes a
  // spring.
  FastSprings(const Network& network, Kinematics kinematics, const ViscousLaw& law,
              Lanes lanes = Lanes::widest);
  ~FastSprings();
  FastSprings(FastSprings&&) noexcept;
  FastSprings& operator=(FastSprings&&) noexcept;

  // elongations(), remember() of a step whose passages are `steps`, and then elastic_elongations(),
  // tensions() and gather_forces() at `displacement` (m), which become force(). Changes `memory`
  // (laid out as in viscous.h).
  void remember(const Vector& displacement, std::span<const MemoryStep> steps,
                std::span<double> memory);

  // The same without a step: the memory stays as it is, and there are no energies. Laws without
  // branches do not read it: it may be empty.
  void look(const Vector& displacement, std::span<const double> memory);

  // Of linear kinematics: springs have the directions that those of `other`, the same network in
  // other kinematics, had in its last pass.
  void turn_as(const FastSprings& other);

  // Whether the last pass was at this displacement, and left or found this memory: then its force
  // is the force there. Memory counts only where forces depend on it, in laws with branches.
  [[nodiscard]] bool knows(const Vector& displacement, std::span<const double> memory) const;
  [[nodiscard]] bool stands_at(const Vector& displacement) const;  // of the last pass
  void force(Vector& force) const;                                 // N, of the last pass

  // Of the last pass where it was remember(), J: `stored` is stored_energy(), and `lost` what the
  // dampers took since the pass before, as dissipated_energy() says: of branches; of Kelvin-Voigt
  // it wants to be multiplied by tau over the time step; nothing of nodal drag. Both are sums in
  // four lanes, within the rounding of n terms of those functions. Null where coupled springs have
  // branches, and where the last pass was a look.
  struct Energies {
    double stored = 0.0;
    double lost = 0.0;
  };
  [[nodiscard]] const Energies* energies() const;
  // Whether the pass before was at this displacement.
  [[nodiscard]] bool came_from(const Vector& before) const;

 private:
  struct Layout;
  std::unique_ptr<Layout> layout_;
};

}  // namespace palpate::tissue
