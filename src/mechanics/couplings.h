// The couplings of contact and mesh (`contact.coupling`), one type each.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "integrate/implicit.h"
#include "mechanics/body_surface_displacement.h"
#include "mechanics/contact_history.h"
#include "mechanics/influence.h"
#include "mechanics/resolved_contact.h"
#include "mechanics/surface_contacts.h"

namespace palpate::mechanics {

// The mesh's motion in a step, under the load
//   share (F_past + slope (F_elastic - F_elastic,past)).
struct Motion {
  const integrate::Vector& displacement;  // m, at the step's end without the forces to be found
  const integrate::Vector& still;         // N, its static displacement is subtracted; may be empty
  bool still_has_past = false;            // `still` contains the past elastic forces
  double share = 0.0;                     // 0 in explicit steps, whose end the forces do not reach
  double slope = 1.0;
  double time_step = 0.0;  // s
};

class ContactInertia {
 public:
  // The part must outlive this.
  explicit ContactInertia(MovingPart& part);

  // s of [inertia]: the mean displacement of the surface under a contact's wide patch, m.
  [[nodiscard]] double sunk(const integrate::Vector& displacement,
                            const SphereContact& contact) const;

  // Finds the motion under the contacts and their past; call before solving the equations.
  void begin(const Motion& motion, const KeptList<SphereContact>& contacts);
  // Changes the approaches (m) and gives the compliance (m/N), so that the equations have the form
  // of statics, whose compliance is `known`.
  const Eigen::MatrixXd& complete(const Motion& motion, const KeptList<SphereContact>& contacts,
                                  const Eigen::MatrixXd& known, std::vector<double>& approaches);
  // Removes the contact with the largest tensile force, which arises where the tissue falls behind
  // a finger that leaves. Returns whether there was one.
  [[nodiscard]] bool release(const Motion& motion, KeptList<SphereContact>& contacts);
  // Sets the contacts' forces and stiffnesses, and stores them as the past of the next step.
  void remember(const Motion& motion, const Eigen::MatrixXd& known,
                KeptList<SphereContact>& contacts);
  // Replaces the stored forces by those of `touch`, after viscosity.
  void keep_forces(const Touch& touch);

  void make_room(std::size_t contacts);

  Influence statics;   // c_ij and the static displacement of [inertia]
  Influence response;  // of the step

 private:
  struct Past {  // a contact at the end of the previous step
    int sphere = 0;
    Vec3 position = Vec3::Zero();        // m
    double approach = 0.0, depth = 0.0;  // m
    double spread = 0.0;                 // N, the delayed load Q of docs/theory.md [radiation]
    double elastic = 0.0, force = 0.0;   // N
  };
  struct NearField {
    Past past;
    double damping = 0.0;  // N s/m, C_L of docs/theory.md [radiation]
    double delay = 0.0;    // s, T of docs/theory.md [radiation]
  };
  [[nodiscard]] double sunk_by(Influence& by, const SphereContact& own,
                               const SphereContact& pressed) const;
  [[nodiscard]] double sunk_by(const integrate::Vector& load, const SphereContact& own);
  void find_near_field(const Motion& motion, const KeptList<SphereContact>& contacts,
                       const Eigen::MatrixXd& known, double part);
  [[nodiscard]] double part_of_motion(const KeptList<SphereContact>& contacts,
                                      const Eigen::MatrixXd& known) const;
  template <class Matrix>
  void damp(double time_step, const Eigen::MatrixXd& known, std::vector<double>& approaches);

  const MovingPart* part_;
  double radiation_;          // m s/N, D of docs/theory.md [radiation]
  double return_time_;        // s, of a shear wave through the body and back
  std::vector<int> pressed_;  // degrees of freedom under the wide patches
  // Only the leading entries, one per contact, are valid; the memory is kept between steps.
  Eigen::VectorXd motion_;            // m, `m` of docs/theory.md [inertia]
  Eigen::MatrixXd moving_by_force_;   // m/N, response at the end of the step
  Eigen::MatrixXd still_by_force_;    // m/N, static response c_ij of docs/theory.md [inertia]
  Eigen::MatrixXd whole_compliance_;  // m/N, with the terms of the mesh's motion
  Eigen::VectorXd softness_;          // m/N, diagonal of whole_compliance_ before damp()
  std::vector<NearField> near_;
  std::vector<Past> past_;
  std::vector<Past> parted_;  // contacts that release() removed in this step
};

// A step, or a stage of TR-BDF2, as every coupling's step() takes it.
struct StepTo {
  Vec3 finger;              // m, its point at the end
  double duration;          // s
  ContactHistory& history;  // makes elastic forces viscoelastic; not used by FromMesh
  Touch& touch;
};

// What every coupling has. A coupling defines again the functions in which it has something to do.
class OnMesh {
 public:
  // Both must outlive this.
  OnMesh(SurfaceContacts& contacts, MovingPart& moving) : outer_surface(&contacts), part(&moving) {}

  // Whether the forces follow from the finger's position alone.
  static constexpr bool follows_finger = false;
  // Call when another part moves; `from` is what MovingPart::take() returned.
  void begin_part(const std::vector<Eigen::Index>& /*from*/) {}
  void forget_steps() {}  // call when the size of the steps changes
  void make_ready() {}    // allocates and solves what later steps need

 protected:
  SurfaceContacts* outer_surface;
  MovingPart* part;
};

// `one_way`: h = approach.
class OneWay : public OnMesh {
 public:
  using OnMesh::OnMesh;
  static constexpr bool follows_finger = true;
  // The contacts of the finger at `finger` (m), without moving the mesh.
  [[nodiscard]] std::optional<std::string> find(const Vec3& finger, Touch& touch);
  [[nodiscard]] std::optional<std::string> step(const StepTo& to);
};

// `consistent` in statics: h = approach - C F.                        docs/theory.md [energy]
class Consistent : public OnMesh {
 public:
  Consistent(SurfaceContacts& contacts, MovingPart& moving) : OnMesh(contacts, moving) {
    begin_part({});
  }
  static constexpr bool follows_finger = true;
  [[nodiscard]] std::optional<std::string> find(const Vec3& finger, Touch& touch);
  [[nodiscard]] std::optional<std::string> step(const StepTo& to);
  void begin_part(const std::vector<Eigen::Index>& from);
  void make_ready();

  // Fills `compliance` (m/N) and the contacts' factors and errors of [energy].
  void find_surface_displacement(Touch& touch, Eigen::MatrixXd& compliance);
  [[nodiscard]] BodySurfaceDisplacement* body() { return &*beyond_; }
  // The error of the surface displacement under a contact per tetrahedron of the part, m/N.
  [[nodiscard]] std::vector<double> errors(const SphereContact& contact);
  // SymmetricSolver::error() of the surface displacement.
  [[nodiscard]] double solution_error() const { return beyond_->solution_error(); }
  // Stores finer_load() of `touch`; displacement() of the part (m) adds its static displacement.
  void load_finely(const Touch& touch) { finer_load(touch, *part, finer_); }
  [[nodiscard]] integrate::Vector displacement();

 private:
  [[nodiscard]] contact::Patch joint_patch(const Touch& touch);

  std::optional<BodySurfaceDisplacement> beyond_;  // of the present part
  integrate::Vector finer_;                        // N
};

// `consistent` where inertia reaches the force, which then also follows from the mesh's deviation
// from its static displacement.                                      docs/theory.md [inertia]
class ConsistentWithInertia : public OnMesh {
 public:
  ConsistentWithInertia(SurfaceContacts& contacts, MovingPart& moving);
  [[nodiscard]] std::optional<std::string> step(const StepTo& to);
  void begin_part(const std::vector<Eigen::Index>& from);
  void forget_steps() { inertia_.response.forget(); }
  void make_ready();

  // The load whose static displacement a mesh without inertia would have now, N.
  [[nodiscard]] const integrate::Vector& equivalent_load() const {
    return equivalent_.load().size() > 0 ? equivalent_.load() : part->load;
  }

  Consistent statics;

 private:
  [[nodiscard]] std::optional<std::string> find(const Motion& motion, const StepTo& to);
  [[nodiscard]] std::optional<std::string> meet(const integrate::Vector& displacement, double share,
                                                const StepTo& to);
  template <class Linearised>
  [[nodiscard]] std::optional<std::string> step_with(Linearised& method, const StepTo& to);
  void set_stage(double duration);

  ContactInertia inertia_;
  integrate::EquivalentLoad equivalent_;
  double stage_ = 0.0;                 // s, from one solution of the contacts to the next
  double slope_ = 1.0;                 // Motion::slope
  integrate::Vector drag_, acting_;    // N, of friction; during the step
  integrate::Vector reached_, moved_;  // m, without and with the contact forces
};

// Forces and displacement agree at the end of implicit and modal steps, and forces follow from the
// displacement in explicit steps.
class FromMesh : public OnMesh {
 public:
  FromMesh(SurfaceContacts& contacts, MovingPart& moving)
      : OnMesh(contacts, moving), influence(moving, Response::step) {}
  void begin_part(const std::vector<Eigen::Index>& /*from*/) { influence.forget(); }
  void forget_steps() { influence.forget(); }
  void make_ready();

 protected:
  // find(displacement in m, touch) finds the contacts: in explicit steps with the displacement at
  // the end, in others with that without their forces, which act by `influence`.
  template <class Find>
  [[nodiscard]] std::optional<std::string> step_by(integrate::MemoryRule rule, const Find& find,
                                                   Touch& touch);
  Influence influence;

 private:
  template <class Linearised, class Find>
  [[nodiscard]] std::optional<std::string> balance(Linearised& method, integrate::MemoryRule rule,
                                                   const Find& find, Touch& touch);

  Touch next_;                         // of the current linearisation
  integrate::Vector drag_, further_;   // N
  integrate::Vector reached_, moved_;  // m, before and after it
};

// `series`: h = approach to the displaced surface. In explicit steps over the patches of the
// previous step, which change by less than a step's travel.
class Series : public FromMesh {
 public:
  using FromMesh::FromMesh;
  [[nodiscard]] std::optional<std::string> step(const StepTo& to);

 private:
  void find_surface_displacement(const KeptList<SphereContact>& contacts,
                                 Eigen::MatrixXd& compliance);
};

// `resolved`: node by node, in implicit steps only.
class Resolved : public FromMesh {
 public:
  Resolved(SurfaceContacts& contacts, MovingPart& moving)
      : FromMesh(contacts, moving), contact_(moving) {}
  [[nodiscard]] std::optional<std::string> step(const StepTo& to);

 private:
  ResolvedContact contact_;
};

// The coupling of a scene, chosen once.
using Coupling = std::variant<OneWay, Consistent, ConsistentWithInertia, Series, Resolved>;

}  // namespace palpate::mechanics
