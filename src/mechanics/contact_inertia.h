// What the mesh's motion adds to the equations of `consistent`: theory.md [inertia], [radiation].
#pragma once

#include <vector>

#include "mechanics/influence.h"

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

  // s of [inertia]: the mean sinking of the surface under a contact's wide patch, m.
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

}  // namespace palpate::mechanics
