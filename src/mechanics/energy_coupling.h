// The surface displacement under a contact beyond a half-space's, and the mesh's own error in it.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "base/symmetric_solver.h"
#include "contact/patch.h"
#include "scene/scene.h"
#include "tissue/coupled.h"
#include "tissue/network.h"

namespace palpate::mechanics {

// The difference between the body and a half-space of the tissue at the contact, both loaded by
// 1 N, with the shape of Hertz's pressure, over the patch.
struct BeyondHalfSpace {
  double surface_displacement =
      0.0;                     // m/N: s of theory.md [compliance], along the load, averaged with it
  double error = 0.0;          // m/N: e of [compliance]; s + e is the better value
  double doubt = 0.0;          // m/N: what the flat faces of a round boundary may cost in s, and
                               // what wide tetrahedra may cost that e does not see
  std::vector<double> errors;  // m/N, both per tetrahedron of the part
  // m/N: w, the body's displacement minus the half-space's, three entries per node of the part;
  // in other tissues minus the half-space's displacement interpolated between the nodes.
  integrate::Vector rest;
};

// The displacement under a contact is the half-space's, known in closed form, plus a rest that is
// smooth under the contact; only the rest is solved for, with the linear finite elements of the
// mesh, which coupled springs are. It is loaded and read through the same nodal loads.
//                                                      docs/theory.md [split], [compliance]
class EnergyCoupling {
 public:
  // `held` has the supports' flags, one per degree of freedom of the part. Moduli are
  // in units of `unit` (Pa); compliances divided by it are in m/N.
  EnergyCoupling(const scene::Scene& scene, const tissue::Part& part, std::span<const char> held,
                 double unit = 1.0);

  // A load along the unit vector `along`, against the patch's normal or tangential, over a patch
  // whose semi-axes are both above 0.
  struct Press {
    contact::Patch patch;
    Vec3 along;
    // True if this load is (load[i - 2] + load[i - 1]) / sqrt(2); its solution is the same
    // combination of theirs.
    bool sum_of_two = false;
  };
  // One result per load; their equations are solved together. `finer` refines the quadrature of the
  // loads.
  [[nodiscard]] std::vector<BeyondHalfSpace> beyond(std::span<const Press> presses, int finer = 1);
  [[nodiscard]] BeyondHalfSpace beyond(const contact::Patch& patch, const Vec3& along,
                                       int finer = 1);

  // SymmetricSolver::error() of its solutions since the last call.
  [[nodiscard]] double take_solution_error() {
    const double error = solver_.error();
    solver_.forget_error();
    return error;
  }

 private:
  // A boundary face of the tissue at the contact, and between it and another tissue.
  struct Face {
    std::array<int, 3> nodes{};
    Vec3 normal = Vec3::Zero();    // unit, outwards
    int triangle = -1;             // of the surface; -1 within the body
    std::array<int, 3> corners{};  // of that triangle, one per node
    std::array<bool, 3> held{};    // per axis: at all three nodes
    bool interface = false;
    int tetrahedron = 0;   // of the tissue
    double cut_off = 0.0;  // m^3, between the face and the smooth surface
  };
  // The tetrahedra in which the half-space's field is subtracted: those of the tissue at the
  // contact, but for parts of the body that hang over the contact.
  static constexpr char other_tissue = 2;
  struct Home {
    std::vector<char> away;  // per tetrahedron: 1 if it is none of them
    std::vector<Face> faces;
    std::vector<char> other;  // per node: 1 at tetrahedra that are away, 2 at other tissues
    std::optional<BlockMatrix> others;  // N/m, stiffness of these tetrahedra alone
  };
  struct Tissue {
    tissue::Isotropic elastic;
    double shear_modulus = 0.0;  // Pa
    double own_bulk = 0.0;       // Pa, of single tetrahedra
    double shared_bulk = 0.0;    // Pa, of volumes averaged around nodes
  };
  struct Element {
    Eigen::Matrix<double, 4, 3> gradients;  // 1/m, of the shape functions
    double volume = 0.0;                    // m^3
  };
  class Loads;

  void find_tissues(const scene::Scene& scene, double unit);
  // The stiffness (N/m) of all tetrahedra, or of those with a flag.
  [[nodiscard]] BlockMatrix stiffness(std::span<const char> only = {}) const;
  [[nodiscard]] int region_under(int triangle) const;
  [[nodiscard]] const Home& home(int region);
  [[nodiscard]] Home make_home(std::vector<char> away, int region) const;
  // Flags of the tetrahedra that hang over a contact in a region, and of other regions; empty if
  // none hangs over it.
  [[nodiscard]] std::vector<char> hanging_over(const contact::Patch& patch, int region) const;
  [[nodiscard]] double cut_off(const Face& face) const;
  // Fills error, doubt and errors of a solution.
  void find_errors(const contact::Patch& patch, const integrate::Vector& interpolated,
                   const Home& home, BeyondHalfSpace& result) const;

  geometry::TetMesh mesh_;  // of the part
  std::vector<geometry::FaceUse> uses_;
  const geometry::SmoothSurface* outer_surface_;
  std::vector<std::array<int, 3>> surface_triangles_;  // nodes of the part, ascending
  std::map<std::array<int, 3>, int> triangle_of_;      // of the same nodes
  std::vector<int> part_node_;                         // per vertex of the surface
  std::vector<Tissue> tissues_;                        // per region
  std::vector<Element> elements_;
  std::vector<std::optional<Home>> homes_;  // per region
  std::vector<char> held_;
  std::vector<std::array<int, 4>> around_;  // per tetrahedron and corner: number of (node, region)
  std::vector<int> count_around_;           // tetrahedra per (node, region)
  tissue::Network springs_;                 // along the edges of the part
  SymmetricSolver solver_;                  // of the whole stiffness
  tissue::Volume volume_;
};

}  // namespace palpate::mechanics
