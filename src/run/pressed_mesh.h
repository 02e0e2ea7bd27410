// The specimen under the finger: what of it moves, how it moves, and how it answers contacts.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/cholesky.h"
#include "run/contact_history.h"
#include "run/contacts.h"
#include "run/crept_load.h"
#include "run/march.h"
#include "run/monitor.h"
#include "run/stepper.h"
#include "tissue/part.h"

namespace palpate::run {

// With `rings`, a part of the specimen around the contact moves and the rest stands at rest; the
// part follows the contact. Nodes that join it start from rest.
class PressedMesh {
 public:
  explicit PressedMesh(const scene::Scene& scene);

  // The next steps have this size, s.
  void set_step(double time_step);

  // From now on, at rest and with its step set, steps allocate nothing while the finger goes
  // anywhere, but for what make_ready() of pressed_mesh.cpp says; `touch` is the one that will be
  // given. Solves for all loads on the skin, which takes seconds on thousands of nodes.
  void make_ready(Touch& touch);

  // One step with the finger's point at `finger` (m) at its end, `time` (s). Returns what is wrong
  // where no balance is found or the motion has left the stable.
  //
  // one_way, and consistent without inertia: the forces follow from the finger alone, because the
  // sinking that Hertz does not know is taken from statics, h = approach - (c - g) F, c the mesh's
  // compliance where it is read and g the half-space's there.
  // consistent with inertia: and by how much the mesh is from its statics under the same loads.
  // series: the forces follow from the mesh as it is, in implicit steps as it will be; resolved
  // (implicit only) likewise, node by node.
  // `history` then makes of the elastic forces what the tissue's viscosity does.
  [[nodiscard]] std::optional<std::string> step(const Vec3& finger, double time,
                                                ContactHistory& history, Touch& touch);

  // The forces of statics at a place of the finger, without moving the mesh; not of series nor
  // resolved.
  [[nodiscard]] bool forces_follow_finger() const;
  [[nodiscard]] std::optional<std::string> try_out(const Vec3& finger, Touch& touch);

  // Where suits_lanes(): the steps of one_way and consistent in two halves. add_step() finds the
  // forces, as step() does, and march() is the steps since the last clear_march().
  void clear_march() { march_.clear(); }
  [[nodiscard]] std::optional<std::string> add_step(const Vec3& finger, double time,
                                                    ContactHistory& history, Touch& touch);
  [[nodiscard]] March& march();

  // One step of the mesh alone, under the forces of `touch`; public for timing.
  [[nodiscard]] std::optional<std::string> move(const Touch& touch);

  // Of all nodes of the specimen, m. Where the mesh is loaded through a wide spread, with what the
  // pressure's own would add in statics.
  [[nodiscard]] integrate::Vector displacement();

  // Whether a tetrahedron has turned inside out.
  [[nodiscard]] bool inverted();

  // The force on the edge of the part that moves, N; 0 for all of the specimen.
  [[nodiscard]] double edge_reaction();

  // EnergyMonitor::imbalance().
  [[nodiscard]] double imbalance();

  [[nodiscard]] const scene::SpringBody& body() const { return *body_; }
  [[nodiscard]] const integrate::State& state();
  [[nodiscard]] MeshAnswer answer() const;
  [[nodiscard]] Contacts& contacts() { return contacts_; }

 private:
  void take(tissue::Part part, const std::vector<int>& start);
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
  bool whole_ = true;            // nothing of the part is its edge
  std::vector<int> skin_nodes_;  // of the part, one a vertex of the skin; -1 outside
  std::optional<scene::SpringBody> body_;
  std::optional<Stepper> stepper_;
  std::optional<EnergyMonitor> monitor_;
  std::optional<Influence> influence_;
  std::optional<Influence> one_tissue_;
  std::optional<Influence> response_;  // of an implicit step, for `consistent` with inertia
  Cholesky factors_;                   // of statics, for `consistent`
  Cholesky one_factors_;               // were the specimen of one tissue
  integrate::State state_;
  integrate::Vector load_;
  integrate::State before_;  // the step
  integrate::Vector load_before_;
  // Room of a step:
  Touch rubbing_, next_;               // with friction alone; what may become the touch
  integrate::Vector drag_load_;        // N, of the first
  integrate::Vector load_after_;       // N
  integrate::Vector further_;          // N, of a load beyond another
  integrate::Vector reached_, moved_;  // m
  integrate::Vector alone_;            // m, of respond()
  std::vector<int> start_;             // nodes that a part is around
  tissue::Reach reach_;                // of it
  March march_;
  double time_step_ = 0.0;
  // Whether frames pass in modes alone, and whether state_ is where these are. docs/theory.md (41)
  bool in_modes_ = false;
  bool shown_ = true;
  double stage_step_ = 0.0;  // s, from one meeting of finger and mesh to the next
  // Where inertia reaches the force:
  bool inertia_;
  CreptLoad crept_;
  double slope_ = 1.0;       // of a force over its elastic one, within a step
  integrate::Vector finer_;  // N: elastic, the pressure's own loads less the wide ones
};

}  // namespace palpate::run
