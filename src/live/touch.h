// Finds the surface from the heights and forces that a stand measures in a slow press.
#pragma once

#include <optional>

namespace palpate::live {

// The force of a sphere is F = c (z_0 - z)^(3/2), so that F^(2/3) is linear in z and vanishes at
// the surface z_0 for any stiffness of the tissue. The line is fitted by least squares.
class TouchLine {
 public:
  // Adds a reading: height z (m) and force (N), ignored unless above 0. Allocates nothing.
  void add(double z, double force);
  // z_0, m; nothing with fewer than three readings or if the force does not grow downwards.
  [[nodiscard]] std::optional<double> surface() const;

 private:
  double count_ = 0.0;
  double z_first_ = 0.0;  // m: sums are of z - z_first_, to reduce rounding errors
  double z_ = 0.0, zz_ = 0.0, y_ = 0.0, zy_ = 0.0;
};

}  // namespace palpate::live
