// The readable loop that fast steps are compared with.
#pragma once

#include <span>

#include "tissue/viscous.h"

namespace palpate::test {

// The effective elongations at this moment without dashpots: e + sum of ratio (e - q).
inline void elastic_elongations(const tissue::ViscousLaw& law, std::span<const double> memory,
                                std::span<const double> elongation, std::span<double> effective) {
  const std::size_t count = elongation.size();
  for (std::size_t s = 0; s < count; ++s) {
    double sum = elongation[s];
    for (std::size_t i = 0; i < law.branches.size(); ++i)
      sum += law.branches[i].ratio * (elongation[s] - memory[count * (1 + i) + s]);
    effective[s] = sum;
  }
}

}  // namespace palpate::test
