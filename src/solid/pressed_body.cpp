// Meshes and holds what a finger presses, and the ball of an elastic finger.
#include "solid/pressed_body.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/error.h"
#include "geometry/box.h"
#include "geometry/surface.h"

namespace palpate::solid {
namespace {

using geometry::Box;

constexpr double around = 1.25;  // the touched places, of the contact's radius: equal elements

Box extent_of(const BodyOrder& order) {
  if (order.shape) return {Vec3::Zero(), geometry::extent(*order.shape)};
  return geometry::box_of(order.surface != nullptr ? order.surface->surface().vertices
                                                   : order.mesh->nodes);
}

// Around the touched places, through the layers under them, and in balls.
//                                                                       docs/theory.md [solid_mesh]
Sizes sizes_for(const BodyOrder& order, const Box& extent) {
  Sizes sizes;
  const double a = std::sqrt(order.radius * order.travel);
  const double size = a / order.per_radius;
  const double height = extent.high.z() - extent.low.z();
  // Finer from mesh to mesh far away as well, or what bends there would seem to have converged.
  sizes.across = 1.1 * order.per_radius;
  sizes.largest = std::max(size, std::min(height / *sizes.across, 40.0 * size));
  sizes.calm = 2.5 * height;  // a thin body is at rest beyond
  double highest = -HUGE_VAL;
  for (const Vec3& at : order.touched) {
    sizes.spots.push_back({at, around * a, size});
    highest = std::max(highest, at.z());
  }
  for (const Inclusion& one : order.inclusions) {
    if (one.sphere) {
      sizes.spots.push_back({one.sphere->centre, one.sphere->radius,
                             one.sphere->radius / std::min(4.0, 0.55 * order.per_radius + 0.5)});
      continue;
    }
    for (const double level : {one.bottom, one.top}) {
      const double thickness = highest - level;
      if (!(thickness > 1e-6 * height) || level <= extent.low.z()) continue;
      for (const Vec3& at : order.touched)
        sizes.spots.push_back({{at.x(), at.y(), highest},
                               std::max(2.2 * a, 1.5 * thickness),
                               std::max(1.6 * size, thickness / (0.45 * order.per_radius))});
    }
  }
  return sizes;
}

// The plane to which the base reaches; of a given mesh with the side that is held below it.
Plane base_plane(const BodyOrder& order) {
  for (const int axis : {0, 1, 2})
    if (order.mesh == nullptr && std::abs(order.base_up[axis]) == 1.0)
      return {axis, order.base_up[axis] * order.base_level};
  return {.at = order.base_level, .inclined = order.base_up};
}

// The mirrors of the order that the body has as well.
std::vector<Plane> mirrors_of(const BodyOrder& order, const Box& extent) {
  std::vector<Plane> found;
  if (order.mesh != nullptr || order.touched.empty()) return found;
  for (const int axis : {0, 1}) {
    if (!order.mirrored[as_index(axis)] || order.base_up[axis] != 0.0) continue;
    const double middle = 0.5 * (extent.low[axis] + extent.high[axis]);
    const double near = 1e-6 * (extent.high[axis] - extent.low[axis]);
    if (std::abs(order.touched.front()[axis] - middle) > near) continue;
    const Plane plane{axis, middle};
    const bool spheres =
        std::all_of(order.inclusions.begin(), order.inclusions.end(), [&](const Inclusion& one) {
          return !one.sphere || std::abs(plane.beyond(one.sphere->centre)) < near;
        });
    // Of the shapes, all are symmetric across x, and all but the tapered limb across y.
    const bool body =
        order.shape ? axis == 0 || !std::holds_alternative<geometry::LayeredLimb>(*order.shape)
                    : symmetric(order.surface->surface(), plane);
    if (spheres && body) found.push_back(plane);
  }
  return found;
}

bool lies_on(const Mesh& mesh, const OuterFace& face, const Plane& plane, double rounding) {
  return std::all_of(face.nodes.begin(), face.nodes.begin() + 3, [&](int node) {
    return std::abs(plane.beyond(mesh.nodes[as_index(node)])) < rounding;
  });
}

// Holds a base: bonded, or in height alone and otherwise by as few nodes as keep it from sliding.
void hold(Body& body, const std::set<int>& base, tissue::Base kind) {
  const auto set = [&](int node, int axis) { body.held[as_index(3 * node + axis)] = 1; };
  for (const int node : base)
    for (int axis = kind == tissue::Base::bonded ? 0 : 2; axis < 3; ++axis) set(node, axis);
  if (kind == tissue::Base::bonded) return;
  const auto place = [&](int node) -> const Vec3& { return body.mesh.nodes[as_index(node)]; };
  Vec3 middle = Vec3::Zero();
  for (const int node : base) middle += place(node) / static_cast<double>(base.size());
  const int pin = *std::min_element(base.begin(), base.end(), [&](int a, int b) {
    return (place(a) - middle).squaredNorm() < (place(b) - middle).squaredNorm();
  });
  const int guide = *std::max_element(base.begin(), base.end(), [&](int a, int b) {
    return std::abs(place(a).x() - place(pin).x()) < std::abs(place(b).x() - place(pin).x());
  });
  for (int axis = 0; axis < 2; ++axis)
    if (!body.mirrored[as_index(axis)]) set(pin, axis);
  if (!body.mirrored[0] && !body.mirrored[1]) set(guide, 1);
}

void support(const BodyOrder& order, std::span<const Plane> mirrors, const Box& extent,
             Body& body) {
  const double rounding = 1e-7 * extent.diagonal();
  body.held.assign(3 * body.mesh.nodes.size(), 0);
  for (const Plane& mirror : mirrors) {
    body.copies *= 2;
    body.mirrored[as_index(mirror.axis)] = true;
    for (std::size_t n = 0; n < body.mesh.nodes.size(); ++n)
      if (std::abs(mirror.beyond(body.mesh.nodes[n])) < rounding)
        body.held[3 * n + as_index(mirror.axis)] = 1;
  }
  std::set<int> base;
  double lowest = order.base_level;
  if (order.base_up.z() == 1.0) lowest = std::max(lowest, extent.low.z());
  const double level = lowest + rounding;
  for (const OuterFace& face : body.mesh.boundary) {
    if (std::any_of(mirrors.begin(), mirrors.end(), [&](const Plane& mirror) {
          return lies_on(body.mesh, face, mirror, rounding);
        }))
      continue;
    const auto corner = [&](std::size_t i) -> const Vec3& {
      return body.mesh.nodes[as_index(face.nodes[i])];
    };
    if ((corner(0) + corner(1) + corner(2)).dot(order.base_up) / 3.0 <= level)
      base.insert(face.nodes.begin(), face.nodes.end());
    else if ((corner(1) - corner(0)).cross(corner(2) - corner(0)).z() > 0.0)
      body.met.push_back(face);
  }
  if (base.empty()) throw MeshError(tissue::not_held);
  hold(body, base, order.base);
}

}  // namespace

Body make_body(const BodyOrder& order) {
  // Between the surface of a file and a coarser one under the finger, of its travel. decision 434
  constexpr double of_travel = 0.02;
  const Box extent = extent_of(order);
  const std::vector<Plane> mirrors = mirrors_of(order, extent);
  MeshOrder wanted{.shape = order.shape,
                   .surface = order.surface,
                   .coarser = order.coarser,
                   .nearer = {order.touched, around * std::sqrt(order.radius * order.travel),
                              of_travel * order.travel},
                   .movable = order.movable,
                   .mesh = order.mesh,
                   .middles = order.middles,
                   .region_of = order.region_of,
                   .inclusions = order.inclusions,
                   .mirrors = mirrors,
                   .base = base_plane(order),
                   .sizes = sizes_for(order, extent)};
  Body body;
  body.mesh = mesh_for(wanted);
  body.tissues = order.tissues;
  body.size = std::sqrt(order.radius * order.travel) / order.per_radius;
  body.travel = order.travel;
  support(order, mirrors, extent, body);
  return body;
}

Body make_ball(double radius, double depth, double travel, const tissue::Isotropic& material,
               double per_radius) {
  // The upper half of an ellipsoid whose lower half is cut off: a mirror that is held in height
  // alone is a frictionless base.
  const double a = std::sqrt(radius * depth);
  const Vec3 centre = Vec3::Constant(radius);
  MeshOrder wanted{
      .shape = geometry::Ellipsoid{Vec3::Constant(2.0 * radius)},
      .mirrors = {{0, radius}, {1, radius}, {2, radius}},
      .sizes = {{{centre + radius * Vec3::UnitZ(), around * a, a / per_radius}},
                std::max(a / per_radius, std::min(radius / 1.6, 12.0 * a / per_radius))}};
  Body body;
  body.mesh = mesh_for(wanted);
  for (Vec3& node : body.mesh.nodes) node -= centre;
  body.tissues = {material};
  body.size = a / per_radius;
  body.travel = travel;
  body.copies = 4;
  body.mirrored = {true, true};
  body.held.assign(3 * body.mesh.nodes.size(), 0);
  const double rounding = 1e-7 * radius;
  for (std::size_t n = 0; n < body.mesh.nodes.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      if (std::abs(body.mesh.nodes[n][axis]) < rounding) body.held[3 * n + as_index(axis)] = 1;
  for (const OuterFace& face : body.mesh.boundary)
    if (std::none_of(face.nodes.begin(), face.nodes.end(), [&](int node) {
          return body.mesh.nodes[as_index(node)].norm() < (1.0 - 1e-3) * radius;
        }))
      body.met.push_back(face);
  return body;
}

}  // namespace palpate::solid
