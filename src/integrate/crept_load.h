// The load whose elastic static solution equals the displacement of a viscous mesh without inertia.
#pragma once

#include <vector>

#include "integrate/body.h"
#include "tissue/viscous.h"

namespace palpate::integrate {

// All springs relax by the same function, so that K (1 + sum b_k) u - K sum b_k q_k = L has the
// solution u = K^-1 J[L], where J[L] is the creep of L, degree of freedom by degree of freedom.
// With Kelvin-Voigt's dashpots J[L] obeys tau J' + J = L, and in elastic bodies it is L.
//                                           docs/theory.md, inertia in the contact; [branches]
class CreptLoad {
 public:
  // `rule` is the memory rule of the mesh; any other than `first_order` is taken as `exact`.
  CreptLoad(const tissue::ViscousLaw& law, MemoryRule rule) : law_(law), rule_(rule) {}

  // Sets the size of the next steps, s.
  void set_step(double time_step);

  // Advances by one step, at the end of which the load is `load` (N).
  void pass(const Vector& load);

  // J[L] at the end of the last step, N; empty before the first one.
  [[nodiscard]] const Vector& load() const { return crept_; }

  // Renumbers: entry d of the new vectors is entry from[d] of the old ones, or 0 where that is -1.
  void renumber(const std::vector<Eigen::Index>& from);

 private:
  tissue::ViscousLaw law_;
  MemoryRule rule_;
  std::vector<tissue::MemoryStep> steps_;
  Vector crept_;                // J[L]
  std::vector<Vector> memory_;  // N, one per branch; of Kelvin-Voigt the load
  Vector right_;                // N
};

}  // namespace palpate::integrate
