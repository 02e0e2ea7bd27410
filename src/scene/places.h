// Where a specimen and its regions lie. Every place of a scenario is in the coordinates of the file
// that gives the body, or from the lowest corner of a shape that palpate makes.
#pragma once

#include <span>
#include <string>

#include "geometry/body.h"
#include "geometry/box.h"
#include "scenario/family.h"
#include "scenario/resolved.h"

namespace palpate::scene {

class SpecimenShapes;

using geometry::Box;
using geometry::box_of;

[[nodiscard]] std::string box_text(const Box& box);  // "x -30 to 30, y -30 to 30, z 0 to 30 mm"

// "in the file's coordinates", or "from the lowest corner of its box".
[[nodiscard]] std::string coordinates_text(const scenario::Resolved& scenario);

// A place (m) of the scene in these coordinates, "(1, 0, -2) mm".
[[nodiscard]] std::string place_text(const scenario::Resolved& scenario, const Vec3& place);

// Sets `tissue.turn`, `tissue.base_up`, `tissue.near_part` and, where the base is a group of faces,
// `tissue.base_height`, and turns the scenario's places with the body: centres of inclusions, and
// `finger.at`, which becomes `finger.x` and `finger.y`. Throws MeshError if a mesh that a place
// depends on cannot be read, and for a group that is not all of the surface beyond a plane.
void place_in_scene(scenario::Resolved& scenario, const std::string& folder,
                    SpecimenShapes& shapes);

// The rotation from the coordinates of the body's file to those where its `up` is z.
[[nodiscard]] Eigen::Matrix3d standing(const scenario::Resolved& scenario);

// The box of places of the scene in the coordinates of the body's file.
[[nodiscard]] Box box_in_file(const scenario::Resolved& scenario, std::span<const Vec3> places);

// The height (m) along `tissue.base_up` to which the surface is the base: `tissue.base_height`, or
// the lowest plane of a body with a flat underside, or a tenth of its height above its lowest
// point. Flat is an underside with a twentieth of the surface, or with sharp edges around it.
[[nodiscard]] double base_level(const scenario::Resolved& scenario, const geometry::Surface& body);

// Throws KeyError for a place (m) of the surface that the base holds, which no finger can press.
void refuse_held(const scenario::Resolved& scenario, double base_level, const Vec3& touched);

// The part of the surface's area that is the base, and how much of the underside within a radius
// (m) around a place, seen from above, belongs to it.
struct BaseArea {
  double of_surface = 0.0;
  double under_press = 0.0;
};
[[nodiscard]] BaseArea base_area(const scenario::Resolved& scenario, const geometry::Surface& body,
                                 const Vec3& place, double radius);

// The part of an inclusion that lies inside a closed surface, 0 to 1; error below 0.002.
[[nodiscard]] double share_inside(const geometry::Surface& body,
                                  const geometry::Inclusion& inclusion);

// Throws InputError with both boxes for an inclusion of which less than 99 % lies inside the body,
// a layer of which less than 99 % lies in its height, and a base above or below the body.
// `part` is the one that is taken of a file with several, for messages.
void refuse_outside(const scenario::Resolved& scenario, const geometry::Surface& body,
                    const scenario::Family& family, const std::string& part = "");

// The same for the body of a shape or of a surface file; nothing for other bodies.
void refuse_misplaced(const scenario::Resolved& scenario, const scenario::Family& family,
                      SpecimenShapes& shapes);

}  // namespace palpate::scene
