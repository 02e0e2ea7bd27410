// Rigid spheres that press on the outer faces of a solid.
#pragma once

#include <Eigen/SparseCore>
#include <optional>
#include <span>
#include <vector>

#include "solid/elements.h"

namespace palpate::solid {

// A rigid sphere, or the inside of one, which a convex body meets as the hollow of a cup.
struct Ball {
  Vec3 centre = Vec3::Zero();  // m
  double radius = 0.0;         // m
  bool hollow = false;
};

// What one ball meets.
struct Met {
  Vec3 force = Vec3::Zero();  // N, on the body
  double work = 0.0;          // N m, sum of the forces at the points times their overlap
  double area = 0.0;          // m^2, undeformed, of the points in contact
  double peak = 0.0;          // Pa, largest pressure at a point, on undeformed area
};

// A penalty pushes every integration point of a face (seven, exact to degree five) out of a ball,
// along the normal of the ball at the displaced point: pressure = stiffness * overlap.
//                                                                    docs/theory.md [penalty]
class Contact {
 public:
  // `faces` are those that may be met, `stiffness` (Pa/m) is the penalty. `elements` must outlive
  // this.
  Contact(const Elements& elements, std::span<const OuterFace> faces, double stiffness);

  // Adds the gradient and the second derivative of the penalty's energy at `displacement` (m).
  // `steepest` (Pa) bounds the pressures in the part of the second derivative that can be negative.
  void add(const Vector& displacement, std::span<const Ball> balls, double steepest, Vector& force,
           Eigen::SparseMatrix<double>& stiffness, std::vector<Met>& met) const;

  // J, whose gradient add() adds.
  [[nodiscard]] double energy(const Vector& displacement, std::span<const Ball> balls) const;

 private:
  static constexpr std::size_t face_points = 7;
  struct Own {
    Face nodes{};
    Vec3 middle = Vec3::Zero();               // m
    double reach = 0.0;                       // m, of its corners from the middle
    std::array<Vec3, face_points> places{};   // m
    std::array<double, face_points> areas{};  // m^2
    std::array<int, 171> entries{};           // lower triangle by rows, -1 where held
  };
  struct Overlap {
    double depth = 0.0;  // m, above 0
    Vec3 normal;         // on the body, unit
    double bend = 0.0;   // 1/m, of the ball towards the body, negative for a hollow one
  };
  [[nodiscard]] static std::optional<Overlap> overlap(const Vec3& place, const Ball& ball);
  // Calls visit(face, point, place, ball, overlap) for every overlap.
  template <class Visit>
  void for_each(const Vector& displacement, std::span<const Ball> balls, const Visit& visit) const;

  std::vector<Own> faces_;
  double stiffness_ = 0.0;
};

}  // namespace palpate::solid
