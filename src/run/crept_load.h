// The load whose elastic static answer is what a viscous mesh does without inertia.
#pragma once

#include <vector>

#include "integrate/body.h"
#include "tissue/viscous.h"

namespace palpate::run {

// All springs fade alike: K (1 + sum b_k) u - K sum b_k q_k = L has the answer u = K^-1 J[L], J the
// creep of L, degree of freedom by degree of freedom. Without branches J[L] is L.
// docs/theory.md, inertia in the contact; (37)
class CreptLoad {
 public:
  // `rule` is that of the mesh's own memory.
  CreptLoad(const tissue::ViscousLaw& law, integrate::MemoryRule rule) : law_(law), rule_(rule) {}

  // From now on the steps have this size, s.
  void set_step(double time_step);

  // To the end of a step with this load, N, which was linear in it.
  void pass(const integrate::Vector& load);

  // J[L] at the end of the last step, N; empty before any.
  [[nodiscard]] const integrate::Vector& load() const { return crept_; }

  // Renumbers: entry d of the new vectors is entry from[d] of the old ones, or 0 where that is -1.
  void renumber(const std::vector<Eigen::Index>& from);

 private:
  tissue::ViscousLaw law_;
  integrate::MemoryRule rule_;
  std::vector<tissue::MemoryStep> steps_;
  integrate::Vector crept_;                // J[L]
  std::vector<integrate::Vector> memory_;  // one a branch, N
  integrate::Vector right_;                // N
};

}  // namespace palpate::run
