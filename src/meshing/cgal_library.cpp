// The only file that includes CGAL. Its predicates use exact arithmetic by Boost where needed, so
// that nothing has to be linked.
#define CGAL_DISABLE_GMP 1
#include "meshing/cgal_library.h"
#include "meshing/cgal_repair.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/detect_features.h>
#include <CGAL/Polygon_mesh_processing/manifoldness.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/remesh.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/LindstromTurk_placement.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <utility>

namespace palpate::meshing::cgal_library {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Mesh = CGAL::Surface_mesh<Point>;
namespace simplification = CGAL::Surface_mesh_simplification;

Mesh filled(const geometry::Surface& surface) {
  Mesh mesh;
  for (const Vec3& vertex : surface.vertices)
    mesh.add_vertex(Point(vertex.x(), vertex.y(), vertex.z()));
  for (const auto& [a, b, c] : surface.triangles)
    mesh.add_face(Mesh::Vertex_index(static_cast<Mesh::size_type>(a)),
                  Mesh::Vertex_index(static_cast<Mesh::size_type>(b)),
                  Mesh::Vertex_index(static_cast<Mesh::size_type>(c)));
  return mesh;
}

geometry::Surface taken(Mesh& mesh) {
  mesh.collect_garbage();  // numbers vertices and faces without gaps
  geometry::Surface surface;
  for (const Mesh::Vertex_index vertex : mesh.vertices()) {
    const Point& point = mesh.point(vertex);
    surface.vertices.emplace_back(point.x(), point.y(), point.z());
  }
  for (const Mesh::Face_index face : mesh.faces()) {
    std::array<int, 3> triangle{};
    std::size_t corner = 0;
    for (const Mesh::Vertex_index vertex : mesh.vertices_around_face(mesh.halfedge(face)))
      triangle[corner++] = static_cast<int>(vertex.idx());
    surface.triangles.push_back(triangle);
  }
  return surface;
}

using Corners = std::array<Point, 3>;

Kernel::Vector_3 twice_area(const Corners& p) {
  return CGAL::cross_product(p[1] - p[0], p[2] - p[0]);
}

// 4 sqrt(3) area / (sum of the squared edges): 1 for equal sides, 0 for a needle.
double roundness(const Corners& p) {
  const double squares = (p[1] - p[0]).squared_length() + (p[2] - p[1]).squared_length() +
                         (p[0] - p[2]).squared_length();
  return 2.0 * std::sqrt(3.0 * twice_area(p).squared_length()) / squares;
}

// Leaves out collapses that spoil triangles. Triangles that are worse already may stay as they are.
struct Shapes {
  static constexpr double least_roundness = 0.4;  // that of a right-angled triangle of 1 : 4
  static constexpr double least_cosine = 0.5;     // of the angle by which a triangle turns

  template <class Profile>
  boost::optional<Point> operator()(const Profile& profile,
                                    const boost::optional<Point>& place) const {
    if (!place) return place;
    double before = least_roundness;
    double after = 1.0;
    for (const auto& triangle : profile.triangles()) {
      const std::array vertices{triangle.v0, triangle.v1, triangle.v2};
      Corners old;
      Corners moved;
      int merged = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        old[i] = moved[i] = get(profile.vertex_point_map(), vertices[i]);
        if (vertices[i] != profile.v0() && vertices[i] != profile.v1()) continue;
        moved[i] = *place;
        ++merged;
      }
      before = std::min(before, roundness(old));
      if (merged == 2) continue;  // vanishes with the edge
      const Kernel::Vector_3 was = twice_area(old);
      const Kernel::Vector_3 is = twice_area(moved);
      if (!(was * is > least_cosine * std::sqrt(was.squared_length() * is.squared_length())))
        return boost::none;
      after = std::min(after, roundness(moved));
    }
    return after < before ? boost::none : place;
  }
};

// The squared length (m2) that an edge would have at the largest spacing, if lengths are in the
// proportion of the shorter spacing at its ends.
struct LengthForSpacing {
  std::span<const double> spacing;  // m, of each vertex
  double largest;                   // m

  template <class Profile>
  boost::optional<double> operator()(const Profile& profile, const boost::optional<Point>&) const {
    const double least = std::min(spacing[profile.v0().idx()], spacing[profile.v1().idx()]);
    const double share = least / largest;
    return CGAL::squared_distance(profile.p0(), profile.p1()) / (share * share);
  }
};

// CGAL asks for the place of an edge whenever it asks for its cost, which does not depend on it,
// and again when the edge is collapsed: only then it is computed.
struct PlaceWhenCollapsed {
  bool* selected;

  boost::optional<Point> operator()(
      const CGAL::Surface_mesh_simplification::Edge_profile<Mesh>& profile) const {
    if (!std::exchange(*selected, false)) return profile.p0();
    return simplification::LindstromTurk_placement<Mesh>()(profile);
  }
};

}  // namespace

std::vector<std::array<int, 2>> self_intersections(const geometry::Surface& surface) {
  using Face = Mesh::Face_index;
  const Mesh mesh = filled(surface);
  std::vector<std::pair<Face, Face>> pairs;  // in a random order
  CGAL::Polygon_mesh_processing::self_intersections(mesh, std::back_inserter(pairs));
  std::vector<std::array<int, 2>> sorted;
  for (const auto& [f, g] : pairs)
    sorted.push_back({static_cast<int>(std::min(f, g)), static_cast<int>(std::max(f, g))});
  std::ranges::sort(sorted);
  return sorted;
}

std::optional<std::vector<std::array<int, 3>>> triangulated(
    std::span<const Eigen::Vector2d> points, std::span<const std::array<int, 2>> segments) {
  using Vertices = CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>;
  using Faces = CGAL::Constrained_triangulation_face_base_2<
      Kernel, CGAL::Triangulation_face_base_with_info_2<bool, Kernel>>;
  using Triangulation = CGAL::Constrained_Delaunay_triangulation_2<
      Kernel, CGAL::Triangulation_data_structure_2<Vertices, Faces>,
      CGAL::No_constraint_intersection_requiring_constructions_tag>;
  Triangulation plane;
  std::vector<Triangulation::Vertex_handle> vertices;
  for (std::size_t i = 0; i < points.size(); ++i) {
    vertices.push_back(plane.insert({points[i].x(), points[i].y()}));
    vertices.back()->info() = static_cast<int>(i);
  }
  try {
    for (const auto& [a, b] : segments) {
      const auto from = vertices[as_index(a)];
      const auto to = vertices[as_index(b)];
      if (from == to) return std::nullopt;  // points at one place are one vertex
      plane.insert_constraint(from, to);
    }
  } catch (const Triangulation::Intersection_of_constraints_exception&) {
    return std::nullopt;
  }
  // What is reached from far away without crossing a segment is outside.
  for (const auto face : plane.all_face_handles()) face->info() = false;
  std::vector<Triangulation::Face_handle> waiting{plane.infinite_face()};
  while (!waiting.empty()) {
    const Triangulation::Face_handle face = waiting.back();
    waiting.pop_back();
    if (face->info()) continue;
    face->info() = true;
    for (int side = 0; side < 3; ++side)
      if (!face->is_constrained(side)) waiting.push_back(face->neighbor(side));
  }
  std::vector<std::array<int, 3>> triangles;
  for (const auto face : plane.finite_face_handles())
    if (!face->info())
      triangles.push_back(
          {face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
  return triangles;
}

geometry::Surface collapsed(const geometry::Surface& surface, std::span<const double> spacing) {
  Mesh mesh = filled(surface);
  // With no edge below 0.7 of it, the mean edge is about the spacing: measured on ellipsoids.
  const double largest = *std::ranges::max_element(spacing);
  const double least_square = (0.7 * largest) * (0.7 * largest);
  bool selected = false;
  simplification::edge_collapse(
      mesh,
      [&](double square, const auto&, auto, auto) {
        selected = true;
        return square > least_square;
      },
      CGAL::parameters::get_cost(LengthForSpacing{spacing, largest})
          .get_placement(PlaceWhenCollapsed{&selected})
          .filter(Shapes()));
  return taken(mesh);
}

geometry::Surface even(const geometry::Surface& surface, double spacing, double crease_degrees) {
  constexpr unsigned rounds = 3;
  Mesh mesh = filled(surface);
  const auto creases = mesh.add_property_map<Mesh::Edge_index, bool>("e:crease", false).first;
  CGAL::Polygon_mesh_processing::detect_sharp_edges(mesh, crease_degrees, creases);
  CGAL::Polygon_mesh_processing::isotropic_remeshing(mesh.faces(), spacing, mesh,
                                                     CGAL::parameters::number_of_iterations(rounds)
                                                         .edge_is_constrained_map(creases)
                                                         .protect_constraints(false));
  return taken(mesh);
}

namespace {

namespace processing = CGAL::Polygon_mesh_processing;

Vec3 place_of(const Point& point) { return {point.x(), point.y(), point.z()}; }

using Parts = Mesh::Property_map<Mesh::Face_index, std::size_t>;

// The connected part of each face, and the number of parts.
std::pair<Parts, std::size_t> numbered_parts(Mesh& mesh) {
  const Parts parts = mesh.add_property_map<Mesh::Face_index, std::size_t>("f:part", 0).first;
  return {parts, processing::connected_components(mesh, parts)};
}

// Removes connected parts that are open and have less than a thousandth of the area.
int remove_fragments(Mesh& mesh) {
  constexpr double least_area = 1e-3;
  const auto [parts, count] = numbered_parts(mesh);
  std::vector<double> areas(count, 0.0);
  std::vector<char> open(count, 0);
  double total = 0.0;
  for (const auto face : mesh.faces()) {
    const double area = processing::face_area(face, mesh);
    areas[parts[face]] += area;
    total += area;
    for (const auto half : mesh.halfedges_around_face(mesh.halfedge(face)))
      if (mesh.is_border(mesh.opposite(half))) open[parts[face]] = 1;
  }
  std::vector<std::size_t> dropped;
  for (std::size_t part = 0; part < count; ++part)
    if (open[part] != 0 && areas[part] < least_area * total) dropped.push_back(part);
  processing::remove_connected_components(mesh, dropped, parts);
  return static_cast<int>(dropped.size());
}

// Fills a hole and returns where it was, its circumference and the area of its triangles.
Mending::Hole fill(Mesh& mesh, Mesh::Halfedge_index border) {
  Mending::Hole hole;
  int corners = 0;
  for (const auto half : mesh.halfedges_around_face(border)) {
    const Vec3 from = place_of(mesh.point(mesh.source(half)));
    hole.place += from;
    hole.around += (place_of(mesh.point(mesh.target(half))) - from).norm();
    ++corners;
  }
  hole.place /= corners;
  std::vector<Mesh::Face_index> faces;
  std::vector<Mesh::Vertex_index> vertices;
  processing::triangulate_and_refine_hole(mesh, border, std::back_inserter(faces),
                                          std::back_inserter(vertices));
  for (const auto face : faces) hole.area += processing::face_area(face, mesh);
  hole.closed = !faces.empty();
  return hole;
}

enum class Cut { any, own_part };

// Faces that cut others, or others of the same part.
std::set<Mesh::Face_index> crossing(Mesh& mesh, Cut cut) {
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
  processing::self_intersections(mesh, std::back_inserter(pairs));
  const Parts parts = numbered_parts(mesh).first;
  std::set<Mesh::Face_index> faces;
  for (const auto& [one, other] : pairs)
    if (cut == Cut::any || parts[one] == parts[other]) faces.insert({one, other});
  return faces;
}

// Replaces triangles that cross, with more and more of their neighbours, by those of filled holes.
void replace_crossing(Mesh& mesh, Cut cut) {
  constexpr int most_rounds = 7;
  for (int round = 0; round < most_rounds; ++round) {
    std::set<Mesh::Face_index> faces = crossing(mesh, cut);
    if (faces.empty()) return;
    for (int ring = 0; ring < round; ++ring) {
      const std::set<Mesh::Face_index> inner = faces;
      for (const auto face : inner)
        for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(face)))
          for (const auto beside : mesh.faces_around_target(mesh.halfedge(vertex)))
            if (beside != Mesh::null_face()) faces.insert(beside);
    }
    for (const auto face : faces) CGAL::Euler::remove_face(mesh.halfedge(face), mesh);
    processing::duplicate_non_manifold_vertices(mesh);
    std::vector<Mesh::Halfedge_index> borders;
    processing::extract_boundary_cycles(mesh, std::back_inserter(borders));
    for (const auto border : borders) fill(mesh, border);
  }
}

}  // namespace

Mending mended(const geometry::Surface& surface) {
  Mending made;
  std::vector<Point> points;
  std::vector<std::vector<std::size_t>> polygons;
  for (const Vec3& vertex : surface.vertices)
    points.emplace_back(vertex.x(), vertex.y(), vertex.z());
  for (const auto& [a, b, c] : surface.triangles)
    polygons.push_back({as_index(a), as_index(b), as_index(c)});
  processing::repair_polygon_soup(points, polygons);
  made.doubled = static_cast<int>(surface.triangles.size()) - static_cast<int>(polygons.size());
  const std::size_t before = points.size();
  processing::orient_polygon_soup(points, polygons);
  made.parted = static_cast<int>(points.size()) - static_cast<int>(before);
  Mesh mesh;
  processing::polygon_soup_to_polygon_mesh(points, polygons, mesh);
  processing::stitch_borders(mesh);
  processing::remove_degenerate_faces(mesh);
  made.parted += static_cast<int>(processing::duplicate_non_manifold_vertices(mesh));
  made.fragments = remove_fragments(mesh);
  std::vector<Mesh::Halfedge_index> borders;
  processing::extract_boundary_cycles(mesh, std::back_inserter(borders));
  for (const auto border : borders) made.holes.push_back(fill(mesh, border));
  made.area = processing::area(mesh);
  // Of parts that cut each other one is chosen.
  for (const auto face : crossing(mesh, Cut::own_part))
    made.crossing += processing::face_area(face, mesh);
  replace_crossing(mesh, Cut::own_part);
  if (CGAL::is_closed(mesh)) processing::orient(mesh);
  made.surface = taken(mesh);
  return made;
}

geometry::Surface uncrossed(const geometry::Surface& surface) {
  Mesh mesh = filled(surface);
  replace_crossing(mesh, Cut::any);
  return taken(mesh);
}

}  // namespace palpate::meshing::cgal_library
