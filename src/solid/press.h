// A solid under rigid indenters, in equilibrium.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/front_cholesky.h"
#include "solid/contact.h"

namespace palpate::solid {

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

// The force on the finger at one place, of all copies.
struct Answer {
  std::vector<double> forces;  // N, upwards, one per indenter
  Vec3 force = Vec3::Zero();   // N, on the finger; sideways parts that mirrors cancel are left out
  double lost = 0.0;           // m, depth that the penalty lets through, mean weighted by pressure
  double area = 0.0;           // m^2, in contact
  double peak = 0.0;           // Pa
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

  // Moves the finger's point to `finger` (m). Nothing if no equilibrium is found on the way; the
  // state is then that of reached(). Throws Stopped when asked to stop.
  [[nodiscard]] std::optional<Answer> go(const Vec3& finger);
  [[nodiscard]] const Vec3& reached() const { return now_.finger; }

  // The displacement (m) with the finger's point at `finger` (m); nothing without an equilibrium.
  // The state stays as it is, so that later answers do not depend on this.
  [[nodiscard]] std::optional<Vector> look(const Vec3& finger);

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
  [[nodiscard]] bool factor();
  [[nodiscard]] int images_of(const Vec3& pole) const;

  Body body_;
  Elements elements_;
  Contact contact_;
  FrontCholesky factors_;
  Eigen::SparseMatrix<double> stiffness_, linear_;
  std::vector<Indenter> indenters_;
  double hardest_ = 0.0;  // Pa, largest Young's modulus
  State now_, before_;
  bool has_before_ = false;
  int factorisations_ = 0;
};

}  // namespace palpate::solid
