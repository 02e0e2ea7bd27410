// An axis with a sign, or three numbers.
#include "scenario/direction.h"

#include "base/text.h"

namespace palpate::scenario {

std::optional<Vec3> direction_of(const std::string& text) {
  const bool back = text.starts_with('-');
  const std::string axis = text.substr(back || text.starts_with('+') ? 1 : 0);
  for (int k = 0; k < 3; ++k)
    if (axis == std::string(1, "xyz"[k])) return (back ? -1.0 : 1.0) * Vec3::Unit(k);
  Vec3 vector = Vec3::Zero();
  int count = 0;
  for (const std::string& word : split(text, ' ')) {
    if (word.empty()) continue;
    const auto number = whole_number(word);
    if (!number || count == 3) return std::nullopt;
    vector[count++] = *number;
  }
  const double length = vector.norm();
  if (count < 3 || !(length > 0.0) || !std::isfinite(length)) return std::nullopt;
  return vector / length;
}

}  // namespace palpate::scenario
