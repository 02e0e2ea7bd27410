// A meshed specimen under the finger: its moving part, and the coupling that presses it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mechanics/couplings.h"

namespace palpate::mechanics {

// With `solver.rings`, only a part of the specimen around the contact moves, and this part follows
// the contact. Nodes that join the part start from rest.
class PressedMesh {
 public:
  explicit PressedMesh(const scene::Scene& scene);

  // Sets the size of the next steps, s.
  void set_step(double time_step);

  // Allocates and solves beforehand, so that steps with `touch` allocate nothing wherever the
  // finger goes; its definition lists the exceptions. Call at rest, after set_step(). Solves for
  // all loads on the surface, which takes seconds on thousands of nodes.
  void make_ready(Touch& touch);

  // One step, at the end of which, `time` (s), the finger's point is at `finger` (m). Returns a
  // sentence if the contact equations have no solution or the motion is unstable.
  // The types of couplings.h say from what the forces follow.
  [[nodiscard]] std::optional<std::string> step(const Vec3& finger, double time,
                                                ContactHistory& history, Touch& touch);

  // Whether the forces depend on the finger's position alone.
  [[nodiscard]] bool forces_follow_finger() const;
  // Computes the contacts of statics at a finger position (m) without moving the mesh; for
  // `one_way` and `consistent`.
  [[nodiscard]] std::optional<std::string> try_out(const Vec3& finger, Touch& touch);

  // The mesh's error in what it sinks under such a contact, per tetrahedron of the moving part,
  // m/N; for `consistent`.                                      docs/theory.md [compliance]
  [[nodiscard]] std::vector<double> errors(const SphereContact& contact);

  // One step of the mesh alone, under the forces of `touch`; public for timing.
  [[nodiscard]] std::optional<std::string> move(const Touch& touch) { return part_.move(touch); }

  // The displacement of all nodes of the specimen, m. Where the mesh is loaded through wide
  // patches, the static difference to the actual patches is added, docs/theory.md [inertia].
  [[nodiscard]] integrate::Vector displacement();

  // Whether a tetrahedron is inverted.
  [[nodiscard]] bool inverted();

  // The magnitude of the force on the fixed edge of the moving part, N; 0 if the whole moves.
  [[nodiscard]] double edge_reaction();

  // EnergyMonitor::imbalance(); nothing where steps keep only the load, without energies.
  [[nodiscard]] std::optional<double> imbalance();

  // Whether steps keep only the load, and displacement() is computed from it on request.
  [[nodiscard]] bool keeps_load_alone() const { return part_.still; }
  // Whether displacement() and inverted() solve equations by iterations, which takes long.
  [[nodiscard]] bool shows_slowly() const;
  // The largest estimated error of equations solved by iterations, in the energy norm; else 0.
  [[nodiscard]] double solution_error();

  // `count` modes are kept. `dropped_share` is the static displacement of the dropped modes under
  // the finger over its travel, 0 if the mesh's motion does not reach the force.
  //                                                               docs/theory.md [lowest_modes]
  struct KeptModes {
    Eigen::Index count = 0;
    double dropped_share = 0.0;
  };
  [[nodiscard]] std::optional<KeptModes> kept_modes(const Touch& touch);

  [[nodiscard]] const scene::SpringBody& body() const { return *part_.body; }
  [[nodiscard]] const integrate::State& state();
  [[nodiscard]] const MovingPart& part() const { return part_; }

 private:
  [[nodiscard]] Consistent* statics();  // null for the other couplings
  void follow(const Touch& touch);
  [[nodiscard]] integrate::Vector of_specimen(const integrate::Vector& of_part) const;

  MovingPart part_;
  SurfaceContacts outer_surface_;
  Coupling coupling_;
  std::vector<int> start_;  // nodes around which the part is chosen
  tissue::Reach reach_;     // of that part
};

}  // namespace palpate::mechanics
