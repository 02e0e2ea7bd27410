// Collects the parts of the surface between its creases.
#include "contact/skin_spacing.h"

#include <cmath>

namespace palpate::contact {

SkinSpacing::SkinSpacing(const geometry::SmoothSurface& surface)
    : part_(surface.surface().triangles.size(), -1) {
  for (std::size_t t = 0; t < part_.size(); ++t) {
    if (part_[t] >= 0) continue;
    const int part = static_cast<int>(spacing_.size());
    std::vector<int> found{static_cast<int>(t)};
    part_[t] = part;
    double area = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      area += 0.5 * twice_area(surface.surface(), found[i]).norm();
      for (std::size_t edge = 0; edge < 3; ++edge) {
        if (surface.crease(found[i], edge)) continue;
        const int next = surface.neighbours().across(found[i])[edge];
        if (part_[as_index(next)] >= 0) continue;
        part_[as_index(next)] = part;
        found.push_back(next);
      }
    }
    // l = sqrt(4 A / sqrt(3))
    spacing_.push_back(
        std::sqrt(4.0 * area / (std::sqrt(3.0) * static_cast<double>(found.size()))));
  }
}

double SkinSpacing::at(const Patch& patch) const {
  const auto of = [&](int triangle) { return spacing_[as_index(part_[as_index(triangle)])]; };
  const double here = of(patch.at.triangle);
  return patch.turned > 0.0 ? here + patch.turned * (of(patch.beyond.triangle) - here) : here;
}

}  // namespace palpate::contact
