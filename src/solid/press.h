// A solid under rigid indenters, in equilibrium.
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "base/cholesky.h"
#include "base/symmetric_solver.h"
#include "solid/elements.h"

namespace palpate::solid {

// A rigid surface around its pole, the lower side of a finger: the quadric
// 2 z = c_1 x^2 + c_2 y^2 + (c_1 + c_2) / 2 z^2 up to where it is upright, half a sphere where both
// curvatures are equal.
struct Indenter {
  Vec3 pole = Vec3::Zero();           // m
  std::array<double, 2> curvature{};  // 1/m along x and y, above 0 if it bulges down
  // Of the body in the approach of two elastic bodies: the body meets a surface between the
  // indenter and its own undeformed one, at this share of the way. 1 where the indenter is rigid.
  double share = 1.0;

  [[nodiscard]] static Indenter sphere(const Vec3& centre, double radius, double share = 1.0) {
    return {centre - radius * Vec3::UnitZ(), {1.0 / radius, 1.0 / radius}, share};
  }

  // A place near the surface.
  struct Meeting {
    double depth = 0.0;  // m, inside the indenter: of a sphere exactly, else to first order
    Vec3 normal;         // of the surface, on the body, unit
  };
  // Nothing beyond where the surface is upright.
  [[nodiscard]] std::optional<Meeting> at(const Vec3& place) const;
  // m, from a place up to the surface, negative inside; nothing beyond it.
  [[nodiscard]] std::optional<double> gap(const Vec3& place) const;
  // Whether a place within `reach` (m) of `place` may be inside.
  [[nodiscard]] bool near(const Vec3& place, double reach) const;
};

// What one indenter meets.
struct Met {
  Vec3 force = Vec3::Zero();  // N, on the body
  double work = 0.0;          // N m, sum of the forces at the points times their overlap
  double area = 0.0;          // m^2, undeformed, of the points in contact
  double moment = 0.0;        // N m^2, sum of the forces times their squared distance from the pole
};

// A penalty pushes every integration point of a face (seven, exact to degree five) out of an
// indenter, along its normal at the displaced point: pressure = stiffness * overlap. Of an indenter
// with a share s, overlap = s depth + (1 - s) n . u, with the normal n of the undeformed face.
//                                                                        docs/theory.md [penalty]
class Contact {
 public:
  // `faces` are those that may be met, `stiffness` (Pa/m) is the penalty. `elements` must outlive
  // this.
  Contact(const Elements& elements, std::span<const OuterFace> faces, double stiffness);

  // Adds the gradient of the penalty's energy at `displacement` (m), and Gauss and Newton's part of
  // its second derivative. The rest, the pressure times the curvature of the indenter, is negative:
  // far from equilibrium the stiffness would not be positive definite, and near it Newton's steps
  // converge as well without. Unless `least` (m, one per indenter) is empty, points that overlap
  // the undeformed body less than that are excluded.
  void add(const Vector& displacement, std::span<const Indenter> indenters,
           std::span<const double> least, Vector& force, Eigen::SparseMatrix<double>& stiffness,
           std::vector<Met>& met) const;

  // On the tissue at the nodes of the mesh, Pa: the means of the integration points around a node,
  // weighted by their areas and by part_values(), which keeps the sum of the forces. Between the
  // points the overlap itself is no pressure.
  [[nodiscard]] std::vector<Vec3> tractions(const Vector& displacement,
                                            std::span<const Indenter> indenters) const;

  // Half of every indenter's deepest overlap with the undeformed body, m: where it is more, Hertz's
  // contact is, half of the area that overlaps.
  [[nodiscard]] std::vector<double> half_depths(std::span<const Indenter> indenters) const;

  // J, whose gradient add() adds.
  [[nodiscard]] double energy(const Vector& displacement,
                              std::span<const Indenter> indenters) const;

 private:
  static constexpr std::size_t face_points = 7;
  struct Own {
    Face nodes{};
    Vec3 middle = Vec3::Zero();               // m
    double reach = 0.0;                       // m, of its corners from the middle
    std::array<Vec3, face_points> places{};   // m
    std::array<Vec3, face_points> normals{};  // outwards, unit
    std::array<double, face_points> areas{};  // m^2
    std::array<int, 171> entries{};           // lower triangle by rows, -1 where held
  };
  struct Overlap {
    double depth = 0.0;  // m, above 0
    Vec3 push;           // against its gradient
  };
  // Calls visit(face, point, indenter, overlap) for every overlap.
  template <class Visit>
  void for_each(const Vector& displacement, std::span<const Indenter> indenters,
                std::span<const double> least, const Visit& visit) const;

  std::vector<Own> faces_;
  double stiffness_ = 0.0;
};

// What a body and its supports are.
struct Body {
  Mesh mesh;
  std::vector<tissue::Isotropic> tissues;  // one per region
  std::vector<char> held;                  // per degree of freedom
  std::vector<OuterFace> met;              // faces that the finger may meet
  double size = 0.0;                       // m, of the elements under the finger
  double travel = 0.0;                     // m, the deepest
  int copies = 1;                          // how often the mesh makes the body, by its mirrors
  std::array<bool, 2> mirrored{};          // across x, across y
};

// That of the highest face that may be met.
[[nodiscard]] const tissue::Isotropic& tissue_at_top(const Body& body);

// The force on the finger at one place, of all copies.
struct Answer {
  std::vector<double> forces;  // N, upwards, one per indenter
  Vec3 force = Vec3::Zero();   // N, on the finger; sideways parts that mirrors cancel are excluded
  double lost = 0.0;           // m, depth that the penalty lets through, mean weighted by pressure
  double area = 0.0;           // m^2, in contact
  double spread = 0.0;         // m, root mean square distance of the pressure from the pole
  double peak = 0.0;           // Pa, the largest of Contact::tractions(), on undeformed area
  int touching = 0;            // indenters in contact

  [[nodiscard]] double normal() const;  // N, sum of `forces`
};

// Newton's method from the place before, with a start extrapolated from the last two places; where
// it fails the way is halved.                                        docs/theory.md [penalty]
class Press {
 public:
  explicit Press(Body body);
  Press(const Press&) = delete;
  Press& operator=(const Press&) = delete;

  // With the finger's point at 0.
  void set_finger(std::vector<Indenter> indenters) { indenters_ = std::move(indenters); }
  // Puts the finger at a place (m) where it touches nothing, and the body at rest.
  void begin(const Vec3& finger);

  // Moves the finger's point to `finger` (m). Nothing if no equilibrium is found on the way, or if
  // walls of a hollow would pass through each other there; the state is then that of reached().
  // Throws Stopped when asked to stop.
  [[nodiscard]] std::optional<Answer> go(const Vec3& finger);
  [[nodiscard]] const Vec3& reached() const { return now_.finger; }
  // Whether the last go() ended because walls of a hollow under the finger meet.
  [[nodiscard]] bool walls_meet() const { return walls_meet_; }

  // The displacement (m) with the finger's point at `finger` (m); nothing without an equilibrium.
  // The state stays as it is, so that later answers do not depend on this.
  [[nodiscard]] std::optional<Vector> look(const Vec3& finger);

  // Those of the contact at a displacement (m), with the finger's point at `finger` (m).
  [[nodiscard]] std::vector<Vec3> tractions(const Vector& displacement, const Vec3& finger) const {
    return contact_.tractions(displacement, finger_at(finger));
  }

  [[nodiscard]] std::vector<Indenter> finger_at(const Vec3& place) const;  // m
  [[nodiscard]] const Body& body() const { return body_; }
  [[nodiscard]] int factorisations() const { return factorisations_; }

 private:
  struct State {
    Vec3 finger = Vec3::Zero();
    Vector displacement;
    std::vector<double> pressures;
  };
  [[nodiscard]] std::optional<Answer> settle(const Vec3& finger, bool extrapolate);
  [[nodiscard]] bool walls_cross(const Vector& displacement, const Vec3& place) const;
  [[nodiscard]] bool factor();
  [[nodiscard]] bool solve(const Vector& right, Vector& x);
  [[nodiscard]] int images_of(const Vec3& pole) const;

  Body body_;
  Elements elements_;
  Contact contact_;
  FrontCholesky factors_;
  Eigen::SparseMatrix<double> stiffness_, linear_;
  std::vector<Indenter> indenters_;
  State now_, before_;
  bool has_before_ = false;
  int factorisations_ = 0;
  bool walls_meet_ = false;
  bool near_ = false;  // whether factors_ are those of a stiffness near the present one
  GradientVectors vectors_;
};

}  // namespace palpate::solid
