// The surface displacement beyond a half-space's at any place and for any contact radius.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "mechanics/energy_coupling.h"
#include "scene/surface_displacement_store.h"

namespace palpate::mechanics {

// EnergyCoupling::beyond() is evaluated for a few radii at the first touch and at vertices of the
// surface, each when it is first needed, and interpolated: over the radius by a cubic polynomial,
// over the surface linearly within a triangle. Where the finger first touches there is no
// interpolation.
//                                                                    docs/theory.md [energy]
class BodySurfaceDisplacement {
 public:
  // The references must outlive this. `deepest` (m) is the largest depth of a contact.
  BodySurfaceDisplacement(const scene::Scene& scene, const tissue::Part& part,
                          std::span<const char> held, double deepest);

  struct Value {
    double surface_displacement = 0.0;  // m/N, s + e
    double slope = 0.0;                 // 1/N, of that with respect to the radius
    double error = 0.0;                 // m/N, e
    double doubt = 0.0;                 // m/N, BeyondHalfSpace::doubt
  };
  // The value under the patch; an ellipse counts as a circle of the same area.
  [[nodiscard]] Value at(const contact::Patch& patch);

  // The same of tangential loads: the displacement (m/N) in the patch's plane beyond the
  // half-space's is this symmetric tensor times the load. Zero without friction, over a
  // frictionless base, on which a tangential load meets no resistance, and where the law is that of
  // flat layers.
  [[nodiscard]] Eigen::Matrix3d shear(const contact::Patch& patch);

  // The error of the surface displacement under a circular patch per tetrahedron of the part, m/N.
  [[nodiscard]] std::vector<double> errors(const contact::Patch& patch);

  // SymmetricSolver::error() of all places so far.
  [[nodiscard]] double solution_error() const { return solution_error_; }

  // The surface displacement of the rest w under the vertices of `read`, along `normal`, per newton
  // on `pressed`, m/N.
  [[nodiscard]] double rest(const Vec3& normal, const contact::Spread& read,
                            std::span<const int> nodes, const contact::Patch& pressed);

  // Evaluates the first touch, and the vertices of all triangles that come within `reach` (m) of
  // it.
  void make_ready(double reach);

 private:
  using Place = scene::SunkPlace;
  static constexpr std::size_t radii = Place::radii;
  // The places of the table in which a radius lies, relative to the largest.
  static constexpr std::array<double, radii> steps{0.2, 0.45, 0.75, 1.0};
  struct Share {
    const Place* place = nullptr;
    double weight = 0.0;
  };
  // A side of a crease; the only one beside none.
  struct Side {
    contact::Patch patch;
    double part = 1.0;
  };
  [[nodiscard]] std::span<const Side> sides_of(const contact::Patch& patch);
  // Lagrange's polynomials of the radii and their derivatives. Outside of the table a value goes on
  // with the slope at its end, which decays: product + slope * (1 - fading).
  struct Polynomials {
    std::array<double, radii> product{}, slope{}, value{};
    double fading = 1.0;
  };
  [[nodiscard]] static Polynomials polynomials(double ratio);
  [[nodiscard]] std::string key() const;
  void make_couplings();
  [[nodiscard]] static std::array<EnergyCoupling::Press, 3> shear_presses(
      const contact::Patch& patch);
  [[nodiscard]] Eigen::Matrix3d find_shear(const contact::Patch& patch,
                                           std::span<const BeyondHalfSpace, 3> beyond) const;
  void spread(const contact::Patch& patch);
  [[nodiscard]] Place evaluate(const contact::Patch& like);
  [[nodiscard]] Place place_at(const contact::Patch& like, int vertex);
  [[nodiscard]] const Place& at_vertex(const contact::Patch& patch, std::size_t corner);

  const scene::Scene* scene_;
  const tissue::Part* part_;
  std::vector<char> held_;
  const geometry::SmoothSurface* surface_;
  // Made when first needed, of unit modulus.
  std::optional<EnergyCoupling> coupling_;
  // For laws of flat layers only the effect of the sides comes from the mesh: half the difference
  // between free sides and these, which slide.
  std::optional<EnergyCoupling> sliding_;
  double largest_;           // m, the largest contact radius of the table
  double modulus_;           // Pa, E of the tissue
  double plane_modulus_;     // E' / E = 1 / (1 - nu^2) of the tissue
  double shear_compliance_;  // (2 - nu) E / G of the tissue
  double solution_error_ = 0.0;
  bool rubs_;                     // tangential loads are evaluated
  geometry::SurfacePoint first_;  // where the finger touches first
  std::string key_;               // of the body in scene::SurfaceDisplacementStore, if there is one
  std::optional<Place> at_first_;
  // Per vertex, one place for each smooth side of its creases.
  std::map<int, std::vector<std::pair<Vec3, Place>>> at_vertices_;
  std::array<Side, 2> sides_;
  std::array<Share, 4> shares_;
};

}  // namespace palpate::mechanics
