// Neo-Hookean ten-node tetrahedra: forces, stiffness, and the pressure that is eliminated.
#pragma once

#include <Eigen/SparseCore>
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "geometry/tet_mesh.h"
#include "tissue/coupled.h"

namespace palpate::solid {

// Corners as those of geometry::TetMesh, then the middles of geometry::corner_edges in their order.
using Element = std::array<int, 10>;
// Corners counter-clockwise from outside, then the middles of edges (0, 1), (1, 2), (2, 0).
using Face = std::array<int, 6>;

struct OuterFace {
  Face nodes{};
  int element = 0;
};

struct Mesh {
  std::vector<Vec3> nodes;  // m
  std::vector<Element> elements;
  std::vector<int> regions;         // one per element
  std::vector<OuterFace> boundary;  // in the order of the elements
};

// The place (m) of the middle of an edge between two corners (ascending) of the mesh, or nothing
// for its straight middle.
using Middle = std::function<std::optional<Vec3>(const std::array<int, 2>& corners)>;

// Gives every tetrahedron middles of its edges; corners keep their numbers. Where a curved edge
// would turn an element inside out, it stays straight. Throws MeshError if a tetrahedron is flat.
[[nodiscard]] Mesh quadratic(const geometry::TetMesh& mesh, const Middle& middle = {});

// Values and derivatives of the ten functions of an element at barycentric coordinates of its
// corners; the derivatives are those to the last three.
struct Functions {
  std::array<double, 10> values{};
  std::array<Vec3, 10> derivatives{};
};
[[nodiscard]] Functions functions_at(const std::array<double, 4>& corners);

// Values of the six functions of a face at barycentric coordinates of its corners.
[[nodiscard]] std::array<double, 6> face_values(const std::array<double, 3>& corners);
// The four parts of a face that its middles make, by its nodes.
inline constexpr std::array<std::array<std::size_t, 3>, 4> face_parts{
    {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}}};
// Of the functions that are linear in each of these parts.
[[nodiscard]] std::array<double, 6> part_values(const std::array<double, 3>& corners);

// The four integration points of an element, each with the weight 1/24.
inline constexpr int points = 4;
[[nodiscard]] const std::array<Functions, points>& at_points();

using Vector = Eigen::VectorXd;

// The energy per volume is mu/2 (J^(-2/3) tr F^T F - 3) + kappa/2 (J - 1)^2, at four points of
// every element. What kappa has above own_share mu acts on the mean J of the element, so that it
// does not lock; all of it on the mean would let a single element bend too easily. The stiffness is
// taken at a pressure p of its own, which becomes kappa (J - 1) by advance(): Newton's method then
// converges near nu = 1/2 as well.
//                                                                      docs/theory.md [solid]
class Elements {
 public:
  static constexpr double own_share = 5.0;

  // `tissues` has one entry per region of the mesh. Degrees of freedom with `held` != 0 do not
  // move. The mesh must outlive this.
  Elements(const Mesh& mesh, std::span<const tissue::Isotropic> tissues,
           std::span<const char> held);

  [[nodiscard]] const Mesh& mesh() const { return *mesh_; }
  [[nodiscard]] const tissue::Isotropic& tissue(int element) const {
    return tissues_[as_index(mesh_->regions[as_index(element)])];
  }
  // The unknown of a degree of freedom (3 node + axis), or -1 if it is held.
  [[nodiscard]] int unknown(int freedom) const { return unknowns_[as_index(freedom)]; }
  [[nodiscard]] int unknowns() const { return count_; }
  // The first unknown of every node with unknowns, then their number.
  [[nodiscard]] std::span<const int> first_unknowns() const { return first_; }
  // Where the entry of two unknowns is in the values of the stiffness; -1 outside its pattern.
  [[nodiscard]] int entry(int row, int column) const;

  // Sets `force` (N, 3 per node) to the gradient of the energy at `displacement` (m), and the lower
  // triangle `stiffness` (N/m) to the derivative at the present pressures. Returns the least J.
  double assemble(const Vector& displacement, Vector& force,
                  Eigen::SparseMatrix<double>& stiffness);

  // The energy, J; its gradient is the force of assemble().
  [[nodiscard]] double energy(const Vector& displacement) const;

  // Moves the pressures by `share` of the way to kappa (J - 1 + dJ), linear in the change `step` of
  // the displacement.
  void advance(const Vector& displacement, const Vector& step, double share);

  // One per point of every element, Pa.
  [[nodiscard]] const std::vector<double>& pressures() const { return pressures_; }
  void set_pressures(std::vector<double> pressures) { pressures_ = std::move(pressures); }

 private:
  struct Point {
    double weight = 0.0;                // m^3
    std::array<double, 30> gradient{};  // 1/m: of function a along axis k at 3 a + k
  };
  void find_points();
  void find_pattern();

  const Mesh* mesh_;
  std::vector<tissue::Isotropic> tissues_;
  std::vector<Point> points_;                         // four per element
  std::vector<double> shear_, own_bulk_, mean_bulk_;  // Pa, per element
  std::vector<double> pressures_;
  std::vector<int> unknowns_;
  std::vector<int> first_;
  int count_ = 0;
  Eigen::SparseMatrix<double> pattern_;
  std::vector<int> entries_;  // 465 per element: of its lower triangle by rows, -1 where held
};

}  // namespace palpate::solid
