// Compares displacements piece by piece, at the nearest point of the other surface at rest.
#include "run/displaced_surface.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/box_tree.h"
#include "run/solid_press.h"

namespace palpate::run {
namespace {

constexpr double contact_radii = 4.0;  // from the first touch

// A surface at rest, and what its vertices have moved, m.
struct Displaced {
  geometry::Surface rest;
  std::vector<Vec3> displacement;
};

double difference(const Displaced& found, std::span<const DisplacedPiece> reference) {
  const geometry::BoxTree tree(found.rest);
  double squares = 0.0;
  double area = 0.0;
  double largest = 0.0;
  for (const DisplacedPiece& piece : reference) {
    const geometry::Near near = tree.nearest(piece.place);
    Vec3 displacement = Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i)
      displacement +=
          near.weights[static_cast<Eigen::Index>(i)] *
          found.displacement[as_index(found.rest.triangles[as_index(near.triangle)][i])];
    squares += piece.area * (displacement - piece.displacement).squaredNorm();
    area += piece.area;
    largest = std::max(largest, piece.displacement.norm());
  }
  return std::sqrt(squares / area) / largest;
}

using Faces = solid::FingerPress::OuterSurface;

// Every face of the solid as four triangles.
Displaced displaced(const Faces& faces) {
  Displaced found;
  for (std::size_t f = 0; f < faces.faces.size(); ++f) {
    const std::size_t first = found.rest.vertices.size();
    for (std::size_t i = 0; i < 6; ++i) {
      found.displacement.push_back(faces.displacements[f][i]);
      found.rest.vertices.push_back(faces.faces[f][i] - faces.displacements[f][i]);
    }
    for (const auto& part : solid::face_parts) {
      auto& triangle = found.rest.triangles.emplace_back();
      for (std::size_t i = 0; i < 3; ++i) triangle[i] = static_cast<int>(first + part[i]);
    }
  }
  return found;
}

// One piece per face, at its middle.
std::vector<DisplacedPiece> pieces(const Faces& faces, const Vec3& touched, double reach) {
  const std::array<double, 6> values = solid::face_values({1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0});
  std::vector<DisplacedPiece> found;
  for (std::size_t f = 0; f < faces.faces.size(); ++f) {
    DisplacedPiece piece;
    std::array<Vec3, 6> rest;
    for (std::size_t i = 0; i < 6; ++i) {
      rest[i] = faces.faces[f][i] - faces.displacements[f][i];
      piece.place += values[i] * rest[i];
      piece.displacement += values[i] * faces.displacements[f][i];
    }
    piece.area = 0.5 * (rest[1] - rest[0]).cross(rest[2] - rest[0]).norm();
    if ((piece.place - touched).norm() <= reach) found.push_back(piece);
  }
  return found;
}

}  // namespace

SurfaceReference displaced_by_solid(const scene::Scene& scene) {
  SurfaceReference reference;
  SolidPress press(scene);
  mechanics::Touch touch;
  touch.travel = scene::deepest_travel(scene.scenario, scene.finger.whole);
  if (press.find({Vec3::Zero(), Vec3::Zero()}, touch) || touch.contacts.empty()) return reference;
  const double reach = contact_radii * touch.contacts[0].patch.a;
  const auto surface = [&](std::size_t mesh) { return press.surface(mesh, touch); };
  reference.pieces = pieces(surface(press.meshes() - 1), scene.solid->touched, reach);
  if (!reference.pieces.empty())
    reference.error = difference(displaced(surface(0)), reference.pieces);
  return reference;
}

std::optional<double> surface_error(const record::CaseRecord& record,
                                    std::span<const DisplacedPiece> reference) {
  if (record.outcome != record::Outcome::completed || reference.empty()) return std::nullopt;
  const auto deepest = std::ranges::max_element(record.contact, {}, &record::ContactRow::travel);
  if (deepest == record.contact.end() || deepest->slide != 0.0) return std::nullopt;
  const auto frame = std::ranges::find(record.frames, deepest->step, &record::TissueFrame::step);
  if (frame == record.frames.end()) return std::nullopt;
  Displaced found;
  geometry::OuterSurface outer = geometry::outer_surface(record.mesh);
  for (const int node : outer.nodes)
    found.displacement.push_back(frame->displacement[as_index(node)]);
  found.rest = std::move(outer.surface);
  return difference(found, reference);
}

}  // namespace palpate::run
