// Finds the contacts of the finger's spheres with a mesh and solves for their forces.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "contact/detection.h"
#include "contact/law.h"
#include "contact/skin_spacing.h"
#include "mechanics/body_sinking.h"
#include "mechanics/influence.h"
#include "mechanics/kept_list.h"
#include "scene/scene.h"

namespace palpate::mechanics {

// The nodal forces and gaps of a contact with the coupling `resolved`.
struct NodalContact {
  std::vector<Vec3> push;      // per newton of the contact's force: one per vertex of its `load`
  double peak_pressure = 0.0;  // Pa, largest nodal pressure, docs/theory.md (72)
  std::vector<int> vertices;   // of the skin near the sphere, ascending
  std::vector<double> gap;     // m, between these vertices and the sphere

  void renew();  // clears all, but keeps the memory of the lists
};

// The contact of one sphere at one place of the skin.
struct SphereContact {
  int sphere = 0;
  contact::Patch patch;
  contact::ContactLaw law;
  double approach = 0.0;        // m, A of docs/theory.md (14): the sphere below the surface
  double depth = 0.0;           // m, h of eq. (2)
  double force = 0.0;           // N, along the patch's normal
  double elastic = 0.0;         // N, the part of `force` that the law gives for relaxed tissue
  double radiated = 0.0;        // N, the part of `force` for waves that the mesh cannot resolve
  double compliance = 0.0;      // m/N, C_ii of docs/theory.md (15)
  double sinking_error = 0.0;   // m/N, e of docs/theory.md (12)
  double sinking_doubt = 0.0;   // m/N, of the boundary's flat faces
  double stiffness = 0.0;       // N/m, derivative of `force` with respect to `depth`; where inertia
                                // reaches the force, to the finger's position, within a step
  Vec3 drag = Vec3::Zero();     // N, tangential, on the tissue
  Vec3 stretch = Vec3::Zero();  // m, of the finger relative to the tissue since the last slip
  contact::Spread load;         // of the pressure
  contact::Spread wide;         // over the wide patch (74); empty unless MeshAnswer::wide
  NodalContact nodal;           // with `resolved`; otherwise empty
  bool on_crease = false;
  bool one_sided = false;  // its curvature has StarStatus::one_sided

  // m/N: the tangential displacement beyond the half-space's is this tensor times the drag.
  Eigen::Matrix3d shear = Eigen::Matrix3d::Zero();

  void renew();  // resets all members, but keeps the memory of the lists
};

// The pressure in the middle of the contact, Pa: for Hertz 3/2 of the mean, for a layer from its
// law (59), with `resolved` the largest nodal pressure.
[[nodiscard]] double peak_pressure(const SphereContact& contact);

// The mesh's own error in the contact's force, a fraction of it; 0 where the law alone gives it.
//                                                                        docs/theory.md (12)
[[nodiscard]] double mesh_error(const SphereContact& contact);

// Position of the finger and the state of its contacts at one moment.
struct Touch {
  Vec3 finger = Vec3::Zero();  // m, the finger's reference point
  double travel = 0.0;         // m, below the first touch
  double slide = 0.0;          // m, sideways
  KeptList<SphereContact> contacts;

  [[nodiscard]] const SphereContact* deepest() const;  // null without contacts
  [[nodiscard]] double normal_force() const;           // N, upwards on the finger, without friction
  [[nodiscard]] double force() const;                  // N, upwards on the finger, with friction
  [[nodiscard]] Vec3 drag() const;       // N, sum of the tangential forces on the tissue
  [[nodiscard]] double pressed() const;  // N, sum of the magnitudes of the normal forces
};

// A mesh whose inertia reaches the force, for `consistent`. In a step it is loaded with
// share (past force + slope (elastic force - past elastic force)).           docs/theory.md (74)
struct MovingMesh {
  const integrate::Vector* displacement = nullptr;  // m, at the step's end without these forces
  const integrate::Vector* still = nullptr;  // N, its static displacement is subtracted; or empty
  bool still_has_past = false;               // `still` contains the past elastic forces
  Influence* response = nullptr;  // of the mesh at the step's end; null in explicit steps
  double share = 1.0;
  double slope = 1.0;
  double time_step = 0.0;  // s
};

// State and compliance of the mesh. Without `displacement` contacts are found on the skin at rest.
struct MeshAnswer {
  std::span<const int> nodes;  // one per vertex of the skin; -1: does not move
  Eigen::Index freedoms = 0;
  const integrate::Vector* displacement = nullptr;  // m, without the forces of these contacts
  Influence* influence = nullptr;                   // under forces of these contacts
  BodySinking* beyond = nullptr;                    // of statics, for `consistent`
  bool wide = false;                                // the mesh is loaded through the wide patches
  const integrate::Vector* shape = nullptr;  // m, displacement for the curvature; null: at rest
  const MovingMesh* moving = nullptr;        // set where inertia reaches the force

  [[nodiscard]] int node_of(int vertex) const { return nodes[as_index(vertex)]; }
};

// Friction of all contacts after the finger has moved by `move` (m). The stretch grows by the
// tangential part of `move`, and Cattaneo and Mindlin's partial slip gives the drag, at most mu F;
// with `contact.slip = "coulomb"` the drag is mu F along `move`. `beyond` renews the contacts'
// `shear`; without it they keep it.                                          docs/theory.md (8)
void rub(const scene::Scene& scene, const Vec3& move, Touch& touch, BodySinking* beyond = nullptr);

// Why Hertz's law does not apply to tissue of the curvature `kappa_2` (1/m).
[[nodiscard]] std::string hollow_text(double kappa_2);

class ResolvedContact;

class Contacts {
 public:
  explicit Contacts(const scene::Scene& scene);
  ~Contacts();

  // Finds the contacts of the finger at `finger` (m) and their forces. On entry `touch` contains
  // the contacts of the previous step, for first guesses and the stretch of the friction. Returns a
  // sentence if the equations have no solution or the contact law does not apply.
  [[nodiscard]] std::optional<std::string> find(const Vec3& finger, const MeshAnswer& mesh,
                                                Touch& touch);

  // Calls push(node, force in N) for every node of the mesh that a contact loads, per contact.
  template <class Push>
  static void push(const Touch& touch, const MeshAnswer& mesh, const Push& push);

  // The forces on the mesh, N.
  [[nodiscard]] static integrate::Vector load(const Touch& touch, const MeshAnswer& mesh);
  static void load(const Touch& touch, const MeshAnswer& mesh, integrate::Vector& load);

  // Nodal loads (N) of the elastic forces over the actual minus over the wide patches; sum is 0.
  static void finer_load(const Touch& touch, const MeshAnswer& mesh, integrate::Vector& load);

  // Stores the forces, after viscosity, that the next find() with a moving mesh takes as past.
  void keep_forces(const Touch& touch);

  // Allocates the memory, also of `touch`, that find() needs for up to four contacts per sphere.
  void make_room(Touch& touch);

  // The detection of find() alone (public for timing): fills `found` with the contacts' positions.
  void detect(const Vec3& finger, const MeshAnswer& mesh, KeptList<SphereContact>& found);

 private:
  [[nodiscard]] std::optional<std::string> find_curvature(const MeshAnswer& mesh,
                                                          const geometry::SurfacePoint& at,
                                                          SphereContact& contact,
                                                          geometry::Curvature& here);
  [[nodiscard]] std::optional<std::string> give_law(const MeshAnswer& mesh, SphereContact& contact);
  [[nodiscard]] std::optional<std::string> settle(const MeshAnswer& mesh, Touch& touch);
  void carry_on(const Touch& before, SphereContact& contact) const;
  void guess_depth(SphereContact& contact) const;
  void shape_patches(KeptList<SphereContact>& contacts);
  void load_nearest_node(SphereContact& contact) const;
  void approach_moving_skin(const Vec3& finger, SphereContact& contact);
  void find_compliance(const MeshAnswer& mesh, KeptList<SphereContact>& contacts);
  void find_body_sinking(const MeshAnswer& mesh, KeptList<SphereContact>& contacts);
  void find_mesh_sinking(const MeshAnswer& mesh, const KeptList<SphereContact>& contacts);
  [[nodiscard]] bool presses_as_one() const;
  [[nodiscard]] BodySinking::Value joint_sinking(const MeshAnswer& mesh,
                                                 const KeptList<SphereContact>& contacts,
                                                 contact::Patch& joint) const;
  [[nodiscard]] double plane_modulus() const;  // Pa, E / (1 - nu^2)
  // In contact_inertia.cpp, where inertia reaches the force:
  struct Past {  // a contact at the end of the previous step
    int sphere = 0;
    Vec3 position = Vec3::Zero();        // m
    double approach = 0.0, depth = 0.0;  // m
    double spread = 0.0;                 // N, the delayed load Q of docs/theory.md (75)
    double elastic = 0.0, force = 0.0;   // N
  };
  struct NearField {
    Past past;
    double damping = 0.0;  // N s/m, C_L of docs/theory.md (75)
    double delay = 0.0;    // s, T of docs/theory.md (75)
  };
  [[nodiscard]] double rise(const MeshAnswer& mesh) const;
  void spread_wide(SphereContact& contact);
  void leave_apart(const MeshAnswer& mesh, KeptList<SphereContact>& found);
  void find_motion(const MeshAnswer& mesh, const KeptList<SphereContact>& contacts);
  void find_near_field(const MovingMesh& moving, const KeptList<SphereContact>& contacts,
                       double part);
  [[nodiscard]] double part_of_motion(const KeptList<SphereContact>& contacts) const;
  void add_motion(const MovingMesh& moving, const KeptList<SphereContact>& contacts,
                  std::vector<double>& approaches);
  template <class Matrix>
  void damp(double time_step, std::vector<double>& approaches);
  [[nodiscard]] bool release(const MovingMesh& moving, KeptList<SphereContact>& contacts);
  void remember(const MovingMesh& moving, KeptList<SphereContact>& contacts);
  void share_places(KeptList<SphereContact>& contacts);

  const scene::Scene* scene_;
  const geometry::SmoothSurface* surface_;
  contact::Detector detector_;
  contact::Spreader spreader_;
  contact::SkinSpacing spacing_;
  geometry::CurvatureStars stars_;
  std::vector<int> curvature_of_;  // per triangle: index into known_curvature_; -1: not computed
  std::vector<std::array<geometry::CurvatureEstimate, 3>> known_curvature_;  // at rest
  geometry::Surface shape_;  // the deformed surface, for the curvature
  std::vector<Vec3> moved_;  // m, displacement of every vertex
  std::vector<geometry::SmoothSurface::Foot> feet_;
  KeptList<SphereContact> found_;
  // One per contact, while the contact equations are solved:
  std::vector<contact::PointLaw> laws_;
  std::vector<double> approaches_;  // m
  std::vector<double> depths_;      // m
  std::vector<double> parts_;       // divisors of the forces, docs/theory.md below (15)
  // The first rows and columns belong to the contacts; the rest is spare memory.
  Eigen::MatrixXd compliance_;        // m/N, C of docs/theory.md (15)
  Eigen::MatrixXd whole_compliance_;  // m/N, with the terms of the mesh's motion
  Eigen::VectorXd softness_;          // m/N, diagonal of whole_compliance_ before damp()
  Eigen::VectorXd motion_;            // m, `m` of docs/theory.md (74)
  Eigen::MatrixXd moving_by_force_;   // m/N, response at the end of the step
  Eigen::MatrixXd still_by_force_;    // m/N, static response c_ij of docs/theory.md (74)
  std::vector<NearField> near_;
  double radiation_ = 0.0;  // m s/N, D of docs/theory.md (75)
  std::vector<Past> past_;
  std::vector<Past> parted_;                   // contacts that release() removed in this step
  std::unique_ptr<ResolvedContact> resolved_;  // does the work of find() for `resolved`
  bool moving_ = false;                        // MeshAnswer::displacement is set
};

// Sets the first `count` rows and columns to 0; allocates only if the matrix is smaller.
void clear_corner(Eigen::MatrixXd& matrix, Eigen::Index count);

template <class Push>
void Contacts::push(const Touch& touch, const MeshAnswer& mesh, const Push& push) {
  for (const SphereContact& contact : touch.contacts) {
    const Vec3 whole = contact.drag - contact.force * contact.patch.normal;
    const contact::Spread& spread = contact.wide.vertices.empty() ? contact.load : contact.wide;
    const std::vector<Vec3>& pushes = contact.nodal.push;
    for (std::size_t k = 0; k < spread.vertices.size(); ++k) {
      const int node = mesh.node_of(spread.vertices[k]);
      if (node >= 0)
        push(node, pushes.empty()
                       ? Vec3(spread.shares[k] * whole)
                       : Vec3(spread.shares[k] * contact.drag + contact.force * pushes[k]));
    }
  }
}

}  // namespace palpate::mechanics
