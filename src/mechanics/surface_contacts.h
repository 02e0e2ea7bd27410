// Where the finger's spheres touch the surface, with which laws and patches, and their equations:
// what all couplings but `resolved` share.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "contact/detection.h"
#include "contact/patch.h"
#include "geometry/box_tree.h"
#include "geometry/curvature.h"
#include "mechanics/moving_part.h"

namespace palpate::mechanics {

// The surface's curvature at a point, at rest or as the mesh deforms it.
class SurfaceCurvature {
 public:
  // The part must outlive this.
  explicit SurfaceCurvature(const MovingPart& part);

  // Sets `here` (1/m) to the curvature at a point: of the mesh's surface or, for a surface file, of
  // its triangles where they suffice, which a mesh may have coarsened. With `contact.curvature_on =
  // "deformed"` it is that of the displaced surface. Sets `one_sided` if its estimate is
  // StarStatus::one_sided. Returns a sentence if it cannot be estimated.
  [[nodiscard]] std::optional<std::string> find(const geometry::SurfacePoint& at, bool& one_sided,
                                                geometry::Curvature& here);
  void make_room();  // after which find() allocates nothing

 private:
  using Corners = std::array<geometry::CurvatureEstimate, 3>;
  [[nodiscard]] const Corners& at_rest(int triangle);
  [[nodiscard]] Corners on_file(int triangle) const;

  const MovingPart* part_;
  const geometry::Surface* outer_surface_;
  geometry::CurvatureStars stars_;
  std::vector<int> number_of_;                // per triangle: index into known_; -1: not computed
  std::vector<Corners> known_;                // at rest
  std::optional<geometry::BoxTree> of_file_;  // of Scene::of_file
  geometry::Surface shape_;                   // the deformed surface
};

// Sets the first `count` rows and columns to 0; allocates only if the matrix is smaller.
void clear_corner(Eigen::MatrixXd& matrix, Eigen::Index count);

class SurfaceContacts {
 public:
  static constexpr int most_passes = 100;

  // The part must outlive this.
  explicit SurfaceContacts(const MovingPart& part);

  // Finds the places of the surface that lie in a sphere of the finger at `finger` (m), or are less
  // than `beyond` (m) away from it: on the surface under `displacement` (m), or at rest if that is
  // null. find() takes the places that are left in the list.
  KeptList<SphereContact>& detect(const Vec3& finger, const integrate::Vector* displacement,
                                  double beyond = 0.0);

  // Finds the contacts at the detected places and their forces. On entry `touch` contains the
  // contacts of the previous step, for first guesses and the stretch of the friction. solve(touch)
  // calls settle(); `beyond` is that of rub(). Returns a sentence if the equations have no solution
  // or the contact law does not apply.
  template <class Solve>
  [[nodiscard]] std::optional<std::string> find(const Vec3& finger, Touch& touch,
                                                const Solve& solve,
                                                BodySurfaceDisplacement* beyond = nullptr);

  // Solves [contacts] and recomputes the patches until their radii do not change,
  // or only once for `passes` = 1. complete(approaches, compliance) fills the compliance (m/N),
  // whose first rows and columns belong to the contacts and are 0 at first, may change the
  // approaches (m), and returns the compliance to solve with.
  template <class Complete>
  [[nodiscard]] std::optional<std::string> settle(Touch& touch, const Complete& complete,
                                                  int passes = most_passes);

  // First guess for a single contact at rest, with the compliance of the previous step.
  static void guess_depth(KeptList<SphereContact>& contacts);
  // Fills the contact's wide patch.                                   docs/theory.md [inertia]
  void spread_wide(SphereContact& contact);

  // Allocates the memory, also of `touch`, for up to four contacts per sphere.
  void make_room(Touch& touch);
  // Where several spheres stand for one, the place nearest to their middle at the last detect(),
  // with no radius of its own; nothing where there is none below it.
  [[nodiscard]] const std::optional<contact::Patch>& below_middle() const { return below_middle_; }
  [[nodiscard]] std::size_t most_contacts() const { return 4 * scene_->finger.centres.size(); }
  [[nodiscard]] const Eigen::MatrixXd& compliance() const { return compliance_; }

 private:
  [[nodiscard]] std::optional<std::string> give_law(SphereContact& contact);
  void carry_on(const Touch& before, SphereContact& contact) const;
  void shape_patches(KeptList<SphereContact>& contacts);
  void share_places(KeptList<SphereContact>& contacts);
  void load_nearest_node(SphereContact& contact) const;
  void approach_moved_surface(const Vec3& finger, SphereContact& contact) const;
  void begin_pass(Touch& touch);
  [[nodiscard]] std::optional<double> balance(KeptList<SphereContact>& contacts,
                                              const Eigen::MatrixXd& compliance,
                                              double part_of_way);

  const scene::Scene* scene_;
  const MovingPart* part_;
  const geometry::SmoothSurface* surface_;
  contact::Detector detector_;
  contact::Spreader spreader_;
  contact::SurfaceSpacing spacing_;
  SurfaceCurvature curvature_;
  std::vector<Vec3> moved_;  // m, displacement of every vertex; empty at rest
  std::vector<geometry::SmoothSurface::ClosestPoint> feet_;
  KeptList<SphereContact> found_;
  std::optional<contact::Patch> below_middle_;
  // One per contact, while the contact equations are solved:
  std::vector<contact::PointLaw> laws_;
  std::vector<double> approaches_;  // m
  std::vector<double> depths_;      // m
  std::vector<double> parts_;       // divisors of the forces, docs/theory.md below [contacts]
  Eigen::MatrixXd compliance_;      // m/N, C of docs/theory.md [contacts], and spare memory
};

template <class Solve>
std::optional<std::string> SurfaceContacts::find(const Vec3& finger, Touch& touch,
                                                 const Solve& solve,
                                                 BodySurfaceDisplacement* beyond) {
  for (SphereContact& contact : found_) {
    if (auto wrong = give_law(contact)) return wrong;
    carry_on(touch, contact);
  }
  const Vec3 move = finger - touch.finger;
  touch.finger = finger;
  touch.contacts.swap(found_);
  if (std::optional<std::string> wrong = solve(touch)) return wrong;
  touch.contacts.erase_if([](const SphereContact& contact) { return contact.depth <= 0.0; });
  rub(*scene_, move, touch, beyond);
  return std::nullopt;
}

template <class Complete>
std::optional<std::string> SurfaceContacts::settle(Touch& touch, const Complete& complete,
                                                   int passes) {
  const double settled = 1e-12 * scene_->finger.sphere_radius;
  // Each pass takes this part of the way to the depths for the radii of the pass before: less after
  // a pass that did not come nearer.
  double part_of_way = 1.0;
  double change_before = std::numeric_limits<double>::infinity();
  for (int pass = 0; pass < passes; ++pass) {
    begin_pass(touch);
    const Eigen::MatrixXd& whole = complete(approaches_, compliance_);
    const std::optional<double> change = balance(touch.contacts, whole, part_of_way);
    if (!change)
      return "no penetration balances the contact: the layer is too thin for this depth; press "
             "less deep";
    if (*change <= settled) return std::nullopt;
    if (*change > 0.7 * change_before) part_of_way *= 0.6;
    change_before = *change;
  }
  if (passes > 1)
    return "the contact radius did not settle in 100 iterations; take a smaller "
           "`solver.time_step`, or press less deep";
  shape_patches(touch.contacts);
  return std::nullopt;
}

}  // namespace palpate::mechanics
