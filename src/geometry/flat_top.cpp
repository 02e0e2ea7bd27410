// Point location by a uniform grid of bins over the face.
#include "geometry/flat_top.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "base/text.h"

namespace palpate::geometry {
namespace {

// A weight this far below 0 still counts as on the edge: far above rounding, far below sight.
constexpr double edge_reach = 1e-10;

const Vec3& position(const TetMesh& mesh, int node) {
  return mesh.nodes[static_cast<std::size_t>(node)];
}

}  // namespace

FlatTop::FlatTop(const TetMesh& mesh, double z) {
  collect(mesh, z);
  if (triangles_.empty())
    throw MeshError("the mesh has no flat face at height " + rounded_text(z) +
                    " m; check the height and the direction of z");
  sort_into_bins(mesh);
}

void FlatTop::collect(const TetMesh& mesh, double z) {
  const double tolerance = 1e-9 * diagonal(mesh);
  for (const auto& triangle : boundary_faces(mesh)) {
    const bool in_plane = std::all_of(triangle.begin(), triangle.end(), [&](int node) {
      return std::abs(position(mesh, node).z() - z) <= tolerance;
    });
    if (!in_plane) continue;
    const Vec3& a = position(mesh, triangle[0]);
    const Vec3 ab = position(mesh, triangle[1]) - a;
    const Vec3 ac = position(mesh, triangle[2]) - a;
    const double twice_area = ab.x() * ac.y() - ab.y() * ac.x();
    if (twice_area <= 0.0) continue;  // the underside of a body that hangs from this plane
    shapes_.push_back({a.x(), a.y(), ac.y() / twice_area, -ac.x() / twice_area,
                       -ab.y() / twice_area, ab.x() / twice_area});
    triangles_.push_back(triangle);
    area_ += twice_area / 2.0;
    nodes_.insert(nodes_.end(), triangle.begin(), triangle.end());
  }
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
}

void FlatTop::sort_into_bins(const TetMesh& mesh) {
  const double infinity = std::numeric_limits<double>::infinity();
  double low_x = infinity, low_y = infinity, high_x = -infinity, high_y = -infinity;
  for (const int node : nodes_) {
    const Vec3& p = position(mesh, node);
    low_x = std::min(low_x, p.x());
    low_y = std::min(low_y, p.y());
    high_x = std::max(high_x, p.x());
    high_y = std::max(high_y, p.y());
  }
  // Grown so that a point that edge_reach lets in lies inside the box and inside its triangles'
  // bins.
  const double margin = 1e-9 * std::max(high_x - low_x, high_y - low_y);
  bins_ = {low_x - margin, low_y - margin, high_x + margin, high_y + margin};
  const double width = bins_.high_x - bins_.low_x;
  const double height = bins_.high_y - bins_.low_y;
  // About one bin a triangle; at most as many across as triangles, for long and thin faces.
  const auto count = static_cast<double>(triangles_.size());
  bins_.side = std::max(std::sqrt(width * height / count), std::max(width, height) / count);
  bins_.columns = static_cast<int>(width / bins_.side) + 1;
  bins_.rows = static_cast<int>(height / bins_.side) + 1;

  std::vector<std::vector<int>> lists(static_cast<std::size_t>(bins_.columns) *
                                      static_cast<std::size_t>(bins_.rows));
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto [i, j, k] = triangles_[t];
    const Vec3& a = position(mesh, i);
    const Vec3& b = position(mesh, j);
    const Vec3& c = position(mesh, k);
    const int right = bins_.column(std::max({a.x(), b.x(), c.x()}) + margin);
    const int back = bins_.row(std::max({a.y(), b.y(), c.y()}) + margin);
    for (int row = bins_.row(std::min({a.y(), b.y(), c.y()}) - margin); row <= back; ++row)
      for (int column = bins_.column(std::min({a.x(), b.x(), c.x()}) - margin); column <= right;
           ++column)
        lists[static_cast<std::size_t>(row * bins_.columns + column)].push_back(
            static_cast<int>(t));
  }
  bin_starts_.assign(1, 0);
  for (const auto& list : lists) {
    bin_triangles_.insert(bin_triangles_.end(), list.begin(), list.end());
    bin_starts_.push_back(static_cast<int>(bin_triangles_.size()));
  }
}

int FlatTop::Bins::column(double x) const {
  return std::clamp(static_cast<int>((x - low_x) / side), 0, columns - 1);
}

int FlatTop::Bins::row(double y) const {
  return std::clamp(static_cast<int>((y - low_y) / side), 0, rows - 1);
}

std::optional<FacePoint> FlatTop::locate(double x, double y) const {
  // Written so that a point that is not a number is outside.
  const bool inside_box =
      x >= bins_.low_x && x <= bins_.high_x && y >= bins_.low_y && y <= bins_.high_y;
  if (!inside_box) return std::nullopt;
  const auto bin = static_cast<std::size_t>(bins_.row(y) * bins_.columns + bins_.column(x));
  for (int i = bin_starts_[bin]; i < bin_starts_[bin + 1]; ++i) {
    const auto t = static_cast<std::size_t>(bin_triangles_[static_cast<std::size_t>(i)]);
    const Shape& shape = shapes_[t];
    const double dx = x - shape.ax;
    const double dy = y - shape.ay;
    const double b = shape.bx * dx + shape.by * dy;
    const double c = shape.cx * dx + shape.cy * dy;
    const double a = 1.0 - b - c;
    if (a < -edge_reach || b < -edge_reach || c < -edge_reach) continue;
    const std::array<double, 3> weights{std::max(a, 0.0), std::max(b, 0.0), std::max(c, 0.0)};
    const double sum = weights[0] + weights[1] + weights[2];  // above 1 beyond an edge
    return FacePoint{triangles_[t], {weights[0] / sum, weights[1] / sum, weights[2] / sum}};
  }
  return std::nullopt;
}

double FlatTop::mean_spacing() const {
  const double mean_area = area_ / static_cast<double>(triangles_.size());
  return std::sqrt(4.0 * mean_area / std::sqrt(3.0));
}

}  // namespace palpate::geometry
