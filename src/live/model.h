// The model in a live run: follows any motion of the finger with the same functions as `run`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mechanics/contact_history.h"
#include "mechanics/contacts.h"
#include "mechanics/pressed_mesh.h"
#include "scene/scene.h"

namespace palpate::live {

class LiveModel {
 public:
  // The scene has a finger and outlives the model. Allocates and solves all that follow() needs, as
  // PressedMesh::make_ready() does, which takes seconds on a mesh of thousands of nodes.
  explicit LiveModel(const scene::Scene& scene);

  // Moves the finger in a straight line to `offset` (m, from the position of its first touch, z
  // upwards) until `time` (s, not decreasing). A mesh takes all its steps that end by then; the
  // rest follows in the next call. Returns a sentence if the model diverged or its law does not
  // apply, then and in every later call.
  [[nodiscard]] std::optional<std::string> follow(const Vec3& offset, double time);

  // Returns to the start; the mesh may continue to oscillate. Returns false, and changes nothing,
  // if the forces depend on the motion of the mesh or follow() has failed.
  [[nodiscard]] bool start_again();

  [[nodiscard]] const mechanics::Touch& touch() const { return touch_; }
  // The force on the finger, normal and friction, N.
  [[nodiscard]] Vec3 force() const;
  // The solver step of the mesh, s; 0 without a mesh.
  [[nodiscard]] double step() const { return step_; }
  // EnergyMonitor::imbalance() of the mesh; nothing without a mesh.
  [[nodiscard]] std::optional<double> imbalance();

 private:
  [[nodiscard]] std::optional<std::string> go_to(const Vec3& offset, double time);

  const scene::Scene* scene_;
  std::optional<mechanics::ContactHistory> history_;
  std::optional<mechanics::PressedMesh> mesh_;
  Vec3 first_ =
      Vec3::Zero();  // m, the finger's point at the first touch; without a mesh, the top's
  mechanics::Touch touch_;
  double step_ = 0.0;           // s
  Vec3 offset_ = Vec3::Zero();  // m, of the last call
  double time_ = 0.0;           // s, of the last call
  double begin_ = 0.0;          // s, of the first call
  long long steps_ = 0;         // steps of the mesh since the first call
  bool any_ = false;
  std::optional<std::string> wrong_;
};

// Run time of a frame of the model on this machine.
struct FrameCost {
  double median = 0.0;  // s
  double p99 = 0.0;     // s, 99th percentile
  double force = 0.0;   // N, at the largest displacement of the loading history
};

// Presses the model, which is at its start, to the deepest travel of the scene's loading history in
// 2 `frames` frames of `frame` s; the second half of them is timed.
[[nodiscard]] FrameCost predict_cost(const scene::Scene& scene, LiveModel& model, double frame,
                                     int frames);

}  // namespace palpate::live
