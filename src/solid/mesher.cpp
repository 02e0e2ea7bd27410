// Samples the body's faces, cuts them at planes, refines them, and lets TetGen fill them.
#include "solid/mesher.h"

#include <algorithm>
#include <map>
#include <set>

#include "base/error.h"
#include "geometry/body.h"
#include "geometry/box.h"
#include "geometry/box_tree.h"
#include "geometry/half_edges.h"
#include "meshing/bisection.h"
#include "meshing/cgal_library.h"
#include "meshing/tetgen.h"

namespace palpate::solid {
namespace {

constexpr double time_limit = 60.0;  // s
constexpr double growth = 0.35;

// Numbers of faces: flat ones, those of a file, the shape's round ones, then spheres, then planes.
enum Number { flat = 1, of_file = 2, first_round = 3, first_sphere = 10, first_plane = 1000 };

// How thick a body is inwards from its surface, where neither side is held.
class Walls {
 public:
  Walls(const geometry::Surface& surface, const std::optional<Plane>& base)
      : triangles_(surface.triangles), tree_(surface) {
    const double size = geometry::box_of(surface.vertices).diagonal();
    const double rounding = 1e-6 * size;
    thickness_.assign(surface.vertices.size(), size);
    const auto held = [&](const Vec3& side) { return base && base->beyond(side) < rounding; };
    for (int t = 0; t < static_cast<int>(triangles_.size()); ++t) {
      const auto& corners = triangles_[as_index(t)];
      Vec3 middle = Vec3::Zero();
      for (const int v : corners) middle += surface.vertices[as_index(v)] / 3.0;
      const Vec3 inwards = -geometry::twice_area(surface, t).normalized();
      const double thickness = tree_.first_along(middle, inwards, rounding);
      if (held(middle) || held(middle + thickness * inwards)) continue;
      for (const int v : corners) {
        double& least = thickness_[as_index(v)];
        least = std::min(least, thickness);
      }
    }
  }

  // m, at the nearest place of the surface.
  [[nodiscard]] double at(const Vec3& place) const {
    const geometry::Near near = tree_.nearest(place);
    double sum = 0.0;
    for (Eigen::Index i = 0; i < 3; ++i)
      sum +=
          near.weights[i] * thickness_[as_index(triangles_[as_index(near.triangle)][as_index(i)])];
    return sum;
  }

 private:
  std::vector<std::array<int, 3>> triangles_;
  geometry::BoxTree tree_;
  std::vector<double> thickness_;  // m, the least around each vertex
};

class Mesher {
 public:
  explicit Mesher(const MeshOrder& order) : order_(order) {
    if (order.surface != nullptr) tree_.emplace(order.surface->surface());
  }

  [[nodiscard]] Mesh made() {
    sample();
    SurfaceNet net(
        std::move(faces_), std::move(numbers_),
        [this](const Vec3& point, std::span<const int> numbers) { return onto(point, numbers); });
    if (!order_.movable) net.only_split();
    for (const Plane& mirror : order_.mirrors) {
      net.cut(mirror);
      net.drop_below(mirror);
    }
    for (const Inclusion& one : order_.inclusions)
      if (!one.sphere)
        for (const double level : {one.bottom, one.top})
          if (level > box_.low.z() && level < box_.high.z()) add_level(level);
    for (const Plane& level : levels_) net.cut(level);
    if (const auto& base = order_.base;
        base && std::none_of(levels_.begin(), levels_.end(), [&](const Plane& level) {
          return !base->inclined && level.axis == base->axis && level.at == base->at;
        }))
      net.cut(*base);
    fill_planes(net);
    const Walls walls(body_.parts.front().surface, order_.base);
    const auto size = [&](const Vec3& place) { return order_.sizes.at(place, walls.at(place)); };
    net.refine(size, order_.surface != nullptr ? std::optional<int>(of_file) : std::nullopt);
    meshing::PieceMesh filled = meshing::tetgen_pieces(
        {{net.vertices(), net.triangles()}, net.numbers()}, size, time_limit);
    const std::vector<int> number =
        meshing::name_regions(filled.mesh, [this](const Vec3& place) { return region_at(place); });
    for (auto& face : filled.faces)
      for (int& node : face) node = number[as_index(node)];
    return curved(filled);
  }

 private:
  void add_level(double level) {
    for (const Plane& before : levels_)
      if (before.at == level) return;
    levels_.push_back({2, level});
  }

  void sample() {
    double spacing = order_.sizes.largest;
    if (order_.shape) {
      const auto* box = std::get_if<geometry::Cuboid>(&*order_.shape);
      const Vec3 size = geometry::extent(*order_.shape);
      // A chord of this length of the least radius is a tenth of its length off.
      if (box == nullptr) spacing = std::min(spacing, 0.35 * size.minCoeff());
      body_ = geometry::sampled(*order_.shape, {spacing, spacing});
      faces_ = geometry::facets(body_);
      for (const auto& triangle : faces_.triangles) numbers_.push_back(number_of(triangle));
    } else {
      const geometry::Surface& given = order_.surface->surface();
      auto coarse =
          order_.coarser ? meshing::remeshed(given, spacing, order_.nearer) : std::nullopt;
      body_.parts.push_back({coarse ? coarse->surface : given, 0});
      faces_ = body_.parts.front().surface;
      numbers_.assign(faces_.triangles.size(), of_file);
      for (geometry::SurfacePart& part : geometry::parts_of(faces_)) {
        if (geometry::enclosed(part.surface).volume > 0.0) continue;
        for (auto& triangle : part.surface.triangles) std::swap(triangle[1], triangle[2]);
        cavities_.push_back(std::move(part.surface));
      }
    }
    box_ = geometry::box_of(faces_.vertices);
    for (std::size_t i = 0; i < order_.inclusions.size(); ++i) {
      if (!order_.inclusions[i].sphere) continue;
      const geometry::Inclusion& sphere = *order_.inclusions[i].sphere;
      geometry::Body checked = body_;
      geometry::add_inclusion(checked, sphere, 0.5 * sphere.radius);  // refuses one that sticks out
      const double edge =
          std::min(0.75 * sphere.radius, 1.2 * order_.sizes.at(sphere.centre, HUGE_VAL));
      const geometry::Surface ball =
          geometry::ellipsoid_surface(sphere.centre, Vec3::Constant(2.0 * sphere.radius), edge);
      const int before = static_cast<int>(faces_.vertices.size());
      faces_.vertices.insert(faces_.vertices.end(), ball.vertices.begin(), ball.vertices.end());
      for (auto triangle : ball.triangles) {
        for (int& v : triangle) v += before;
        faces_.triangles.push_back(triangle);
        numbers_.push_back(first_sphere + static_cast<int>(i));
      }
    }
  }

  // Of a triangle of the sampled shape.
  [[nodiscard]] int number_of(const std::array<int, 3>& triangle) const {
    if (std::holds_alternative<geometry::Cuboid>(*order_.shape)) return flat;
    if (std::holds_alternative<geometry::Ellipsoid>(*order_.shape)) return first_round;
    const int axis = geometry::axis_of(*order_.shape);
    const double length = geometry::extent(*order_.shape)[axis];
    for (const double end : {0.0, length})
      if (std::all_of(triangle.begin(), triangle.end(), [&](int v) {
            return std::abs(faces_.vertices[as_index(v)][axis] - end) < 1e-9 * length;
          }))
        return flat;
    // All corners are on the surface; those at an end may be on two.
    return first_round +
           geometry::nearest_surface(*order_.shape, faces_.vertices[as_index(triangle[0])]);
  }

  // The place on the first of these faces that is not flat.
  [[nodiscard]] Vec3 onto(const Vec3& point, std::span<const int> numbers) const {
    for (const int number : numbers)
      if (number >= first_sphere && number < first_plane) {
        const geometry::Inclusion& sphere =
            *order_.inclusions[as_index(number - first_sphere)].sphere;
        return sphere.centre + sphere.radius * (point - sphere.centre).normalized();
      }
    for (const int number : numbers) {
      if (number >= first_round && number < first_sphere)
        return geometry::onto(*order_.shape, point, number - first_round);
      if (number == of_file) {
        const geometry::Near near = tree_->nearest(point);
        return order_.surface->closest_point(point, near).position;
      }
    }
    return point;
  }

  // Triangles on mirrors and between slabs.
  void fill_planes(SurfaceNet& net) const {
    std::vector<Plane> planes = order_.mirrors;
    planes.insert(planes.end(), levels_.begin(), levels_.end());
    std::vector<std::set<std::array<int, 2>>> segments(planes.size());
    // Where two planes meet inside the body.
    for (std::size_t p = 0; p < planes.size(); ++p)
      for (std::size_t q = 0; q < p; ++q) {
        if (planes[p].axis == planes[q].axis) continue;
        const int along = 3 - planes[p].axis - planes[q].axis;
        for (const Plane& third : planes) {
          if (third.axis != along) continue;
          Vec3 corner;
          for (const Plane& plane : {planes[p], planes[q], third}) corner[plane.axis] = plane.at;
          if (std::none_of(net.vertices().begin(), net.vertices().end(),
                           [&](const Vec3& v) { return v == corner; }) &&
              geometry::encloses(body_.parts.front().surface, corner))
            net.add(corner);
        }
      }
    for (std::size_t p = 0; p < planes.size(); ++p) {
      for (const auto& edge : net.edges_on(planes[p])) segments[p].insert(edge);
      for (std::size_t q = 0; q < p; ++q) {
        if (planes[p].axis == planes[q].axis) continue;
        const int along = 3 - planes[p].axis - planes[q].axis;
        std::vector<std::pair<double, int>> on_line;
        for (int v = 0; v < static_cast<int>(net.vertices().size()); ++v) {
          const Vec3& place = net.vertices()[as_index(v)];
          if (planes[p].beyond(place) == 0.0 && planes[q].beyond(place) == 0.0)
            on_line.emplace_back(place[along], v);
        }
        std::sort(on_line.begin(), on_line.end());
        for (std::size_t i = 1; i < on_line.size(); ++i) {
          const int a = on_line[i - 1].second;
          const int b = on_line[i].second;
          const Vec3 middle = 0.5 * (net.vertices()[as_index(a)] + net.vertices()[as_index(b)]);
          if (!geometry::encloses(body_.parts.front().surface, middle)) continue;
          const bool kept =
              std::all_of(order_.mirrors.begin(), order_.mirrors.end(),
                          [&](const Plane& mirror) { return mirror.beyond(middle) >= 0.0; });
          if (!kept) continue;
          for (const std::size_t of : {p, q}) segments[of].insert({std::min(a, b), std::max(a, b)});
        }
      }
    }
    for (std::size_t p = 0; p < planes.size(); ++p)
      fill_plane(planes[p], segments[p], first_plane + static_cast<int>(p), net);
  }

  // Adds triangles between segments on a plane, where they are inside the body.
  void fill_plane(const Plane& plane, const std::set<std::array<int, 2>>& segments, int number,
                  SurfaceNet& net) const {
    const Eigen::Index across = (plane.axis + 1) % 3;
    const Eigen::Index up = (plane.axis + 2) % 3;
    std::map<int, int> local;  // by the numbers of vertices
    std::vector<int> vertices;
    std::vector<Eigen::Vector2d> points;
    std::vector<std::array<int, 2>> edges;
    for (const auto& segment : segments) {
      std::array<int, 2> edge{};
      for (std::size_t end = 0; end < 2; ++end) {
        const auto [found, added] =
            local.try_emplace(segment[end], static_cast<int>(vertices.size()));
        edge[end] = found->second;
        if (!added) continue;
        const Vec3& place = net.vertices()[as_index(segment[end])];
        vertices.push_back(segment[end]);
        points.emplace_back(place[across], place[up]);
      }
      edges.push_back({std::min(edge[0], edge[1]), std::max(edge[0], edge[1])});
    }
    const auto triangles = meshing::cgal_library::triangulated(points, edges);
    if (!triangles)
      throw MeshError("the border of a cut through the body crosses itself; mend the surface");
    // Of triangles with no segment between them all or none are inside; the largest says which, as
    // small ones may lie between the true surface and its first sample.
    const std::set<std::array<int, 2>> borders(edges.begin(), edges.end());
    std::map<std::array<int, 2>, std::vector<std::size_t>> at;
    for (std::size_t t = 0; t < triangles->size(); ++t)
      for (std::size_t i = 0; i < 3; ++i) {
        const int a = (*triangles)[t][i];
        const int b = (*triangles)[t][(i + 1) % 3];
        at[{std::min(a, b), std::max(a, b)}].push_back(t);
      }
    std::vector<char> seen(triangles->size(), 0);
    for (std::size_t first = 0; first < triangles->size(); ++first) {
      if (seen[first] != 0) continue;
      seen[first] = 1;
      std::vector<std::size_t> together{first};
      double largest = 0.0;
      Vec3 middle = Vec3::Zero();
      for (std::size_t k = 0; k < together.size(); ++k) {
        const auto& triangle = (*triangles)[together[k]];
        const auto corner = [&](std::size_t i) -> const Vec3& {
          return net.vertices()[as_index(vertices[as_index(triangle[i])])];
        };
        const double area = (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
        if (area > largest) {
          largest = area;
          middle = (corner(0) + corner(1) + corner(2)) / 3.0;
        }
        for (std::size_t i = 0; i < 3; ++i) {
          const int a = triangle[i];
          const int b = triangle[(i + 1) % 3];
          const std::array<int, 2> edge{std::min(a, b), std::max(a, b)};
          if (borders.contains(edge)) continue;
          for (const std::size_t other : at.at(edge)) {
            if (seen[other] == 0) together.push_back(other);
            seen[other] = 1;
          }
        }
      }
      if (!geometry::encloses(body_.parts.front().surface, middle)) continue;
      for (const std::size_t t : together) {
        const auto& [a, b, c] = (*triangles)[t];
        net.add({vertices[as_index(a)], vertices[as_index(b)], vertices[as_index(c)]}, number);
      }
    }
  }

  // The tissue at a place; none in a cavity.
  [[nodiscard]] std::optional<int> region_at(const Vec3& place) const {
    for (const geometry::Surface& cavity : cavities_)
      if (geometry::encloses(cavity, place)) return std::nullopt;
    int found = 0;
    if (order_.shape) found = geometry::region_at(body_, place).value_or(0);
    if (order_.region_of) found = order_.region_of(found);
    for (const Inclusion& one : order_.inclusions)
      if (one.sphere ? (place - one.sphere->centre).norm() < one.sphere->radius
                     : place.z() > one.bottom && place.z() < one.top)
        found = one.region;
    return found;
  }

  // With the middles of the edges of faces on the true boundary.
  [[nodiscard]] Mesh curved(const meshing::PieceMesh& filled) const {
    std::vector<Plane> planes = order_.mirrors;
    planes.insert(planes.end(), levels_.begin(), levels_.end());
    if (order_.base) planes.push_back(*order_.base);
    std::map<std::array<int, 2>, std::vector<int>> of_edge;
    for (std::size_t f = 0; f < filled.faces.size(); ++f)
      for (std::size_t i = 0; i < 3; ++i) {
        const int a = filled.faces[f][i];
        const int b = filled.faces[f][(i + 1) % 3];
        of_edge[{std::min(a, b), std::max(a, b)}].push_back(filled.numbers[f]);
      }
    const std::vector<Vec3>& nodes = filled.mesh.nodes;
    const double rounding = 1e-9 * box_.diagonal();
    return quadratic(filled.mesh, [&](const std::array<int, 2>& edge) -> std::optional<Vec3> {
      const auto found = of_edge.find(edge);
      if (found == of_edge.end()) return std::nullopt;
      const Vec3& a = nodes[as_index(edge[0])];
      const Vec3& b = nodes[as_index(edge[1])];
      std::vector<Plane> on;
      for (const Plane& plane : planes)
        if (std::abs(plane.beyond(a)) < rounding && std::abs(plane.beyond(b)) < rounding)
          on.push_back(plane);
      return placed_onto(
          0.5 * (a + b), [&](const Vec3& point) { return onto(point, found->second); }, on);
    });
  }

  const MeshOrder& order_;
  std::optional<geometry::BoxTree> tree_;
  geometry::Body body_;  // as sampled, without inclusions
  std::vector<geometry::Surface> cavities_;
  geometry::Surface faces_;
  std::vector<int> numbers_;
  std::vector<Plane> levels_;
  geometry::Box box_;
};

// The edges of a mesh's boundary across the border of its base that are too long: a face is held or
// free as a whole, so that the border runs along edges. They are to be a fifth of the held part's
// width, which is twice its area over the border's length: a ball of 60 mm in quadratic cells of 12
// and 6 mm then has the force of the exact one within 0.4 % (4 % too little with faces of 12 mm).
std::set<std::array<int, 2>> long_border(const geometry::TetMesh& mesh, const Plane& base) {
  constexpr double longest = 0.2;
  constexpr double flat = 1e-4;  // of the diagonal, of a flat underside
  const geometry::OuterSurface outer = geometry::outer_surface(mesh);
  const double rounding = flat * geometry::box_of(outer.surface.vertices).diagonal();
  double area = 0.0, border = 0.0;
  std::map<std::array<int, 2>, double> lengths;  // m, of crossing edges, by nodes of the mesh
  for (int t = 0; t < static_cast<int>(outer.surface.triangles.size()); ++t) {
    const auto& triangle = outer.surface.triangles[as_index(t)];
    std::array<Vec3, 3> corner;
    std::array<double, 3> beyond{};
    for (std::size_t i = 0; i < 3; ++i) {
      corner[i] = outer.surface.vertices[as_index(triangle[i])];
      beyond[i] = base.beyond(corner[i]);
      if (std::abs(beyond[i]) < rounding) beyond[i] = 0.0;
    }
    const auto held = std::ranges::count_if(beyond, [](double height) { return height <= 0.0; });
    area += static_cast<double>(held) / 6.0 * geometry::twice_area(outer.surface, t).norm();
    std::vector<Vec3> ends;  // of the border in the triangle
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      if (beyond[i] == 0.0) ends.push_back(corner[i]);
      if (beyond[i] * beyond[j] >= 0.0) continue;
      ends.emplace_back(corner[i] + beyond[i] / (beyond[i] - beyond[j]) * (corner[j] - corner[i]));
      const auto [a, b] =
          std::minmax(outer.nodes[as_index(triangle[i])], outer.nodes[as_index(triangle[j])]);
      lengths[{a, b}] = (corner[j] - corner[i]).norm();
    }
    if (ends.size() == 2) border += (ends[1] - ends[0]).norm();
  }
  std::set<std::array<int, 2>> found;
  for (const auto& [edge, length] : lengths)
    if (length * border > longest * 2.0 * area) found.insert(edge);
  return found;
}

// Halves tetrahedra of a given mesh that are too large.
Mesh refined(const MeshOrder& order) {
  constexpr double longest = 1.8;
  constexpr int most_rounds = 30;
  geometry::TetMesh mesh = *order.mesh;
  std::optional<geometry::CurvedEdges> curved;
  if (order.middles != nullptr) curved.emplace(mesh.nodes, *order.middles);
  meshing::TrueBoundary boundary(mesh, std::nullopt, {}, {});
  const geometry::OuterSurface outer = geometry::outer_surface(mesh);
  const Walls walls(outer.surface, order.base);
  for (int round = 0; round < most_rounds; ++round) {
    std::vector<char> marks(mesh.tetrahedra.size(), 0);
    bool any = false;
    const auto border =
        order.base ? long_border(mesh, *order.base) : std::set<std::array<int, 2>>{};
    for (std::size_t t = 0; t < mesh.tetrahedra.size(); ++t) {
      const auto& corners = mesh.tetrahedra[t];
      Vec3 middle = Vec3::Zero();
      double most = 0.0;
      for (const int node : corners) middle += 0.25 * mesh.nodes[as_index(node)];
      bool on_border = false;
      for (const auto& [i, j] : geometry::corner_edges) {
        const auto [a, b] = std::minmax(corners[as_index(i)], corners[as_index(j)]);
        most = std::max(most, (mesh.nodes[as_index(a)] - mesh.nodes[as_index(b)]).norm());
        on_border = on_border || border.contains({a, b});
      }
      if (!on_border && most <= longest * order.sizes.at(middle, walls.at(middle))) continue;
      marks[t] = 1;
      any = true;
    }
    if (!any) break;
    meshing::Bisection bisection(mesh, [&](const meshing::Bisection::Middle& edge) {
      return curved ? curved->split(edge.a, edge.b) : boundary.place(edge);
    });
    bisection.halve(marks);
    mesh = bisection.mesh();
  }
  if (!curved) return quadratic(mesh);
  return quadratic(mesh, [&](const std::array<int, 2>& edge) -> std::optional<Vec3> {
    return curved->middle(edge[0], edge[1]);
  });
}

}  // namespace

double Sizes::at(const Vec3& place, double wall) const {
  constexpr double calm_walls = 2.5;  // of their thickness
  constexpr double growth_of_walls = 0.1;
  double size = HUGE_VAL;
  double nearest = HUGE_VAL;
  for (const Spot& spot : spots) {
    const double distance = (place - spot.centre).norm();
    nearest = std::min(nearest, distance);
    size = std::min(size, spot.size + growth * std::max(0.0, distance - spot.radius));
  }
  size = std::min(size, largest + growth * std::max(0.0, nearest - calm));
  if (!across) return size;
  const double beyond = std::max(0.0, nearest - calm_walls * wall);
  return std::min(size, std::max(spots.front().size, wall / *across + growth_of_walls * beyond));
}

Mesh mesh_for(const MeshOrder& order) {
  if (order.mesh != nullptr) return refined(order);
  return Mesher(order).made();
}

bool symmetric(const geometry::Surface& surface, const Plane& plane) {
  const geometry::BoxTree tree(surface);
  const double near = 1e-4 * geometry::box_of(surface.vertices).diagonal();
  return std::all_of(surface.vertices.begin(), surface.vertices.end(), [&](Vec3 vertex) {
    vertex[plane.axis] = 2.0 * plane.at - vertex[plane.axis];
    return tree.nearest(vertex).distance_squared < near * near;
  });
}

}  // namespace palpate::solid
