// The typical size of the triangles of a surface.
#pragma once

#include <vector>

#include "contact/patch.h"

namespace palpate::contact {

// The edge length (m) of an equilateral triangle of the mean area, for each part of a surface; a
// part ends at creases.
class SkinSpacing {
 public:
  explicit SkinSpacing(const geometry::SmoothSurface& surface);

  // The spacing (m) of the patch's part; on a sharp edge between those of both sides.
  [[nodiscard]] double at(const Patch& patch) const;

 private:
  std::vector<int> part_;        // per triangle
  std::vector<double> spacing_;  // per part, m
};

}  // namespace palpate::contact
