// Vectors as text, for messages.
#pragma once

#include <string>

#include "base/vec3.h"

namespace palpate {

// "(1, 0, -2)", rounded; numbers below 1e-9 of the vector's length are 0.
[[nodiscard]] std::string vector_text(const Vec3& vector, int digits = 4);

}  // namespace palpate
