// The half-space's tractions on the faces of a body, as loads of its mesh; for energy_coupling.cpp.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mechanics/energy_coupling.h"
#include "tissue/coupled.h"

namespace palpate::mechanics {

// Under the patch itself nothing is left over, because the finger's pressure acts there.
inline constexpr double under_finger = 1.05;
// Cosine between a facet and the plane of the contact: the curvature is followed on flatter ones.
inline constexpr double steepest = 0.3;

// Quadrature of the half-space's tractions over the faces, for one patch.
class EnergyCoupling::Loads {
 public:
  Loads(const geometry::TetMesh& mesh, const geometry::SmoothSurface& skin,
        const contact::Patch& patch, const Tissue& tissue, int finer, const Vec3& along)
      : mesh_(&mesh),
        skin_(&skin),
        patch_(&patch),
        axes_(axes_of(patch)),
        field_(patch.a, patch.b, {tissue.shear_modulus, tissue.elastic.poisson_ratio}, finer,
               axes_.transpose() * along),
        finer_(finer),
        presses_(along.dot(patch.normal) < -0.5),
        elastic_(tissue.elastic) {
    nodal = integrate::Vector::Zero(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
    curved = nodal;
  }

  [[nodiscard]] Vec3 displacement(int node) const {
    return axes_ * field_.displacement(local(mesh_->nodes[as_index(node)]));
  }

  void add(const Face& face, const integrate::Vector& interpolated) {
    std::array<Vec3, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = local(mesh_->nodes[as_index(face.nodes[k])]);
    normal_ = axes_.transpose() * face.normal;
    // The plane of the contact is free of stress outside the patch.
    const double flat = 1e-9 * (corners[1] - corners[0]).norm();
    if (!face.interface && std::all_of(corners.begin(), corners.end(), [&](const Vec3& corner) {
          return std::abs(corner.z()) <= flat;
        }))
      return;
    divide(face, corners, {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()}, 0, interpolated);
  }

  integrate::Vector nodal;   // N/N, g
  integrate::Vector curved;  // N/N, of a curved skin under the patch
  double known = 0.0;        // m/N, c

 private:
  [[nodiscard]] static Eigen::Matrix3d axes_of(const contact::Patch& patch) {
    Eigen::Matrix3d axes;
    axes << patch.axis, patch.normal.cross(patch.axis), patch.normal;
    return axes;
  }
  [[nodiscard]] Vec3 local(const Vec3& point) const {
    return axes_.transpose() * (point - patch_->position);
  }

  // Divides a triangle until it is small against its distance from the patch.
  void divide(const Face& face, const std::array<Vec3, 3>& corners,
              const std::array<Vec3, 3>& weights, int depth,
              const integrate::Vector& interpolated) {
    constexpr int deepest = 8;
    constexpr double nearest = 0.25;  // of the patch's radius
    double edge = 0.0;
    for (std::size_t k = 0; k < 3; ++k)
      edge = std::max(edge, (corners[(k + 1) % 3] - corners[k]).norm());
    const double distance = ((corners[0] + corners[1] + corners[2]) / 3.0).norm();
    const double size = std::max(0.6 * distance, nearest * patch_->radius());
    if (finer_ * edge <= size || depth == deepest)
      return integrate(face, corners, weights, interpolated);
    const std::array<Vec3, 3> middle{0.5 * (corners[1] + corners[2]),
                                     0.5 * (corners[2] + corners[0]),
                                     0.5 * (corners[0] + corners[1])};
    const std::array<Vec3, 3> share{0.5 * (weights[1] + weights[2]),
                                    0.5 * (weights[2] + weights[0]),
                                    0.5 * (weights[0] + weights[1])};
    for (std::size_t k = 0; k < 3; ++k)
      divide(face, {corners[k], middle[(k + 2) % 3], middle[(k + 1) % 3]},
             {weights[k], share[(k + 2) % 3], share[(k + 1) % 3]}, depth + 1, interpolated);
    divide(face, middle, share, depth + 1, interpolated);
  }

  void integrate(const Face& face, const std::array<Vec3, 3>& corners,
                 const std::array<Vec3, 3>& weights, const integrate::Vector& interpolated) {
    const double area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
    for (std::size_t q = 0; q < 3; ++q) {  // degree 2
      Vec3 point = Vec3::Zero();
      Vec3 shares = Vec3::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        const double weight = k == q ? 2.0 / 3.0 : 1.0 / 6.0;
        point += weight * corners[k];
        shares += weight * weights[k];
      }
      Vec3 normal = normal_;
      if (face.triangle >= 0) {
        // The contact lies on the smooth surface, from which a coarse facet is far away.
        geometry::SurfacePoint at{.triangle = face.triangle, .weights = Vec3::Zero()};
        for (std::size_t k = 0; k < 3; ++k)
          at.weights[face.corners[k]] = shares[static_cast<Eigen::Index>(k)];
        point = local(skin_->position(at));
        normal = axes_.transpose() * skin_->normal(at);
      }
      if (!face.interface && normal.z() > 0.0 && std::abs(point.z()) < patch_->a) {
        const double x = point.x() / patch_->a;
        const double y = point.y() / patch_->b;
        const double from_centre = std::hypot(x, y);
        if (from_centre < 1.0 && presses_ && std::min(normal.z(), normal_.z()) > steepest)
          press_curved(face, corners, weights, shares, point, normal, from_centre, area / 3.0);
        if (from_centre < under_finger) continue;
      }
      const contact::FieldValue value = field_.at(point);
      const Vec3 traction = area / 3.0 * (axes_ * (value.stress * normal));
      Vec3 moved = axes_ * value.displacement;
      if (face.interface) {
        moved.setZero();
        for (std::size_t k = 0; k < 3; ++k)
          moved +=
              shares[static_cast<Eigen::Index>(k)] * interpolated.segment<3>(3 * face.nodes[k]);
      }
      for (int axis = 0; axis < 3; ++axis) {
        const double work = traction[axis] * moved[axis];
        if (face.held[as_index(axis)] && !face.interface) {
          known += work;
          continue;
        }
        known -= work;
        for (std::size_t k = 0; k < 3; ++k)
          nodal[3 * face.nodes[k] + axis] -= shares[static_cast<Eigen::Index>(k)] * traction[axis];
      }
    }
  }

  // What a skin that is curved under the patch changes to the first order in its height z above the
  // plane: beyond the half-space's stress it carries stress grad z - z grad p in the plane. The
  // work of the second term on a shape function N is p (z grad N + N grad z), integrated by parts.
  // `r` is the distance from the centre, 0 to 1; an ellipse counts as a circle of its area.
  //                                 docs/theory.md (12a); K. L. Johnson 1985, eq. (3.41)-(3.43)
  void press_curved(const Face& face, const std::array<Vec3, 3>& corners,
                    const std::array<Vec3, 3>& weights, const Vec3& shares, const Vec3& point,
                    const Vec3& normal, double r, double area) {
    using Eigen::Vector2d;
    const Vector2d slope = -normal.head<2>() / normal.z();
    const double seen = area * normal.z();  // from above
    const double root = std::sqrt(1.0 - r * r);
    const double middle = 1.5 / (std::numbers::pi * patch_->a * patch_->b);  // Pa/N
    const double p = middle * root;
    const double spread = r < 1e-6 ? 1.5 : (1.0 - root * root * root) / (r * r);
    const double nu = elastic_.poisson_ratio;
    const double sideways = (1.0 - 2.0 * nu) / 3.0 * middle * spread;
    const Vector2d outward = point.head<2>().stableNormalized();
    const Vector2d around(-outward.y(), outward.x());
    const Vector2d pull = p * slope + (sideways - p) * outward.dot(slope) * outward -
                          (sideways + 2.0 * nu * p) * around.dot(slope) * around;
    const double moved =  // inwards
        0.5 * sideways / tissue::shear_modulus(elastic_) * patch_->radius() * r;
    known -= seen * moved * outward.dot(pull);
    Eigen::Matrix2d edges;
    edges << (corners[1] - corners[0]).head<2>(), (corners[2] - corners[0]).head<2>();
    const Eigen::Matrix2d inverse = edges.transpose().inverse();
    for (Eigen::Index k = 0; k < 3; ++k) {
      const Vector2d gradient =
          inverse * Vector2d(weights[1][k] - weights[0][k], weights[2][k] - weights[0][k]);
      const Vector2d load = seen * (p * point.z() * gradient + shares[k] * pull);
      const Vec3 force = axes_.leftCols<2>() * load;
      for (int axis = 0; axis < 3; ++axis)
        if (!face.held[as_index(axis)]) curved[3 * face.nodes[as_index(k)] + axis] += force[axis];
    }
  }

  const geometry::TetMesh* mesh_;
  const geometry::SmoothSurface* skin_;
  const contact::Patch* patch_;
  Eigen::Matrix3d axes_;  // columns: the patch's axes
  contact::PatchField field_;
  int finer_;
  bool presses_;
  tissue::Isotropic elastic_;
  Vec3 normal_ = Vec3::Zero();
};

}  // namespace palpate::mechanics
