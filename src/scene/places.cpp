// Boxes of bodies and regions, and the volume of a ball inside a surface.
#include "scene/places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <tuple>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "base/vec3.h"
#include "geometry/box_tree.h"
#include "geometry/half_edges.h"
#include "meshing/mesh_check.h"
#include "scenario/programme.h"
#include "scene/first_touch.h"
#include "scene/specimen_mesh.h"
#include "scene/specimen_shape.h"

namespace palpate::scene {
namespace {

constexpr double least_inside = 0.99;

// With four digits of its length, however far from the origin it lies.
std::string range_text(double low, double high) {
  const double far = std::max(std::abs(low), std::abs(high));
  const int more = high > low ? static_cast<int>(std::log10(far / (high - low))) : 0;
  const int digits = 4 + std::clamp(more, 0, 9);
  const double rounding = 1e-9 * (high - low);
  const auto text = [&](double end) {
    return rounded_text(std::abs(end) < rounding ? 0.0 : unit::mm.from_si(end), digits);
  };
  return text(low) + " to " + text(high);
}

// What is wrong with a region of which `inside` lies in the body; both are named with their boxes.
std::string outside(std::size_t region, double inside, const std::string& own,
                    const std::string& body, const std::string& remedy) {
  const std::string which = "`[[region]]` " + std::to_string(region + 1);
  return (inside > 0.0 ? "only " + percent_text(inside) + " of " + which + " lies inside the body"
                       : which + " lies outside the body") +
         ": it has " + own + ", the body " + body + "; " + remedy;
}

// The cavity of a body in which most of a ball lies that is not in the tissue, of which `inside`
// is; nothing if that is outside the body.
std::optional<geometry::Surface> cavity_around(const geometry::Surface& body,
                                               const geometry::Inclusion& ball, double inside) {
  for (const auto& [part, triangles] : geometry::parts_of(body))
    if (geometry::enclosed(part).volume < 0.0 && share_inside(part, ball) > 0.5 * (1.0 - inside))
      return part;
  return std::nullopt;
}

}  // namespace

std::string box_text(const Box& box) {
  const auto& [low, high] = box;
  return "x " + range_text(low.x(), high.x()) + ", y " + range_text(low.y(), high.y()) + ", z " +
         range_text(low.z(), high.z()) + " mm";
}

std::string coordinates_text(const scenario::Resolved& scenario) {
  return parametric(scenario.tissue.shape) ? "from the lowest corner of its box"
                                           : "in the file's coordinates";
}

std::string place_text(const scenario::Resolved& scenario, const Vec3& place) {
  return vector_text(scenario.tissue.turn.transpose() * place / 1e-3) + " mm";
}

namespace {

// The smallest rotation that takes a unit vector to z; exact for axes.
Eigen::Matrix3d turn_up(const Vec3& up) {
  if (up.z() < -0.999999) {
    const Eigen::DiagonalMatrix<double, 3> over(1.0, -1.0, -1.0);
    return turn_up(over * up) * over;
  }
  const Vec3 axis = up.cross(Vec3::UnitZ());
  Eigen::Matrix3d skew;
  skew << 0.0, -axis.z(), axis.y(), axis.z(), 0.0, -axis.x(), -axis.y(), axis.x(), 0.0;
  return Eigen::Matrix3d::Identity() + skew + skew * skew / (1.0 + up.z());
}

Vec3 direction_or(const std::string& text, const Vec3& otherwise) {
  return scenario::direction_of(text).value_or(otherwise);
}

bool from_file(const scenario::Resolved& scenario) {
  return std::holds_alternative<scenario::SurfaceFile>(scenario.tissue.shape) ||
         std::holds_alternative<scenario::AsMeshed>(scenario.tissue.shape);
}

// The body's upward direction in the coordinates of its file.
Vec3 up_of(const scenario::Resolved& scenario) {
  const auto* file = std::get_if<scenario::SurfaceFile>(&scenario.tissue.shape);
  const auto* meshed = std::get_if<scenario::AsMeshed>(&scenario.tissue.shape);
  return direction_or(file != nullptr     ? file->up
                      : meshed != nullptr ? meshed->up
                                          : "",
                      Vec3::UnitZ());
}

// The body's surface as its file gives it; null if it cannot be read.
std::shared_ptr<const geometry::SmoothSurface> unturned(const scenario::Resolved& scenario,
                                                        const std::string& folder,
                                                        SpecimenShapes& shapes) {
  if (std::holds_alternative<scenario::SurfaceFile>(scenario.tissue.shape))
    return shapes.surface(scenario, folder).surface;
  const auto* file = std::get_if<scenario::MeshFile>(&scenario.tissue.mesh);
  if (file == nullptr) return nullptr;
  const geometry::TetMesh mesh = mesh_of(*file, folder).mesh;
  meshing::check(mesh, "the mesh of " + file->file, 0.0);
  return std::make_shared<const geometry::SmoothSurface>(geometry::outer_surface(mesh).surface);
}

// The height of the flat underside at `low`, with the rounding of a file; nothing where the lowest
// triangles are facets of a round body: a small part of its surface with blunt edges around it.
std::optional<double> flat_underside(const geometry::Surface& body, const Vec3& up, double low) {
  constexpr double least_part = 0.05;
  const Box box = box_of(body.vertices);
  const double rounding = 1e-5 * (box.high - box.low).norm();
  double level = low, flat = 0.0, all = 0.0, sharp = 0.0, around = 0.0;
  std::vector<char> lowest(body.triangles.size(), 0);
  for (std::size_t t = 0; t < lowest.size(); ++t) {
    double highest = low;
    for (const int vertex : body.triangles[t])
      highest = std::max(highest, body.vertices[as_index(vertex)].dot(up));
    const double area = geometry::twice_area(body, static_cast<int>(t)).norm();
    all += area;
    if (highest > low + rounding) continue;
    lowest[t] = 1;
    flat += area;
    level = std::max(level, highest);
  }
  if (!(flat > 0.0)) return std::nullopt;
  if (flat > least_part * all) return level;
  const geometry::Neighbours neighbours(body);
  for (std::size_t t = 0; t < lowest.size(); ++t)
    for (std::size_t side = 0; side < 3 && lowest[t] != 0; ++side) {
      const int other = neighbours.across(static_cast<int>(t))[side];
      if (other < 0 || lowest[as_index(other)] != 0) continue;
      const double length = (body.vertices[as_index(body.triangles[t][(side + 1) % 3])] -
                             body.vertices[as_index(body.triangles[t][side])])
                                .norm();
      around += length;
      if (geometry::twice_area(body, other).normalized().dot(-up) < geometry::crease_cosine)
        sharp += length;
    }
  if (sharp > 0.5 * around) return level;
  return std::nullopt;
}

// The outward direction of a group of faces of the body's file, which becomes the base.
Vec3 side_of_group(scenario::Resolved& scenario, const std::string& folder,
                   SpecimenShapes& shapes) {
  const auto surface = unturned(scenario, folder, shapes);
  if (!surface) return Vec3::Zero();
  const auto faces = faces_of_base(scenario, folder);
  const geometry::Surface& body = surface->surface();
  const geometry::BoxTree tree(body);
  Vec3 outwards = Vec3::Zero();
  double own = 0.0;
  for (const auto& [a, b, c] : faces) {
    const double area = 0.5 * (b - a).cross(c - a).norm();
    const int nearest = tree.nearest((a + b + c) / 3.0).triangle;
    outwards += area * geometry::twice_area(body, nearest).normalized();
    own += area;
  }
  const std::string base =
      "the faces of the group `" + scenario.tissue.base_side + "` of `tissue.base_side` ";
  if (outwards.norm() < 0.5 * own)
    throw MeshError(base +
                    "look in many directions, so that they are no side that can be fixed; name a "
                    "flatter group");
  outwards.normalize();
  double height = -HUGE_VAL;
  for (const auto& face : faces)
    for (const Vec3& corner : face) height = std::max(height, -corner.dot(outwards));
  const double rounding = 1e-6 * std::sqrt(own);
  double beyond = 0.0;
  for (int t = 0; t < static_cast<int>(body.triangles.size()); ++t) {
    const auto& [a, b, c] = body.triangles[as_index(t)];
    const Vec3 middle =
        (body.vertices[as_index(a)] + body.vertices[as_index(b)] + body.vertices[as_index(c)]) /
        3.0;
    if (-middle.dot(outwards) <= height + rounding)
      beyond += 0.5 * geometry::twice_area(body, t).norm();
  }
  constexpr double allowed = 0.1;
  if (std::abs(beyond - own) > allowed * own)
    throw MeshError(base + "have " + rounded_text(1e6 * own) +
                    " mm^2, but the surface beyond the " +
                    "plane through them, which would be fixed, has " + rounded_text(1e6 * beyond) +
                    " mm^2; name a group that is the whole end of the body on one side");
  const double low = geometry::reach_along(body.vertices, -outwards).first;
  if (!flat_underside(body, -outwards, low) || height > low + rounding)
    scenario.tissue.base_height = std::max(low, height) + rounding;
  return outwards;
}

// A flat top with its borders, or the highest triangle of a body without one.
struct Top {
  geometry::Surface surface;
  std::vector<std::vector<std::array<Vec3, 2>>> borders;

  // Whether a place lies in a hole of it, seen from above: some border runs around the place, but
  // not all of them together.
  [[nodiscard]] bool has_hole_at(const Vec3& place) const {
    double turns = 0.0;
    bool around = false;
    for (const auto& border : borders) {
      double angle = 0.0;
      for (const auto& [from, to] : border) {
        const Vec3 a = from - place, b = to - place;
        angle += std::atan2(a.x() * b.y() - a.y() * b.x(), a.head<2>().dot(b.head<2>()));
      }
      around = around || std::abs(angle) > M_PI;
      turns += angle;
    }
    return around && std::abs(turns) < M_PI;
  }

  // The place, of some in every triangle, that is farthest from the borders.
  [[nodiscard]] Vec3 innermost() const {
    constexpr double enough = 4e4;  // places
    const double triangles = static_cast<double>(surface.triangles.size());
    const int parts = std::clamp(static_cast<int>(std::sqrt(enough / triangles)), 3, 24);
    Vec3 best = Vec3::Zero();
    double most = 0.0;
    for (const auto& [a, b, c] : surface.triangles)
      for (int i = 0; i <= parts; ++i)
        for (int j = 0; i + j <= parts; ++j) {
          const Vec3 place =
              (i * surface.vertices[as_index(a)] + j * surface.vertices[as_index(b)] +
               (parts - i - j) * surface.vertices[as_index(c)]) /
              parts;
          double nearest = HUGE_VAL;
          for (const auto& border : borders)
            for (const auto& [from, to] : border) {
              const Vec3 along = to - from;
              const double at =
                  std::clamp((place - from).dot(along) / along.squaredNorm(), 0.0, 1.0);
              nearest = std::min(nearest, (place - from - at * along).norm());
            }
          constexpr double rounding = 1e-6;
          if (nearest <= (1.0 + rounding) * most) continue;
          most = nearest;
          best = place;
        }
    return best;
  }
};

Top top_of(const geometry::Surface& body) {
  const Box box = box_of(body.vertices);
  const double rounding = 1e-6 * box.diagonal();
  std::vector<int> flat;
  int highest = 0;
  double height = -HUGE_VAL;
  for (int t = 0; t < static_cast<int>(body.triangles.size()); ++t) {
    double low = HUGE_VAL, sum = 0.0;
    for (const int v : body.triangles[as_index(t)]) {
      low = std::min(low, body.vertices[as_index(v)].z());
      sum += body.vertices[as_index(v)].z();
    }
    if (low >= box.high.z() - rounding) flat.push_back(t);
    if (sum <= height) continue;
    height = sum;
    highest = t;
  }
  if (flat.empty()) flat.push_back(highest);
  Top top{geometry::piece_of(body, flat), {}};
  for (const auto& hole : geometry::joints(top.surface).holes) {
    auto& border = top.borders.emplace_back();
    for (const auto& edge : hole)
      border.push_back(
          {top.surface.vertices[as_index(edge.from)], top.surface.vertices[as_index(edge.to)]});
  }
  return top;
}

// A finger without a place presses the middle of the body's box. Where that is beside the body, as
// in a ring, or a hollow of a flat top on whose rim the finger rests, it presses the top.
void leave_empty_middle(scenario::Resolved& scenario, const geometry::SmoothSurface& surface) {
  const geometry::Surface& body = surface.surface();
  const Box box = box_of(body.vertices);
  const Vec3 middle(0.5 * (box.low.x() + box.high.x()), 0.5 * (box.low.y() + box.high.y()),
                    box.high.z());
  const auto beside = [&](const std::array<int, 3>& triangle) {
    const auto side = [&](std::size_t i) {
      const Vec3 from = body.vertices[as_index(triangle[i])] - middle;
      const Vec3 to = body.vertices[as_index(triangle[(i + 1) % 3])] - middle;
      return from.x() * to.y() - from.y() * to.x() >= 0.0;
    };
    return side(0) != side(1) || side(1) != side(2);
  };
  const Top top = top_of(body);
  const bool hollow = top.has_hole_at(middle);
  if (!hollow && !std::ranges::all_of(body.triangles, beside)) return;
  const Vec3 centre = Vec3::Zero();
  try {
    const FirstTouch first = lowered_onto(surface, middle, {{&centre, 1}, scenario.finger.radius});
    if (!hollow || !first.on_crease) return;
  } catch (const MeshError&) {
  }
  const Vec3 place = top.innermost();
  scenario.finger.x = place.x();
  scenario.finger.y = place.y();
  scenario.finger.moved = true;
}

// The nearest place of a surface without the walls of its cavities.
geometry::SurfacePoint nearest_outside(const geometry::Surface& surface, const Vec3& place) {
  geometry::SurfacePoint found;
  double least = HUGE_VAL;
  for (const auto& [part, triangles] : geometry::parts_of(surface)) {
    if (geometry::enclosed(part).volume < 0.0) continue;
    const geometry::Near near = geometry::BoxTree(part).nearest(place);
    if (near.distance_squared >= least) continue;
    least = near.distance_squared;
    found = {triangles[as_index(near.triangle)], near.weights};
  }
  return found;
}

}  // namespace

void place_in_scene(scenario::Resolved& scenario, const std::string& folder,
                    SpecimenShapes& shapes) {
  if (!from_file(scenario)) return;
  const Vec3 up = up_of(scenario);
  scenario::Resolved::Finger& finger = scenario.finger;
  Vec3 towards = direction_or(finger.towards, -up);
  Vec3 place = Vec3::Zero();
  if (finger.at.size() == 3 && !scenario.uniform()) {
    place = Vec3(finger.at[0], finger.at[1], finger.at[2]);
    const auto* file = std::get_if<scenario::SurfaceFile>(&scenario.tissue.shape);
    if (file != nullptr && !file->part)
      scenario.tissue.near_part = shapes.near_part(scenario, folder, place);
    const auto surface = unturned(scenario, folder, shapes);
    if (!surface) return;
    const geometry::SurfacePoint at = nearest_outside(surface->surface(), place);
    finger.beside = (place - surface->position(at)).norm();
    place = surface->position(at);
    if (finger.towards.empty()) towards = -surface->normal(at);
  }
  const Eigen::Matrix3d turn = turn_up(scenario.uniform() ? up : Vec3(-towards));
  scenario.tissue.turn = turn;
  const std::string& side = scenario.tissue.base_side;
  const Vec3 base_up = side.empty() || scenario::direction_of(side)
                           ? Vec3(-direction_or(side, -up))
                           : Vec3(-side_of_group(scenario, folder, shapes));
  // To the last bit along an axis of the scene, where the file's rounding is all that differs.
  constexpr double rounding = 1e-6;
  scenario.tissue.base_up = scenario.uniform() ? Vec3(Vec3::UnitZ()) : Vec3(turn * base_up);
  for (const int axis : {0, 1, 2})
    for (const double sign : {1.0, -1.0})
      if (const Vec3 along = sign * Vec3::Unit(axis);
          (scenario.tissue.base_up - along).norm() < rounding)
        scenario.tissue.base_up = along;
  for (scenario::Resolved::Region& region : scenario.regions)
    if (auto* inclusion = std::get_if<scenario::Inclusion>(&region.part)) {
      const Vec3 centre =
          turn * Vec3(inclusion->centre[0], inclusion->centre[1], inclusion->centre[2]);
      inclusion->centre = {centre.x(), centre.y(), centre.z()};
    }
  if (scenario.uniform()) return;
  if (finger.at.size() == 3) {
    const Vec3 turned = turn * place;
    finger.x = turned.x();
    finger.y = turned.y();
    finger.height = turned.z();
  } else if (!finger.x && !finger.y) {
    if (std::holds_alternative<scenario::AsMeshed>(scenario.tissue.shape)) {
      scenario::Resolved plain = scenario;
      scenario::refinement(plain.tissue.mesh).refine = false;
      leave_empty_middle(scenario, shapes.shape(plain, folder).surface);
    } else if (const auto& surface = shapes.surface(scenario, folder).surface) {
      leave_empty_middle(scenario, *surface);
    }
  }
}

Eigen::Matrix3d standing(const scenario::Resolved& scenario) { return turn_up(up_of(scenario)); }

Box box_in_file(const scenario::Resolved& scenario, std::span<const Vec3> places) {
  std::vector<Vec3> own;
  for (const Vec3& place : places) own.emplace_back(scenario.tissue.turn.transpose() * place);
  return box_of(own);
}

double base_level(const scenario::Resolved& scenario, const geometry::Surface& body) {
  if (scenario.tissue.base_height) return *scenario.tissue.base_height;
  const Vec3& up = scenario.tissue.base_up;
  const auto [low, high] = geometry::reach_along(body.vertices, up);
  return flat_underside(body, up, low).value_or(low + 0.1 * (high - low));
}

void refuse_held(const scenario::Resolved& scenario, double base_level, const Vec3& touched) {
  const scenario::PlainFinger& finger = scenario.finger;
  if (touched.dot(scenario.tissue.base_up) <= base_level)
    throw KeyError(
        !finger.towards.empty()       ? "finger.towards"
        : !finger.at.empty()          ? "finger.at"
        : scenario.tissue.base_height ? "tissue.base_height"
                                      : "tissue.base_side",
        "the finger presses the side that the base holds, which cannot give way; change "
        "`finger.at` or `finger.towards`, or `tissue.base_side` or `tissue.base_height`");
}

namespace {

// The part of a triangle that lies below a level of a linear height with these corners.
double share_below(std::array<double, 3> heights, double level) {
  std::ranges::sort(heights);
  const auto& [low, middle, high] = heights;
  if (level >= high) return 1.0;
  if (level <= low) return 0.0;
  if (level < middle) return (level - low) * (level - low) / ((middle - low) * (high - low));
  return 1.0 - (high - level) * (high - level) / ((high - middle) * (high - low));
}

}  // namespace

BaseArea base_area(const scenario::Resolved& scenario, const geometry::Surface& body,
                   const Vec3& place, double radius) {
  const Vec3& up = scenario.tissue.base_up;
  const Box box = box_of(body.vertices);
  const double level = base_level(scenario, body) + 1e-9 * (box.high - box.low).norm();
  double base = 0.0, below = 0.0, held = 0.0, whole = 0.0, whole_held = 0.0;
  for (int t = 0; t < static_cast<int>(body.triangles.size()); ++t) {
    Vec3 middle = Vec3::Zero();
    std::array<double, 3> heights{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& corner = body.vertices[as_index(body.triangles[as_index(t)][k])];
      middle += corner / 3.0;
      heights[k] = corner.dot(up);
    }
    const Vec3 area = 0.5 * geometry::twice_area(body, t);
    const double fixed = share_below(heights, level);
    base += fixed * area.norm();
    if (area.z() >= 0.0) continue;
    whole -= area.z();
    whole_held -= fixed * area.z();
    if ((middle - place).head<2>().norm() > radius) continue;
    below -= area.z();
    held -= fixed * area.z();
  }
  if (!(below > 0.0)) std::tie(held, below) = std::pair(whole_held, whole);  // of few triangles
  return {base / geometry::area(body), below > 0.0 ? held / below : 0.0};
}

double share_inside(const geometry::Surface& body, const geometry::Inclusion& inclusion) {
  // Vertical lines through a grid on the inclusion's disc; its offset avoids vertices and edges.
  constexpr int lines = 41;
  constexpr double offset = 0.4142;
  const double step = 2.0 * inclusion.radius / lines;
  const double r = inclusion.radius;
  const auto along = [&](int axis, int i) {
    return inclusion.centre[axis] - r + (i + offset + 0.01 * axis) * step;
  };
  std::vector<std::vector<double>> crossings(lines * lines);
  for (const auto& triangle : body.triangles) {
    const Vec3& a = body.vertices[as_index(triangle[0])];
    const Vec3& b = body.vertices[as_index(triangle[1])];
    const Vec3& c = body.vertices[as_index(triangle[2])];
    std::array<int, 2> first{}, last{};
    for (int axis = 0; axis < 2; ++axis) {
      const auto index = [&](double at) {
        return std::clamp((at - along(axis, 0)) / step, -1.0, static_cast<double>(lines));
      };
      first[as_index(axis)] =
          std::max(0, static_cast<int>(std::ceil(index(std::min({a[axis], b[axis], c[axis]})))));
      last[as_index(axis)] = std::min(
          lines - 1, static_cast<int>(std::floor(index(std::max({a[axis], b[axis], c[axis]})))));
    }
    const Vec3 normal = (b - a).cross(c - a);
    if (normal.z() == 0.0) continue;
    for (int i = first[0]; i <= last[0]; ++i)
      for (int j = first[1]; j <= last[1]; ++j) {
        const double x = along(0, i), y = along(1, j);
        const auto side = [&](const Vec3& from, const Vec3& to) {
          return (to.x() - from.x()) * (y - from.y()) - (to.y() - from.y()) * (x - from.x()) > 0.0;
        };
        if (side(a, b) != side(b, c) || side(b, c) != side(c, a)) continue;
        crossings[as_index(i * lines + j)].push_back(
            a.z() - (normal.x() * (x - a.x()) + normal.y() * (y - a.y())) / normal.z());
      }
  }
  double inside = 0.0, all = 0.0;
  for (int i = 0; i < lines; ++i)
    for (int j = 0; j < lines; ++j) {
      const double x = along(0, i) - inclusion.centre.x(), y = along(1, j) - inclusion.centre.y();
      const double half = std::sqrt(std::max(0.0, r * r - x * x - y * y));
      all += 2.0 * half;
      std::vector<double>& heights = crossings[as_index(i * lines + j)];
      std::ranges::sort(heights);
      for (std::size_t k = 0; k + 1 < heights.size(); k += 2)
        inside += std::max(0.0, std::min(heights[k + 1], inclusion.centre.z() + half) -
                                    std::max(heights[k], inclusion.centre.z() - half));
    }
  return inside / all;
}

void refuse_outside(const scenario::Resolved& scenario, const geometry::Surface& body,
                    const scenario::Family& family, const std::string& part) {
  const Box box = box_of(body.vertices);
  const std::string own_box = box_text(box_in_file(scenario, body.vertices));
  const std::string where =
      ", " + coordinates_text(scenario) + (part.empty() ? "" : ", where it is " + part);
  for (std::size_t i = 0; i < scenario.regions.size(); ++i) {
    const std::string path = "region." + std::to_string(i + 1);
    if (const auto* slab = std::get_if<scenario::Slab>(&scenario.regions[i].part)) {
      const double inside =
          std::max(0.0, std::min(slab->top, box.high.z()) - std::max(slab->bottom, box.low.z()));
      const double share = inside / (slab->top - slab->bottom);
      if (share < least_inside)
        throw InputError(place_of(family.document, path + ".bottom"),
                         outside(i, share, "z " + range_text(slab->bottom, slab->top) + " mm",
                                 "z " + range_text(box.low.z(), box.high.z()) + " mm" + where,
                                 "change `bottom` and `top`"));
    }
    if (const auto* ball = std::get_if<scenario::Inclusion>(&scenario.regions[i].part)) {
      const Vec3 centre(ball->centre[0], ball->centre[1], ball->centre[2]);
      const double share = share_inside(body, {centre, ball->radius, 0});
      const Vec3 in_file = scenario.tissue.turn.transpose() * centre;
      const Vec3 around = Vec3::Constant(ball->radius);
      const Box own{in_file - around, in_file + around};
      if (share >= least_inside) continue;
      std::string text =
          outside(i, share, box_text(own), own_box + where, "change `centre` or `radius`");
      if (const auto cavity = cavity_around(body, {centre, ball->radius, 0}, share))
        text = "`[[region]]` " + std::to_string(i + 1) + " lies " +
               (share > 0.0 ? "with " + percent_text(1.0 - share) + " of its volume " : "") +
               "in a cavity of the body: it has " + box_text(own) + ", the cavity " +
               box_text(box_in_file(scenario, cavity->vertices)) + where +
               "; change `centre` or `radius`";
      throw InputError(place_of(family.document, path + ".centre"), text);
    }
  }
  const auto& height = scenario.tissue.base_height;
  if (!height) return;
  const auto [low, high] = geometry::reach_along(body.vertices, scenario.tissue.base_up);
  if (*height < low || *height >= high)
    throw InputError(place_of(family.document, "tissue.base_height"),
                     "the base ends at a height of " + rounded_text(unit::mm.from_si(*height), 4) +
                         " mm, but the body has " + range_text(low, high) + " mm" + where +
                         "; give a height between the two");
}

void refuse_misplaced(const scenario::Resolved& scenario, const scenario::Family& family,
                      SpecimenShapes& shapes) {
  const bool placed = std::ranges::any_of(scenario.regions, [](const auto& region) {
    return !std::holds_alternative<scenario::TaggedRegion>(region.part);
  });
  if (!placed && !scenario.tissue.base_height) return;
  if (const auto shape = parametric(scenario.tissue.shape)) {
    constexpr double spacing_over_size = 0.02;  // a chord is then 1e-4 of the size inside
    const double spacing = spacing_over_size * geometry::extent(*shape).norm();
    refuse_outside(scenario, geometry::sampled(*shape, {spacing, spacing}).parts.front().surface,
                   family);
  } else if (std::holds_alternative<scenario::SurfaceFile>(scenario.tissue.shape)) {
    const auto& read = shapes.surface(scenario, family.folder);
    if (read.surface) refuse_outside(scenario, read.surface->surface(), family, read.part);
  }
}

}  // namespace palpate::scene
