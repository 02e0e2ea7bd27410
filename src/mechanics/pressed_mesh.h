// A meshed specimen under the finger: its moving part, its state, and its steps with contact.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/cholesky.h"
#include "mechanics/body_sinking.h"
#include "mechanics/contact_history.h"
#include "mechanics/contacts.h"
#include "mechanics/crept_load.h"
#include "mechanics/monitor.h"
#include "mechanics/stepper.h"
#include "tissue/part.h"

namespace palpate::mechanics {

// With `solver.rings`, only a part of the specimen around the contact moves, and this part follows
// the contact. Nodes that join the part start from rest.
class PressedMesh {
 public:
  explicit PressedMesh(const scene::Scene& scene);

  // Sets the size of the next steps, s.
  void set_step(double time_step);

  // Allocates and solves beforehand, so that steps with `touch` allocate nothing wherever the
  // finger goes; ready_mesh.cpp lists the exceptions. Call at rest, after set_step(). Solves for
  // all loads on the skin, which takes seconds on thousands of nodes.
  void make_ready(Touch& touch);

  // One step, at the end of which, `time` (s), the finger's point is at `finger` (m). Returns a
  // sentence if the contact equations have no solution or the motion is unstable. The forces follow
  // - for `one_way`, and `consistent` without inertia, from the finger's position alone: in
  //   h = approach - C F with the C of statics, docs/theory.md (13);
  // - for `consistent` with inertia, also from the mesh's deviation from its static displacement;
  // - for `series`, from the mesh's displacement at the start (explicit) or end (implicit steps);
  // - for `resolved` (implicit steps only), likewise, node by node.
  // For `consistent` and `one_way`, `history` then converts elastic to viscoelastic forces.
  [[nodiscard]] std::optional<std::string> step(const Vec3& finger, double time,
                                                ContactHistory& history, Touch& touch);

  // Whether the forces depend on the finger's position alone.
  [[nodiscard]] bool forces_follow_finger() const;
  // Computes the contacts at a finger position (m) without moving the mesh; in that case only.
  [[nodiscard]] std::optional<std::string> try_out(const Vec3& finger, Touch& touch);

  // The mesh's error in what it sinks under such a contact, per tetrahedron of the moving part,
  // m/N; for `consistent`.                                              docs/theory.md (12)
  [[nodiscard]] std::vector<double> errors(const SphereContact& contact);

  // One step of the mesh alone, under the forces of `touch`; public for timing.
  [[nodiscard]] std::optional<std::string> move(const Touch& touch);

  // The displacement of all nodes of the specimen, m. Where the mesh is loaded through wide
  // patches, the static difference to the actual patches is added, docs/theory.md (74).
  [[nodiscard]] integrate::Vector displacement();

  // Whether a tetrahedron is inverted.
  [[nodiscard]] bool inverted();

  // The magnitude of the force on the fixed edge of the moving part, N; 0 if the whole moves.
  [[nodiscard]] double edge_reaction();

  // EnergyMonitor::imbalance().
  [[nodiscard]] double imbalance();

  [[nodiscard]] const scene::SpringBody& body() const { return *body_; }
  [[nodiscard]] const integrate::State& state();
  [[nodiscard]] MeshAnswer answer() const;
  [[nodiscard]] Contacts& contacts() { return contacts_; }

 private:
  void take(tissue::Part part);
  void set_stage(double duration);
  void follow(const Touch& touch);
  [[nodiscard]] std::optional<std::string> step_freely(const Vec3& finger, ContactHistory& history,
                                                       Touch& touch);
  [[nodiscard]] std::optional<std::string> step_in_series(const Vec3& finger, Touch& touch);
  [[nodiscard]] std::optional<std::string> step_with_inertia(const Vec3& finger,
                                                             ContactHistory& history, Touch& touch);
  [[nodiscard]] std::optional<std::string> meet(const Vec3& finger, MovingMesh moving,
                                                ContactHistory& history, Touch& touch);
  template <class Linearised>
  [[nodiscard]] std::optional<std::string> step_implicitly(Linearised& method, const Vec3& finger,
                                                           ContactHistory& history, Touch& touch);
  [[nodiscard]] std::optional<std::string> step_in_modes(integrate::Modal& method,
                                                         const Vec3& finger,
                                                         ContactHistory& history, Touch& touch);
  void factor();
  void show();
  void find_drag_load(const Touch& touch);
  void respond(const integrate::Vector& unit, integrate::Vector& moved);
  [[nodiscard]] integrate::Vector of_specimen(const integrate::Vector& of_part) const;
  template <class Linearised>
  [[nodiscard]] std::optional<std::string> balance(Linearised& method, const Vec3& finger,
                                                   Touch& touch);

  const scene::Scene* scene_;
  const scene::Specimen* specimen_;
  Contacts contacts_;
  tissue::Part part_;
  std::vector<int> skin_nodes_;  // node of the part, one per vertex of the skin; -1 outside
  std::optional<scene::SpringBody> body_;
  std::optional<Stepper> stepper_;
  std::optional<EnergyMonitor> monitor_;
  std::optional<Influence> influence_;
  std::optional<BodySinking> beyond_;  // for `consistent`
  std::optional<Influence> response_;  // of an implicit step, for `consistent` with inertia
  Cholesky factors_;                   // of the static stiffness, for `consistent`
  bool factored_ = false;
  integrate::State state_;
  integrate::Vector load_;         // N
  integrate::State before_;        // at the start of the step
  integrate::Vector load_before_;  // N, at the start of the step
  // Temporaries of a step:
  Touch rubbing_, next_;               // with friction alone; of the current linearisation
  integrate::Vector drag_load_;        // N, of rubbing_
  integrate::Vector load_after_;       // N
  integrate::Vector further_;          // N, a difference or mean of loads
  integrate::Vector reached_, moved_;  // m, without and with the contact forces
  integrate::Vector alone_;            // m, of respond()
  std::vector<int> start_;             // nodes around which the part is chosen
  tissue::Reach reach_;                // of that part
  double time_step_ = 0.0;             // s
  // Whether steps are computed in modal coordinates alone, and whether state_ is up to date with
  // them.                                                                    docs/theory.md (41)
  bool in_modes_ = false;
  bool shown_ = true;
  double stage_step_ = 0.0;  // s, from one solution of the contacts to the next
  // Where inertia reaches the force:
  bool inertia_;
  CreptLoad crept_;
  double slope_ = 1.0;       // derivative of a force with respect to its elastic one, in a step
  integrate::Vector finer_;  // N, Contacts::finer_load()
};

}  // namespace palpate::mechanics
