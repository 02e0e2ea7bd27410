// The finger as a single sphere.
#pragma once

#include <numbers>

#include "contact/hertz.h"

namespace palpate::finger {

struct Sphere {
  double radius = 0.0;   // m
  double density = 0.0;  // kg/m^3
  contact::Elastic elastic = {};

  // m = rho 4/3 pi r^3, kg                                 Chen 2007 eq. (5), n = 1
  [[nodiscard]] double mass() const {
    return density * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  }
};

}  // namespace palpate::finger
