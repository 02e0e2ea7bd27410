// The model beside a device: it follows any way of the finger with the code that `run` uses.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "run/contact_history.h"
#include "run/contacts.h"
#include "run/pressed_mesh.h"
#include "scene/scene.h"

namespace palpate::run {

class LiveModel {
 public:
  // The scene has a finger and outlives the model. Everything that follow() needs is allocated and
  // solved for here, which takes seconds on a mesh of thousands of nodes; what a mesh allocates in
  // its steps all the same is said at PressedMesh::make_ready().
  explicit LiveModel(const scene::Scene& scene);

  // The finger has gone straight to `offset` (m, from the place of its first touch, z upwards) by
  // `time` (s, from 0, never falling). A mesh takes all its steps that end by then: the rest of the
  // way waits for the next call. Returns what is wrong where the model ends; it stays wrong.
  [[nodiscard]] std::optional<std::string> follow(const Vec3& offset, double time);

  // As at the start, but that the mesh may still swing: only of a model whose forces do not feel
  // that; false otherwise, and where it has gone wrong.
  [[nodiscard]] bool start_again();

  [[nodiscard]] const Touch& touch() const { return touch_; }
  // N, on the finger: normal forces and friction.
  [[nodiscard]] Vec3 force() const;
  // s, of a mesh's step; 0 without one.
  [[nodiscard]] double step() const { return step_; }
  // EnergyMonitor::imbalance() of a mesh.
  [[nodiscard]] std::optional<double> imbalance();

 private:
  [[nodiscard]] std::optional<std::string> go_to(const Vec3& offset, double time);

  const scene::Scene* scene_;
  std::optional<ContactHistory> history_;
  std::optional<PressedMesh> mesh_;
  Vec3 first_ =
      Vec3::Zero();  // m, the finger's point at the first touch; without a mesh, the top's
  Touch touch_;
  double step_ = 0.0;           // s
  Vec3 offset_ = Vec3::Zero();  // m, of the last call
  double time_ = 0.0;           // s, of the last call
  double begin_ = 0.0;          // s, of the first call
  long long steps_ = 0;         // of the mesh, since then
  bool any_ = false;
  std::optional<std::string> wrong_;
};

// What a frame of the model costs on this machine, in s.
struct FrameCost {
  double median = 0.0;
  double p99 = 0.0;
  double force = 0.0;                // N, at the deepest travel of the programme
  std::optional<std::string> wrong;  // where the model ends before it
};

// Presses the model, which is at its start, to the deepest travel of the scene's programme in
// `frames` frames of `frame` s, with a clock around each; as many before them are not counted.
[[nodiscard]] FrameCost predict_cost(const scene::Scene& scene, LiveModel& model, double frame,
                                     int frames);

}  // namespace palpate::run
