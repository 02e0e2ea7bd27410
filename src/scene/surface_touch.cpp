// Closed forms for parametric shapes, and the smooth surface of a file's triangles.
#include "scene/surface_touch.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "contact/hertz.h"
#include "geometry/box_tree.h"
#include "geometry/shapes.h"
#include "scenario/programme.h"
#include "scene/first_touch.h"
#include "scene/places.h"
#include "scene/specimen_mesh.h"
#include "scene/specimen_shape.h"

namespace palpate::scene {
namespace {

using Scenario = scenario::Resolved;

constexpr const char* on_an_edge =
    "the finger first touches an edge of the surface, where it has no curvature";

void put(SurfaceTouch& touch, const Vec3& position, double radius) {
  touch.position = position;
  touch.lowest = position + radius * (touch.curvature.normal - Vec3::UnitZ());
}

SurfaceTouch of_half_space(const scenario::HalfSpace& half) {
  SurfaceTouch touch;
  const double across = half.curvature_2.value_or(half.curvature);
  touch.curvature.kappa_1 = std::max(half.curvature, across);
  touch.curvature.kappa_2 = std::min(half.curvature, across);
  if (half.curvature < across) {
    touch.curvature.direction_1 = Vec3::UnitY();
    touch.curvature.direction_2 = -Vec3::UnitX();
  }
  return touch;
}

void set_beside(SurfaceTouch& touch, const KeyError& error) {
  touch.cannot = error.what();
  touch.nowhere = true;
  touch.beside = error.key();
}

SurfaceTouch of_shape(const geometry::Shape& shape, const Scenario& scenario) {
  SurfaceTouch touch;
  touch.size = touch.high = geometry::extent(shape);
  const double x = scenario.finger.x.value_or(0.5 * touch.size.x());
  const double y = scenario.finger.y.value_or(0.5 * touch.size.y());
  touch.lowest = {x, y, touch.size.z()};
  touch.thickness = touch.size.z();
  const double radius = scenario.finger.radius;
  const auto found = geometry::touch_from_above(shape, x, y, radius);
  if (!found) {
    set_beside(touch, beside(touch.lowest, Vec3::Zero(), touch.size));
  } else if (found->on_edge) {
    touch.position = found->position;
    touch.cannot = std::holds_alternative<geometry::Cuboid>(shape)
                       ? "the finger leaves the top of the body"
                       : on_an_edge;
  } else {
    touch.curvature = found->curvature;
    touch.thickness = touch.to_base = touch.tissue_to_base = found->position.z();
    put(touch, found->position, radius);
    if (std::holds_alternative<geometry::Cylinder>(shape) ||
        std::holds_alternative<geometry::LayeredLimb>(shape))
      touch.to_edge = std::min(touch.position.y(), touch.size.y() - touch.position.y());
    if (const auto* disc = std::get_if<geometry::Disc>(&shape))
      touch.to_edge = disc->radius - std::hypot(x - disc->radius, y - disc->radius);
    if (const auto* box = std::get_if<scenario::Cuboid>(&scenario.tissue.shape))
      for (const auto& [along, across] : scenario::finger_places(scenario, *box))
        touch.to_edge =
            std::min({touch.to_edge, along, box->size[0] - along, across, box->size[1] - across});
  }
  return touch;
}

// The triangles within some rings of a triangle's corners, ascending.
std::vector<int> triangles_around(const geometry::SmoothSurface& whole, int triangle, int rings) {
  const std::vector<int> near =
      whole.neighbours().rings(whole.surface().triangles[as_index(triangle)], rings);
  std::vector<int> triangles;
  for (const int vertex : near)
    for (const int one : whole.neighbours().triangles_at(vertex)) triangles.push_back(one);
  std::ranges::sort(triangles);
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  return triangles;
}

// The length of the edges at a triangle's corners, m.
double edges_around(const geometry::SmoothSurface& whole, int triangle) {
  const auto& vertices = whole.surface().vertices;
  double sum = 0.0;
  int count = 0;
  for (const int corner : whole.surface().triangles[as_index(triangle)])
    for (const int other : whole.neighbours().vertices_at(corner)) {
      sum += (vertices[as_index(other)] - vertices[as_index(corner)]).norm();
      ++count;
    }
  return sum / count;
}

geometry::CurvatureEstimate curvature_over(const geometry::SmoothSurface& whole,
                                           const geometry::SurfacePoint& at,
                                           const geometry::CurvatureOptions& options) {
  // One ring more than the fits use, so that they do not meet the rim of the piece.
  const std::vector<int> triangles = triangles_around(whole, at.triangle, options.rings + 1);
  const geometry::Surface piece = geometry::piece_of(whole.surface(), triangles);
  const auto own = std::ranges::lower_bound(triangles, at.triangle);
  const geometry::Neighbours neighbours(piece);
  const geometry::CurvatureStars stars(piece, neighbours, options);
  return geometry::between(stars.at_corners(piece, static_cast<int>(own - triangles.begin())),
                           {at.weights[0], at.weights[1], at.weights[2]});
}

// The distance (m) of a point from the convex creases of the surface that faces along `normal`.
double to_creases(const geometry::SmoothSurface& surface, const Vec3& point, const Vec3& normal) {
  constexpr double facing = 0.3;  // cosine
  const auto& [vertices, triangles] = surface.surface();
  double nearest = std::numeric_limits<double>::infinity();
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t) {
    const Vec3 own = geometry::twice_area(surface.surface(), t).normalized();
    if (own.dot(normal) < facing) continue;
    for (std::size_t edge = 0; edge < 3; ++edge) {
      const int other = surface.neighbours().across(t)[edge];
      if (!surface.crease(t, edge) || other < 0) continue;
      const Vec3& begin = vertices[as_index(triangles[as_index(t)][edge])];
      const Vec3 along = vertices[as_index(triangles[as_index(t)][(edge + 1) % 3])] - begin;
      const Vec3 into = own.cross(along);  // the triangle lies on this side of its edge
      if (geometry::twice_area(surface.surface(), other).dot(into) > 0.0) continue;  // a groove
      const double at = std::clamp((point - begin).dot(along) / along.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (point - begin - at * along).norm());
    }
  }
  return nearest;
}

// The mean of the normals at a place and nearest to eight around it, at a distance (m).
Vec3 mean_normal(const geometry::SmoothSurface& surface, const geometry::SurfacePoint& at,
                 double distance) {
  const geometry::BoxTree tree(surface.surface());
  Vec3 sum = surface.normal(at);
  const Vec3 along = sum.unitOrthogonal(), across = sum.cross(along);
  for (const auto& [i, j] :
       {std::pair(1, 0), {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}) {
    const Vec3 beside = surface.position(at) + distance * (i * along + j * across).normalized();
    sum += surface.closest_point(beside, tree.nearest(beside)).normal;
  }
  return sum.normalized();
}

// The law of a rigid finger on a flat: that of an elastic one changes little here.
contact::SphereLaw law_on_flat(const Scenario& scenario) {
  const contact::Elastic tissue{scenario.tissue.young_modulus, scenario.tissue.poisson_ratio};
  return {scenario.finger.radius, contact::hertz::effective_modulus(0.0, tissue.compliance())};
}

// The body straight below a point of its surface, m.
struct Below {
  double first = 0.0;   // to where it ends, or to the wall of a hollow
  double last = 0.0;    // to where it ends for good
  double tissue = 0.0;  // what is not hollow of that
};

Below below(const geometry::Surface& surface, const Vec3& point) {
  constexpr double own = 1e-3;  // of the height: less is the point's own triangle
  const auto [low, high] = geometry::reach_along(surface.vertices, Vec3::UnitZ());
  std::vector<std::pair<double, bool>> crossings;  // z, and whether it is an underside
  for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
    const Vec3 twice = geometry::twice_area(surface, static_cast<int>(t));
    if (twice.z() == 0.0) continue;
    const bool underside = twice.z() < 0.0;
    const auto corner = [&](std::size_t k) -> const Vec3& {
      return surface.vertices[as_index(surface.triangles[t][k])];
    };
    bool inside = true;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 along = corner((k + 1) % 3) - corner(k), to = point - corner(k);
      const double side = along.x() * to.y() - along.y() * to.x();
      inside = inside && (underside ? side <= 0.0 : side >= 0.0);
    }
    if (!inside) continue;
    const double z =
        corner(0).z() - (twice.head<2>().dot((point - corner(0)).head<2>())) / twice.z();
    if (z < point.z() - own * (high - low)) crossings.emplace_back(z, underside);
  }
  std::sort(crossings.rbegin(), crossings.rend());
  Below found;
  double top = point.z();
  bool inside = true;
  const auto leave = [&](double z) {
    found.last = point.z() - z;
    if (found.first == 0.0) found.first = found.last;
    found.tissue += top - z;
  };
  for (const auto& [z, underside] : crossings) {
    if (underside != inside) continue;  // the same side again, on an edge of two triangles
    if (underside) leave(z);
    top = z;
    inside = !underside;
  }
  if (inside) leave(low);
  return found;
}

// Sets how far it is from a point (m) of the surface straight down to what is held.
void set_to_base(SurfaceTouch& touch, const geometry::Surface& surface, const Vec3& point,
                 const Scenario& scenario) {
  const Below found = below(surface, point);
  const double level = base_level(scenario, surface);
  const auto held = [&](double depth) {
    const double rounding = 1e-6 * depth;
    return (point - depth * Vec3::UnitZ()).dot(scenario.tissue.base_up) <= level + rounding;
  };
  if (held(found.first))
    touch.to_base = touch.tissue_to_base = found.first;
  else if (held(found.last))
    std::tie(touch.to_base, touch.tissue_to_base) = std::pair(found.last, found.tissue);
}

SurfaceTouch of_file(const geometry::SmoothSurface& surface, const Scenario& scenario) {
  SurfaceTouch touch;
  const auto& vertices = surface.surface().vertices;
  const auto [low, high] = box_of(vertices);
  const Box own = box_in_file(scenario, vertices);
  touch.low = own.low;
  touch.high = own.high;
  touch.size = high - low;
  touch.thickness = touch.size.z();
  const Vec3 middle = 0.5 * (low + high);
  touch.lowest = {scenario.finger.x.value_or(middle.x()), scenario.finger.y.value_or(middle.y()),
                  high.z()};
  const double radius = scenario.finger.radius;
  const Vec3 centre = Vec3::Zero();
  FirstTouch first;
  try {
    first = lowered_onto(surface, touch.lowest, {{&centre, 1}, radius});
  } catch (const KeyError& error) {
    set_beside(touch, error);
    return touch;
  }
  touch.position = surface.position(first.at);
  set_to_base(touch, surface.surface(), touch.position, scenario);
  if (!scenario.finger.at.empty() && scenario.finger.towards.empty())
    touch.around = mean_normal(surface, first.at, 0.5 * radius);
  if (first.on_crease) {
    touch.to_edge = 0.0;
    touch.cannot = on_an_edge;
    touch.width = width_on_edge(surface, first.finger, radius,
                                deepest_travel(scenario, law_on_flat(scenario)));
    return touch;
  }
  touch.to_edge = to_creases(surface, surface.position(first.at), surface.normal(first.at));
  const geometry::CurvatureEstimate found = curvature_of_file(surface, first.at, scenario);
  if (!found.known()) {
    touch.cannot = "the surface's curvature at " + place_text(scenario, touch.position) +
                   ", where the finger touches it, cannot be estimated: " +
                   std::string(geometry::explanation(found.status));
    return touch;
  }
  touch.curvature = geometry::turned_to(found.curvature, surface.normal(first.at));
  touch.one_sided = found.status == geometry::StarStatus::one_sided;
  touch.thickness = thickness_under(surface.surface(), touch.position);
  put(touch, touch.position, radius);
  return touch;
}

}  // namespace

double thickness_under(const geometry::Surface& surface, const Vec3& point) {
  return below(surface, point).first;
}

geometry::CurvatureEstimate curvature_of_file(const geometry::SmoothSurface& surface,
                                              const geometry::SurfacePoint& at,
                                              const Scenario& scenario) {
  constexpr int most_rings = 20;
  const double edge = edges_around(surface, at.triangle);
  contact::SphereLaw law = law_on_flat(scenario);
  const int least = scenario.contact.curvature_rings;
  geometry::CurvatureOptions options;
  options.method = scenario.contact.curvature;
  geometry::CurvatureEstimate estimate;
  for (int before = most_rings + 1;; before = options.rings) {
    const double span = contact::hertz::contact_radius(deepest_travel(scenario, law), law.radius);
    options.rings =
        std::clamp(static_cast<int>(std::lround(span / edge)), least, std::max(least, most_rings));
    // A surface that is rounder than the flat of the first guess has a smaller contact.
    if (options.rings >= before) return estimate;
    estimate = curvature_over(surface, at, options);
    if (!estimate.known()) return estimate;
    const auto& [kappa_1, kappa_2] =
        std::pair(estimate.curvature.kappa_1, estimate.curvature.kappa_2);
    const double inverse = 1.0 / scenario.finger.radius;
    if (!(inverse + kappa_2 > 0.0)) return estimate;
    law.radius = contact::geometric_radius(scenario.finger.radius, kappa_1, kappa_2);
  }
}

double width_on_edge(const geometry::SmoothSurface& surface, const Vec3& centre, double radius,
                     double deepest) {
  if (!(deepest > 0.0)) return 1.0;
  const auto closest_point =
      surface.closest_point(centre, geometry::BoxTree(surface.surface()).nearest(centre));
  if (!closest_point.on_crease) return 1.0;
  const Vec3 towards = (centre - closest_point.position).normalized();
  const double flat = 2.0 * deepest / radius;
  double width = 0.0;
  for (const geometry::SurfacePoint& side : {closest_point.at, closest_point.beyond}) {
    constexpr double steepest = 0.1;  // its cosine
    const double cosine = std::clamp(surface.normal(side).dot(towards), steepest, 1.0);
    const double slope = std::sqrt(1.0 - cosine * cosine) / cosine;
    width += 0.5 * (std::sqrt(slope * slope + flat) - slope) / std::sqrt(flat);
  }
  return width;
}

double SurfaceTouch::inclination() const {
  return std::acos(std::min(1.0, curvature.normal.z())) * 180.0 / std::numbers::pi;
}

SurfaceTouch::Pressed SurfaceTouch::pressed(double radius, double travel) const {
  // The distance from the surface has the second derivatives kappa / (1 + kappa R) at the centre.
  const auto& [kappa_1, kappa_2, t_1, t_2, normal] = curvature;
  const double bend_1 = t_1.z() * kappa_1 / (1.0 + kappa_1 * radius);
  const double bend_2 = t_2.z() * kappa_2 / (1.0 + kappa_2 * radius);
  return {travel * normal.z() - 0.5 * travel * travel * (bend_1 * t_1.z() + bend_2 * t_2.z()),
          (normal - travel * (bend_1 * t_1 + bend_2 * t_2)).normalized()};
}

SurfaceTouch surface_touch(const Scenario& scenario, const std::string& folder,
                           SpecimenShapes& shapes) {
  if (const auto shape = parametric(scenario.tissue.shape)) return of_shape(*shape, scenario);
  if (const auto* half = std::get_if<scenario::HalfSpace>(&scenario.tissue.shape))
    return of_half_space(*half);
  if (std::holds_alternative<scenario::SurfaceFile>(scenario.tissue.shape)) {
    const SpecimenShapes::FileSurface& read = shapes.surface(scenario, folder);
    if (read.surface) {
      SurfaceTouch touch = of_file(*read.surface, scenario);
      touch.warning = read.warning;
      return touch;
    }
    SurfaceTouch touch;
    touch.cannot = read.fault;
    touch.nowhere = true;
    return touch;
  }
  // The mesh is as it is in the file.
  Scenario plain = scenario;
  scenario::refinement(plain.tissue.mesh).refine = false;
  const SpecimenShape& shape = shapes.shape(plain, folder);
  SurfaceTouch touch = of_file(shape.surface, scenario);
  touch.warning = shape.warning;
  if (touch.known()) touch.cannot = "its shape comes from a file of tetrahedra";
  return touch;
}

}  // namespace palpate::scene
