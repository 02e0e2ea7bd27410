// Where a slow press has met the surface, from what a stand measured on its way.
#pragma once

#include <optional>

namespace palpate::run {

// A sphere's force grows as F = c (z_0 - z)^(3/2), so that F^(2/3) is a line in z that ends at the
// surface, whatever the tissue's stiffness: the line of least squares through all readings.
class TouchLine {
 public:
  // A reading in contact: height z (m) and force (N, above 0). Allocates nothing.
  void add(double z, double force);
  // z_0, m; nothing before three readings, or where the force does not grow downwards.
  [[nodiscard]] std::optional<double> surface() const;

 private:
  double count_ = 0.0;
  double z_first_ = 0.0;  // m: sums are of the way from here, so that they keep their digits
  double z_ = 0.0, zz_ = 0.0, y_ = 0.0, zy_ = 0.0;
};

}  // namespace palpate::run
