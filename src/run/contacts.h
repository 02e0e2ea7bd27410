// Every contact of the finger's spheres with the specimen, and the forces that balance.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "contact/detection.h"
#include "contact/law.h"
#include "contact/ring.h"
#include "run/influence.h"
#include "scene/scene.h"

namespace palpate::run {

// One sphere at one place of the skin.
struct SphereContact {
  int sphere = 0;
  contact::Patch patch;
  contact::ContactLaw law;   // its coefficient less what it shares with contacts at the same place
  double approach = 0.0;     // m, of the sphere into the skin as the mesh's own motion leaves it
  double depth = 0.0;        // m, h of eq. (2)
  double force = 0.0;        // N, along the patch's normal
  Vec3 drag = Vec3::Zero();  // N, tangential, on the tissue
  Vec3 stretch = Vec3::Zero();  // m, of finger against tissue since the contact last slipped
  contact::Spread load;
  bool on_crease = false;
  bool one_sided = false;  // its curvature
};

// What the finger does at one moment.
struct Touch {
  Vec3 finger = Vec3::Zero();  // m, the finger's point
  double travel = 0.0;         // m, below where it first touched
  double slide = 0.0;          // m, sideways
  std::vector<SphereContact> contacts;

  [[nodiscard]] const SphereContact* deepest() const;
  [[nodiscard]] double normal_force() const;  // N, upwards on the finger: of the normal forces
  [[nodiscard]] double force() const;         // N, upwards on the finger: friction too
  [[nodiscard]] Vec3 drag() const;            // N, tangential forces on the tissue together
  [[nodiscard]] double pressed() const;       // N, sum of the normal forces' sizes
};

// The mesh as contacts see it. Without it the skin stays as it is at rest.
struct MeshAnswer {
  std::span<const int> nodes;  // of every vertex of the skin; -1: stands
  Eigen::Index freedoms = 0;
  const integrate::Vector* displacement = nullptr;  // m, without these contacts' own forces
  Influence* one_tissue = nullptr;  // the same of a mesh that is all of one tissue, where it is not
  Influence* influence = nullptr;   // of these contacts' forces on it
  const integrate::Vector* shape = nullptr;  // m, that curvature is read from
};

// Stick and slip as the finger moves by `move` (m): the stretch between finger and tissue grows,
// and the drag is what Cattaneo and Mindlin's partial slip makes of it, at most mu F. theory.md
// (46)
void rub(const scene::Scene& scene, const Vec3& move, Touch& touch);

class Contacts {
 public:
  explicit Contacts(const scene::Scene& scene);

  // Finds the contacts of the finger at `finger` (m) and their forces. `touch` holds those of the
  // moment before: their patches are where the search begins, their stretch goes on. Returns what
  // is wrong where nothing balances or Hertz ends.
  [[nodiscard]] std::optional<std::string> find(const Vec3& finger, const MeshAnswer& mesh,
                                                Touch& touch);

  // The forces on the mesh, N.
  [[nodiscard]] static integrate::Vector load(const Touch& touch, const MeshAnswer& mesh);

  // For timing: detection alone, of the finger at a place over the mesh as it is.
  void detect(const Vec3& finger, const MeshAnswer& mesh, std::vector<SphereContact>& found);

 private:
  [[nodiscard]] std::optional<std::string> find_curvature(const MeshAnswer& mesh,
                                                          const geometry::SurfacePoint& at,
                                                          SphereContact& contact,
                                                          geometry::Curvature& here);
  [[nodiscard]] std::optional<std::string> give_law(const MeshAnswer& mesh, SphereContact& contact);
  [[nodiscard]] std::optional<std::string> settle(const MeshAnswer& mesh, Touch& touch);
  void carry_on(const Touch& before, SphereContact& contact) const;
  void shape_patches(std::vector<SphereContact>& contacts);
  void approach_moving_skin(const Vec3& finger, SphereContact& contact);
  void find_compliance(const MeshAnswer& mesh, const std::vector<SphereContact>& contacts);
  [[nodiscard]] bool presses_as_one() const;
  [[nodiscard]] contact::Patch read_patch(const std::vector<SphereContact>& contacts,
                                          const SphereContact& own) const;
  [[nodiscard]] double sinking(const MeshAnswer& mesh, const contact::Patch& patch,
                               const contact::Reading& reading, const SphereContact& pressed) const;
  [[nodiscard]] double other_tissues(const MeshAnswer& mesh, const SphereContact& own,
                                     const SphereContact& pressed) const;
  [[nodiscard]] double unknown_to_hertz(const contact::Patch& patch,
                                        const SphereContact& other) const;
  [[nodiscard]] double plane_modulus() const;  // Pa, E' of the tissue's network
  void share_places(std::vector<SphereContact>& contacts);

  const scene::Scene* scene_;
  const geometry::SmoothSurface* surface_;
  contact::Detector detector_;
  contact::Spreader spreader_;
  contact::RingReader rings_;
  geometry::CurvatureStars stars_;
  std::map<int, std::array<geometry::CurvatureEstimate, 3>>
      known_curvature_;      // by triangle, at rest
  std::vector<Vec3> moved_;  // displacement of every vertex, m
  std::vector<geometry::SmoothSurface::Foot> feet_;
  std::vector<double> shares_;  // the greatest at every vertex
  Eigen::MatrixXd compliance_;  // m/N
  bool moving_ = false;
};

}  // namespace palpate::run
