// Options, context and result shared by the loops of a stand, an arm and a gauge, and the model
// that follows any motion of the finger with the same functions as `run`.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/vec3.h"
#include "device/clock.h"
#include "device/health.h"
#include "device/link.h"
#include "device/safety.h"
#include "live/log.h"
#include "mechanics/contact_history.h"
#include "mechanics/contacts.h"
#include "mechanics/pressed_mesh.h"
#include "scenario/scenario.h"
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

constexpr double stepped_wait = 1.0;  // s of wire time, for a reply in lock-step

struct LiveOptions {
  std::string link;
  enum class Act { look, command };
  Act act = Act::look;
  device::Clock::Kind clock = device::Clock::Kind::monotonic;
  enum class Priority { ordinary, realtime };
  Priority priority = Priority::ordinary;
  // m, position of the undeformed surface along the device's z. If empty, a stand feels for it, for
  // an arm it is `below_hand` below the first position of the hand, and for a recording it is 0.
  std::optional<double> surface;
  enum class Traffic { unheard, kept };
  Traffic traffic = Traffic::unheard;
  std::optional<double> most_force;                          // N; empty: the default of the rules
  double longest = std::numeric_limits<double>::infinity();  // s, for the whole run
  static constexpr double below_hand = 0.020;                // m
};

// Readings of the gauge out of contact, before the loading history: the first ones.
struct FreeReadings {
  std::array<double, 256> force{};  // N
  std::size_t count = 0;
  void add(double reading) {  // allocates nothing
    if (count < force.size()) force[count++] = reading;
  }
};

// All objects that a loop uses, created before it starts.
struct LiveLoop {
  const scene::Scene& scene;
  const LiveOptions& options;
  device::Link& link;
  device::Clock& clock;
  LiveModel& model;
  LiveLog& log;
  device::Health& health;
  const std::atomic<bool>& stop;
  std::function<void(const std::string&)> say = {};  // gauge: tells the person at it
  std::uint64_t softened = 0;  // arm: number of frames with a stiffness reduced for passivity
  FreeReadings free = {};      // stand
  double moved_until = std::numeric_limits<double>::infinity();  // gauge: s; then it was waited for
  std::vector<std::string> warnings = {};                        // about what the device showed
  double dropped = 0.0;  // arm: s, time of late frames by which the model was not advanced
};

// How a loop ended.
struct LiveEnd {
  enum class Why {
    done,         // the loading history is over
    too_long,     // LiveOptions::longest, or the end of a recording
    interrupted,  // by a signal
    link,         // lost, or stopped for safety
    model,        // the model diverged or its law does not apply
  };
  Why why = Why::done;
  std::string sentence;  // the reason, without a full stop; may be empty if done
};

// Runs an arm until its person has carried out the loading history: the hand moves, the model
// follows, and the model's force is sent. A recording is followed likewise, without sending.
[[nodiscard]] LiveEnd run_arm(LiveLoop& loop);

// Runs a gauge: a person moves it, and the model follows the travel in its lines. Without travel
// only the forces are written: from the contact on, which Limits::start_force tells, for the time
// that the loading history takes.
[[nodiscard]] LiveEnd run_gauge(LiveLoop& loop);

// Runs a stand: the loading history moves it, and the model follows its measured position.
[[nodiscard]] LiveEnd run_stand(LiveLoop& loop);

// The ceiling of the force, N: LiveOptions::most_force, or the default for this kind of device.
[[nodiscard]] double most_force(const LiveOptions& options, device::Kind kind);

// The end of a run by its link, with a sentence that explains trip and fault.
[[nodiscard]] LiveEnd ended_by_link(device::Trip trip, device::Fault fault);

// State of the finger at one moment.
struct GuidePlace {
  double time = 0.0;           // s
  Vec3 offset = Vec3::Zero();  // m, from the first touch, z upwards
  double force = 0.0;          // N, computed by the model, upwards on the finger
};

class Guide {
 public:
  // `steps` outlive the guide and contain no creep or relaxation.
  explicit Guide(const std::vector<scenario::Step>& steps) : steps_(&steps) {}

  // Advances to a moment, without allocation. An `indent` ends at its travel or force, a `hold`
  // after its time, a `retract` at its travel, a `slide` after its distance; one step per call.
  void pass(const GuidePlace& place);

  [[nodiscard]] int step() const { return step_; }  // counted from 1; at the end, the last one
  [[nodiscard]] bool done() const { return done_; }

 private:
  [[nodiscard]] bool is_over(const GuidePlace& place) const;

  const std::vector<scenario::Step>* steps_;
  int step_ = 1;
  bool done_ = false;
  bool any_ = false;
  GuidePlace begin_;  // at the start of the step
};

// The instruction for a step: "press to 2 mm at about 5 mm/s".
[[nodiscard]] std::string guidance(const scenario::Step& step);

}  // namespace palpate::live
