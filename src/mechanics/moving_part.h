// The moving part of a meshed specimen: its body, its state, its loads and its steps.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/symmetric_solver.h"
#include "integrate/implicit.h"
#include "mechanics/contacts.h"
#include "mechanics/monitor.h"
#include "mechanics/stepper.h"
#include "tissue/network.h"

namespace palpate::mechanics {

// The response to a load: static; static, of the kept modes alone; at the end of one implicit or
// modal step, in which the load grows linearly; or at the end of a modal step with a constant load.
enum class Response { statics, moving_statics, step, whole_step };

// With `solver.rings` only nodes around the contact move; otherwise the part is the whole specimen.
// Its members refer to each other: a part is neither copied nor moved.
struct MovingPart {
  // The part around the first touch. The scene must outlive it.
  explicit MovingPart(const scene::Scene& whole);
  MovingPart(const MovingPart&) = delete;
  MovingPart& operator=(const MovingPart&) = delete;

  // Makes `next` the moving part. Nodes and springs that were in the previous part too keep their
  // state; other nodes start from rest. Returns the previous number of every degree of freedom, or
  // -1 for new ones.
  std::vector<Eigen::Index> take(tissue::Part next);

  // Sets the size of the next steps, s.
  void set_step(double size);

  // One step under the forces of `touch`. Returns a sentence if its equations have no solution.
  [[nodiscard]] std::optional<std::string> move(const Touch& touch);

  // The displacement (m) that a load (N) adds.
  void respond(Response response, const integrate::Vector& load, integrate::Vector& moved);
  // The same for several loads at once, of a response in statics.
  void respond(Response response, std::span<const integrate::Vector> loads,
               std::span<integrate::Vector> moved);
  // Adds the static displacement under `equivalent_load` (N) of the modes that modal steps do not
  // keep.
  void add_dropped(const integrate::Vector& equivalent_load, integrate::Vector& moved);
  // Whether the responses of a step serve all steps of one size.
  [[nodiscard]] bool keeps_responses() const;

  // Computes `state`, and in modal steps the energies, if steps leave this to be done on request.
  void show();

  [[nodiscard]] int node_of(int vertex) const { return nodes[as_index(vertex)]; }
  [[nodiscard]] Eigen::Index freedoms() const { return state.displacement.size(); }

  const scene::Scene* scene;
  tissue::Part part;
  std::vector<int> nodes;  // of the part, one per vertex of the surface; -1: outside
  std::optional<scene::SpringBody> body;
  std::optional<Stepper> stepper;
  std::optional<EnergyMonitor> monitor;
  integrate::State state;
  integrate::Vector load;         // N
  integrate::State before;        // at the start of the step
  integrate::Vector load_before;  // N, at the start of the step
  integrate::Vector other_load;   // N, a temporary
  integrate::Vector unloaded;     // m, a temporary
  SymmetricSolver statics;        // of the stiffness at rest, when first needed
  double time_step = 0.0;         // s
  // How a step moves a linear body on whose motion the forces do not depend: in modal coordinates
  // alone [modes], or, without inertia, by keeping only the load whose static displacement it is.
  bool in_modes = false;
  bool still = false;
  // This load, if `still`, or if modal steps drop modes that follow it without inertia.
  std::optional<integrate::EquivalentLoad> equivalent;
  bool shown = true;  // whether `state` is up to date
};

// The forces of the contacts on the part, N; of their friction alone; and the forces without
// viscosity over the actual patches minus those over the wide patches, whose sum is 0.
void contact_load(const Touch& touch, const MovingPart& part, integrate::Vector& load);
void drag_load(const Touch& touch, const MovingPart& part, integrate::Vector& load);
void finer_load(const Touch& touch, const MovingPart& part, integrate::Vector& load);

}  // namespace palpate::mechanics
