// Rounds the numbers of a vector.
#include "base/vector_text.h"

#include "base/text.h"

namespace palpate {

std::string vector_text(const Vec3& vector, int digits) {
  const double rounding = 1e-9 * vector.norm();
  std::string text;
  for (int axis = 0; axis < 3; ++axis)
    text += (axis == 0 ? "(" : ", ") +
            rounded_text(std::abs(vector[axis]) <= rounding ? 0.0 : vector[axis], digits);
  return text + ")";
}

}  // namespace palpate
