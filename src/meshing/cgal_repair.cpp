// Mends surfaces by CGAL's Polygon Mesh Processing. Its predicates use exact arithmetic by Boost.
#define CGAL_DISABLE_GMP 1
#include "meshing/cgal_repair.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/manifoldness.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/repair_degeneracies.h>
#include <CGAL/Polygon_mesh_processing/repair_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/repair_self_intersections.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/stitch_borders.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

namespace palpate::meshing::cgal_library {
namespace {

using RepairKernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using RepairPoint = RepairKernel::Point_3;
using RepairMesh = CGAL::Surface_mesh<RepairPoint>;
namespace processing = CGAL::Polygon_mesh_processing;

Vec3 place_of(const RepairPoint& point) { return {point.x(), point.y(), point.z()}; }

// Removes connected parts that are open and have less than a thousandth of the area.
int remove_fragments(RepairMesh& mesh) {
  constexpr double least_area = 1e-3;
  const auto parts = mesh.add_property_map<RepairMesh::Face_index, std::size_t>("f:part", 0).first;
  const std::size_t count = processing::connected_components(mesh, parts);
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
Mending::Hole fill(RepairMesh& mesh, RepairMesh::Halfedge_index border) {
  Mending::Hole hole;
  int corners = 0;
  for (const auto half : mesh.halfedges_around_face(border)) {
    const Vec3 from = place_of(mesh.point(mesh.source(half)));
    hole.place += from;
    hole.around += (place_of(mesh.point(mesh.target(half))) - from).norm();
    ++corners;
  }
  hole.place /= corners;
  std::vector<RepairMesh::Face_index> faces;
  std::vector<RepairMesh::Vertex_index> vertices;
  processing::triangulate_and_refine_hole(mesh, border, std::back_inserter(faces),
                                          std::back_inserter(vertices));
  for (const auto face : faces) hole.area += processing::face_area(face, mesh);
  hole.closed = !faces.empty();
  return hole;
}

double crossing_area(const RepairMesh& mesh) {
  std::vector<std::pair<RepairMesh::Face_index, RepairMesh::Face_index>> pairs;
  processing::self_intersections(mesh, std::back_inserter(pairs));
  std::set<RepairMesh::Face_index> faces;
  for (const auto& [one, other] : pairs) faces.insert({one, other});
  double area = 0.0;
  for (const auto face : faces) area += processing::face_area(face, mesh);
  return area;
}

}  // namespace

Mending mended(const geometry::Surface& surface) {
  Mending made;
  std::vector<RepairPoint> points;
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
  RepairMesh mesh;
  processing::polygon_soup_to_polygon_mesh(points, polygons, mesh);
  processing::stitch_borders(mesh);
  processing::remove_degenerate_faces(mesh);
  made.parted += static_cast<int>(processing::duplicate_non_manifold_vertices(mesh));
  made.fragments = remove_fragments(mesh);
  std::vector<RepairMesh::Halfedge_index> borders;
  processing::extract_boundary_cycles(mesh, std::back_inserter(borders));
  for (const auto border : borders) made.holes.push_back(fill(mesh, border));
  made.area = processing::area(mesh);
  made.crossing = crossing_area(mesh);
  if (made.crossing > 0.0)
    processing::experimental::remove_self_intersections(mesh,
                                                        CGAL::parameters::preserve_genus(false));
  if (CGAL::is_closed(mesh)) processing::orient(mesh);
  mesh.collect_garbage();
  for (const auto vertex : mesh.vertices())
    made.surface.vertices.push_back(place_of(mesh.point(vertex)));
  for (const auto face : mesh.faces()) {
    std::array<int, 3> triangle{};
    std::size_t corner = 0;
    for (const auto vertex : mesh.vertices_around_face(mesh.halfedge(face)))
      triangle[corner++] = static_cast<int>(vertex.idx());
    made.surface.triangles.push_back(triangle);
  }
  return made;
}

}  // namespace palpate::meshing::cgal_library
