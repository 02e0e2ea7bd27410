// The fit of a line by least squares; cbrt() is not called in a solver step.
#include "live/touch.h"

#include <cmath>

namespace palpate::live {

void TouchLine::add(double z, double force) {
  if (!(force > 0.0)) return;
  if (count_ == 0.0) z_first_ = z;
  const double way = z - z_first_;
  const double root = std::cbrt(force);
  const double y = root * root;
  count_ += 1.0;
  z_ += way;
  zz_ += way * way;
  y_ += y;
  zy_ += way * y;
}

std::optional<double> TouchLine::surface() const {
  if (count_ < 3.0) return std::nullopt;
  const double spread = count_ * zz_ - z_ * z_;
  if (!(spread > 0.0)) return std::nullopt;
  const double slope = (count_ * zy_ - z_ * y_) / spread;
  if (!(slope < 0.0)) return std::nullopt;
  const double level = (y_ - slope * z_) / count_;
  return z_first_ - level / slope;
}

}  // namespace palpate::live
