// Decides inside and outside by the solid angle of a surface, and distances by its triangles.
#include "geometry/body.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <string>

#include "base/error.h"
#include "base/text.h"
#include "geometry/box_tree.h"
#include "geometry/shape_loops.h"

namespace palpate::geometry {
namespace {

double distance_to(const Surface& surface, const Vec3& point) {
  return std::sqrt(BoxTree(surface).nearest(point).distance_squared);
}

std::string named(const Inclusion& inclusion) {
  std::string text =
      "the inclusion of radius " + rounded_text(1e3 * inclusion.radius) + " mm about (";
  for (int axis = 0; axis < 3; ++axis)
    text += (axis ? ", " : "") + rounded_text(1e3 * inclusion.centre[axis]);
  return text + ") mm ";
}

}  // namespace

// Sums the triangles' solid angles from the point (Van Oosterom & Strackee 1983): 4 pi inside.
bool encloses(const Surface& surface, const Vec3& point) {
  double half_angles = 0.0;
  for (const auto& triangle : surface.triangles) {
    const Vec3 a = surface.vertices[as_index(triangle[0])] - point;
    const Vec3 b = surface.vertices[as_index(triangle[1])] - point;
    const Vec3 c = surface.vertices[as_index(triangle[2])] - point;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    half_angles +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return half_angles > std::numbers::pi;
}

void add_inclusion(Body& body, const Inclusion& inclusion, double spacing) {
  const Surface& whole = body.parts.front().surface;
  double room = distance_to(whole, inclusion.centre);
  if (!encloses(whole, inclusion.centre) || room <= inclusion.radius)
    throw MeshError(named(inclusion) +
                    "does not lie wholly inside the body; move it inwards or make it smaller");
  for (std::size_t p = 1; p < body.parts.size(); ++p) {
    const double distance = distance_to(body.parts[p].surface, inclusion.centre);
    if (distance <= inclusion.radius)
      throw MeshError(named(inclusion) + "touches the boundary of region " +
                      std::to_string(body.parts[p].region) +
                      "; move it away from there or make it smaller");
    room = std::min(room, distance);
  }
  // A polyhedron on the sphere has less volume: its vertices move outwards until it has the ball's.
  // Where they would leave the body, the polyhedron is made finer.
  constexpr double coarsest = 0.55;  // of the radius
  const double wanted =
      4.0 / 3.0 * std::numbers::pi * inclusion.radius * inclusion.radius * inclusion.radius;
  double edge = std::min(spacing, coarsest * inclusion.radius);
  Surface ball;
  double wider = 0.0;
  for (int tries = 0; tries < 3 && (wider == 0.0 || wider * inclusion.radius >= room); ++tries) {
    ball = ellipsoid_surface(inclusion.centre, Vec3::Constant(2.0 * inclusion.radius), edge);
    wider = std::cbrt(wanted / enclosed(ball).volume);
    edge *= 0.5;
  }
  wider = std::min(wider, std::sqrt(room / inclusion.radius));
  for (Vec3& vertex : ball.vertices)
    vertex = inclusion.centre + wider * (vertex - inclusion.centre);
  body.parts.push_back({std::move(ball), inclusion.region});
}

Surface facets(const Body& body) {
  Surface all;
  std::map<std::array<double, 3>, int> numbers;
  std::set<std::array<int, 3>> known;
  for (const Part& part : body.parts) {
    std::vector<int> number;
    for (const Vec3& vertex : part.surface.vertices) {
      const auto [entry, fresh] = numbers.try_emplace({vertex.x(), vertex.y(), vertex.z()},
                                                      static_cast<int>(all.vertices.size()));
      if (fresh) all.vertices.push_back(vertex);
      number.push_back(entry->second);
    }
    for (std::array<int, 3> triangle : part.surface.triangles) {
      for (int& corner : triangle) corner = number[as_index(corner)];
      std::array<int, 3> key = triangle;
      std::ranges::sort(key);
      if (known.insert(key).second) all.triangles.push_back(triangle);
    }
  }
  return all;
}

std::optional<int> region_at(const Body& body, const Vec3& point) {
  if (!encloses(body.parts.front().surface, point)) return std::nullopt;
  for (std::size_t p = body.parts.size(); p-- > 1;)
    if (encloses(body.parts[p].surface, point)) return body.parts[p].region;
  return body.parts.front().region;
}

}  // namespace palpate::geometry
