// Every contact of the finger's spheres with the specimen, and the forces that balance.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "contact/detection.h"
#include "contact/law.h"
#include "contact/ring.h"
#include "run/influence.h"
#include "run/kept_list.h"
#include "scene/scene.h"

namespace palpate::run {

// What `resolved` knows of a contact, node by node.
struct NodalContact {
  std::vector<Vec3> push;      // on the tissue per newton of the force, one a vertex of the load
  double peak_pressure = 0.0;  // Pa, the greatest of the nodes'
  std::vector<int> vertices;   // of the skin around the contact, ascending
  std::vector<double> gap;     // m, between them and the sphere

  void renew();
};

// One sphere at one place of the skin.
struct SphereContact {
  int sphere = 0;
  contact::Patch patch;
  contact::ContactLaw law;
  double approach = 0.0;        // m, of the sphere into the skin as the mesh's own motion leaves it
  double depth = 0.0;           // m, h of eq. (2)
  double force = 0.0;           // N, along the patch's normal
  double elastic = 0.0;         // N, of it, the law's, were the tissue relaxed
  double radiated = 0.0;        // N, of it, what makes waves too short for the mesh
  double compliance = 0.0;      // m/N, how the skin gives way to it beyond what the law knows
  double stiffness = 0.0;       // N/m, of it over the finger's place within a step
  Vec3 drag = Vec3::Zero();     // N, tangential, on the tissue
  Vec3 stretch = Vec3::Zero();  // m, of finger against tissue since the contact last slipped
  contact::Spread load;         // of the pressure
  contact::Spread wide;         // of what loads a mesh whose inertia reaches the force; else empty
  NodalContact nodal;           // of `resolved`; else empty
  bool on_crease = false;
  bool one_sided = false;  // its curvature

  void renew();  // like new, with the room of its lists
};

// In the middle of the contact, Pa: 3/2 of the mean under Hertz, a layer's own.
[[nodiscard]] double peak_pressure(const SphereContact& contact);

// What the finger does at one moment.
struct Touch {
  Vec3 finger = Vec3::Zero();  // m, the finger's point
  double travel = 0.0;         // m, below where it first touched
  double slide = 0.0;          // m, sideways
  KeptList<SphereContact> contacts;

  [[nodiscard]] const SphereContact* deepest() const;
  [[nodiscard]] double normal_force() const;  // N, upwards on the finger: of the normal forces
  [[nodiscard]] double force() const;         // N, upwards on the finger: friction too
  [[nodiscard]] Vec3 drag() const;            // N, tangential forces on the tissue together
  [[nodiscard]] double pressed() const;       // N, sum of the normal forces' sizes
};

// A mesh in motion, as `consistent` reads it. The forces that are sought act on it by
// share (past force + slope (elastic force - past elastic force)).           docs/theory.md (74)
struct MovingMesh {
  const integrate::Vector* displacement = nullptr;  // m, at the end of the step without them
  const integrate::Vector* still = nullptr;  // N: the load whose static answer is no motion, as far
                                             // as it is known; empty: none
  bool still_has_past = false;               // the contacts' past elastic forces are in it
  Influence* response = nullptr;             // of such forces, to the end of the step; or none
  double share = 1.0;
  double slope = 1.0;
  double time_step = 0.0;  // s
};

// The mesh as contacts see it. Without it the skin stays as it is at rest.
struct MeshAnswer {
  std::span<const int> nodes;  // of every vertex of the skin; -1: stands
  Eigen::Index freedoms = 0;
  bool whole = false;                               // all of the specimen moves
  const integrate::Vector* displacement = nullptr;  // m, without these contacts' own forces
  Influence* one_tissue = nullptr;  // the same of a mesh that is all of one tissue, where it is not
  Influence* influence = nullptr;   // of these contacts' forces on it
  const integrate::Vector* shape = nullptr;  // m, that curvature is read from
  const MovingMesh* moving = nullptr;        // where inertia reaches the force
};

// Stick and slip as the finger moves by `move` (m): the stretch between finger and tissue grows,
// and the drag is what Cattaneo and Mindlin's partial slip makes of it, at most mu F.
//                                                                           docs/theory.md (8)
void rub(const scene::Scene& scene, const Vec3& move, Touch& touch);

class ResolvedContact;

class Contacts {
 public:
  explicit Contacts(const scene::Scene& scene);
  ~Contacts();

  // Finds the contacts of the finger at `finger` (m) and their forces. `touch` holds those of the
  // moment before: their patches are where the search begins, their stretch goes on. Returns what
  // is wrong where nothing balances or Hertz ends.
  [[nodiscard]] std::optional<std::string> find(const Vec3& finger, const MeshAnswer& mesh,
                                                Touch& touch);

  // Calls push(node, N) for every node of the mesh that a contact loads, contact by contact.
  template <class Push>
  static void push(const Touch& touch, const MeshAnswer& mesh, const Push& push);

  // The forces on the mesh, N.
  [[nodiscard]] static integrate::Vector load(const Touch& touch, const MeshAnswer& mesh);
  static void load(const Touch& touch, const MeshAnswer& mesh, integrate::Vector& load);

  // What the pressures' own spreads would load beyond the wide ones that do, relaxed, N; it sums to
  // 0.
  static void finer_load(const Touch& touch, const MeshAnswer& mesh, integrate::Vector& load);

  // What viscosity has made of the forces that find() found for a mesh in motion.
  void keep_forces(const Touch& touch);

  // From now on nothing is allocated while a finger goes anywhere on the skin, in `touch` neither;
  // but for more than four contacts a sphere.
  void make_room(Touch& touch);

  // For timing: detection alone, of the finger at a place over the mesh as it is.
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
  void find_compliance(const MeshAnswer& mesh, const KeptList<SphereContact>& contacts);
  [[nodiscard]] bool presses_as_one() const;
  [[nodiscard]] contact::Patch read_patch(const KeptList<SphereContact>& contacts,
                                          const SphereContact& own) const;
  [[nodiscard]] double sinking(const MeshAnswer& mesh, const contact::Patch& patch,
                               const contact::Reading& reading, const SphereContact& pressed) const;
  [[nodiscard]] double known_to_law(int read, int pressed, double spacing) const;
  [[nodiscard]] double other_tissues(const MeshAnswer& mesh, const SphereContact& own,
                                     const SphereContact& pressed) const;
  [[nodiscard]] double unknown_to_hertz(const contact::Patch& patch,
                                        const SphereContact& other) const;
  [[nodiscard]] bool cut_from_layer(const MeshAnswer& mesh) const;
  [[nodiscard]] double stiffer_layer(double aligned, const Vec3& at,
                                     const SphereContact& pressed) const;
  [[nodiscard]] double plane_modulus() const;  // Pa, E' of the tissue's network
  // In contact_inertia.cpp, for a mesh in motion:
  struct Past {
    int sphere = 0;
    Vec3 position = Vec3::Zero();        // m
    double approach = 0.0, depth = 0.0;  // m
    double spread = 0.0;                 // N, the force as it has reached the wide patch
    double elastic = 0.0, force = 0.0;   // N
  };
  struct NearField {
    Past past;
    double damping = 0.0;  // N s/m, of the contact
    double delay = 0.0;    // s, of the wide patch
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
  contact::RingReader rings_;
  geometry::CurvatureStars stars_;
  std::vector<int> curvature_of_;  // of every triangle, its place in the next one; -1: none yet
  std::vector<std::array<geometry::CurvatureEstimate, 3>> known_curvature_;  // at rest
  geometry::Surface shape_;  // as it was last asked for, deformed
  std::vector<Vec3> moved_;  // displacement of every vertex, m
  std::vector<geometry::SmoothSurface::Foot> feet_;
  KeptList<SphereContact> found_;
  std::vector<contact::PointLaw> laws_;  // of a balance, as the next three
  std::vector<double> approaches_;       // m
  std::vector<double> depths_;           // m
  std::vector<double> parts_;
  std::vector<double> shares_;  // the greatest at every vertex
  contact::Reading reading_;
  // Of the contacts that are: the first rows and columns. What is behind them is room.
  Eigen::MatrixXd compliance_;        // m/N
  Eigen::MatrixXd whole_compliance_;  // m/N, with what the mesh's motion adds
  Eigen::VectorXd softness_;          // m/N, its diagonal
  Eigen::VectorXd motion_;            // m, of a moving mesh under the contacts, less statics
  Eigen::MatrixXd moving_by_force_;   // m/N, to the end of the step
  Eigen::MatrixXd still_by_force_;    // m/N, in statics
  std::vector<NearField> near_;
  double radiation_ = 0.0;  // m s/N: C / F'^2 of a half-space
  std::vector<Past> past_;
  std::vector<Past> parted_;
  std::unique_ptr<ResolvedContact> resolved_;  // instead of all this, for `resolved`
  bool moving_ = false;
};

// Makes the first `count` rows and columns 0; takes memory only where there were never so many.
void clear_corner(Eigen::MatrixXd& matrix, Eigen::Index count);

template <class Push>
void Contacts::push(const Touch& touch, const MeshAnswer& mesh, const Push& push) {
  for (const SphereContact& contact : touch.contacts) {
    const Vec3 whole = contact.drag - contact.force * contact.patch.normal;
    const contact::Spread& spread = contact.wide.vertices.empty() ? contact.load : contact.wide;
    const std::vector<Vec3>& pushes = contact.nodal.push;
    for (std::size_t k = 0; k < spread.vertices.size(); ++k) {
      const int node = mesh.nodes[static_cast<std::size_t>(spread.vertices[k])];
      if (node >= 0)
        push(node, pushes.empty()
                       ? Vec3(spread.shares[k] * whole)
                       : Vec3(spread.shares[k] * contact.drag + contact.force * pushes[k]));
    }
  }
}

}  // namespace palpate::run
