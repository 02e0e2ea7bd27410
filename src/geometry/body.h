// A body of one or several tissues: closed surfaces inside each other.
#pragma once

#include <optional>
#include <vector>

#include "geometry/surface.h"

namespace palpate::geometry {

// What a closed surface encloses, less the parts that follow it.
struct Part {
  Surface surface;
  int region = 0;
};

// The first part is the whole body; a later one takes its inside from those before it. Parts may
// share faces where their vertices agree bit for bit, but may not cross.
struct Body {
  std::vector<Part> parts;
};

// A ball of another tissue.
struct Lump {
  Vec3 centre = Vec3::Zero();  // m
  double radius = 0.0;         // m
  int region = 0;
};

// Adds a lump as the body's last part, its surface sampled at `spacing` (m) or at 0.8 of its radius
// where that is less. Lumps may be nested, the outer one first.
// Throws MeshError where it is not wholly inside the body, or cuts another part.
void add_lump(Body& body, const Lump& lump, double spacing);

// All facets of the body, each once: what TetGen takes.
[[nodiscard]] Surface facets(const Body& body);

// The region of a point that lies on no facet; nothing outside the body.
[[nodiscard]] std::optional<int> region_at(const Body& body, const Vec3& point);

}  // namespace palpate::geometry
