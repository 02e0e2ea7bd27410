// A body of one or several tissues: closed surfaces, some inside others.
#pragma once

#include <optional>
#include <vector>

#include "geometry/surface.h"

namespace palpate::geometry {

// The volume inside a closed surface, without the later parts inside it.
struct Part {
  Surface surface;
  int region = 0;
};

// The first part is the whole body; a later part replaces the earlier ones inside its surface.
// Parts may share faces if their vertices are bitwise equal, but their surfaces must not intersect.
struct Body {
  std::vector<Part> parts;
};

// A spherical inclusion.
struct Inclusion {
  Vec3 centre = Vec3::Zero();  // m
  double radius = 0.0;         // m
  int region = 0;
};

// Adds an inclusion as the body's last part. Its surface has edges of about `spacing` (m), at most
// 0.55 of its radius, and encloses the sphere's volume. Nested inclusions are added from the
// outside inwards. Throws MeshError if the inclusion is not wholly inside the body, or touches the
// surface of another part.
void add_inclusion(Body& body, const Inclusion& inclusion, double spacing);

// All triangles of the body's surfaces, shared ones only once: the input for TetGen.
[[nodiscard]] Surface facets(const Body& body);

// Whether a point that is not on a closed surface is inside it. Where the surface has several
// parts, those that face inwards bound cavities, which are outside.
[[nodiscard]] bool encloses(const Surface& surface, const Vec3& point);

// The region of a point that is not on a surface; empty outside the body.
[[nodiscard]] std::optional<int> region_at(const Body& body, const Vec3& point);

}  // namespace palpate::geometry
