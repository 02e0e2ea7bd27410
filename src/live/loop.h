// Options, context and result shared by the loops of a stand, an arm and a gauge; the model that
// follows any motion of the finger with the same functions as `run`; and the rows of a loop, which
// another thread collects and writes to the disk.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "base/files.h"
#include "base/vec3.h"
#include "device/clock.h"
#include "device/health.h"
#include "device/link.h"
#include "device/safety.h"
#include "device/tap.h"
#include "mechanics/contact_history.h"
#include "mechanics/contacts.h"
#include "mechanics/pressed_mesh.h"
#include "record/record.h"
#include "scenario/scenario.h"
#include "scene/scene.h"

namespace palpate::live {

// A file that grows during a live run; errors are kept as a sentence and do not end the run.
class LiveFile {
 public:
  // The file is created by the first append(). With an empty path nothing is ever written.
  explicit LiveFile(std::string path);

  // Appends whole lines of `text`, which ends with a line feed, and returns how many bytes were
  // written. For a second after a failure it writes nothing and returns 0.
  std::size_t append(std::string_view text);
  // Flushes written text to the disk, at most once a second.
  void sync_when_due();
  // Flushes it now.
  void sync();
  // After a failure, lets the next append() try at once.
  void try_again() { next_try_ = {}; }

  // The first error, as `force_indentation.csv cannot be written: No space left on device`, if any.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }
  [[nodiscard]] bool named() const { return !path_.empty(); }

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] std::size_t next_piece(std::string_view text) const;
  void fail(const std::string& why);

  std::string path_;
  std::unique_ptr<GrowingFile> file_;
  std::size_t size_ = 0;  // bytes
  std::string trouble_;
  bool dirty_ = false;  // some text is not on the disk yet
  Clock::time_point next_sync_{};
  Clock::time_point next_try_{};
};

struct LogRow {
  record::ContactRow contact;
  record::MeasuredRow measured;
};

struct LogPlan {
  // A CSV file with the columns of force_indentation.csv that receives every row during the run;
  // empty: rows are kept in memory only.
  std::string rows_file = {};
  std::string case_name = {};  // for the column `case`
  record::Table (*table)(const std::vector<record::CaseRecord>&) = record::contact_table;
  // The traffic to write to `traffic_file`, or null; outlives the log.
  device::Tap* tap = nullptr;
  std::string traffic_file = {};  // CSV: `time_s,way,bytes`, one line per write or read
  // Called with a sentence if a file cannot be written, once per file, on the log's thread, and in
  // finish() if rows or traffic were lost.
  std::function<void(const std::string&)> on_trouble = {};
  // If the disk is slower than the loop: with a device the loop drops the row; in lock-step and
  // with a recording, for which nothing waits, the loop waits for the disk.
  enum class WhenFull { drop, wait };
  WhenFull when_full = WhenFull::drop;
};

// The loop pushes rows, and a second thread collects them; the loop waits only with WhenFull::wait.
class LiveLog {
 public:
  static constexpr std::size_t capacity = 32768;  // rows: half a minute at 1 kHz
  // With WhenFull::wait, rows that are not yet in the file, unless writing failed.
  static constexpr std::size_t lead = 1000;

  // `on_step` is called on the log's thread when a row belongs to another step than the one before.
  explicit LiveLog(std::function<void(int step)> on_step, LogPlan plan = {});
  ~LiveLog();
  LiveLog(const LiveLog&) = delete;
  LiveLog& operator=(const LiveLog&) = delete;

  void push(const LogRow& row) {  // allocates nothing
    if (plan_.when_full == LogPlan::WhenFull::wait) wait_for_room();
    (void)ring_->push(row);
    ++pushed_;
  }
  // Ends the thread and returns all rows in order. Call once.
  [[nodiscard]] std::vector<LogRow> finish();
  // After finish(): whether all rows are in the file and on the disk, and the file never failed.
  [[nodiscard]] bool rows_are_written() const { return written_; }
  // After finish(): all sentences passed to on_trouble.
  [[nodiscard]] const std::vector<std::string>& troubles() const { return troubles_; }
  [[nodiscard]] std::uint64_t dropped() const { return ring_->dropped(); }

 private:
  bool collect();
  bool collect_traffic();
  bool collect_rows();
  bool write_rows();
  void tell(std::string sentence);
  void wait_for_room() const;
  void work();

  using Rows = device::Ring<LogRow, capacity>;
  std::unique_ptr<Rows> ring_ = std::make_unique<Rows>();
  std::function<void(int)> on_step_;
  LogPlan plan_;
  LiveFile rows_file_;
  LiveFile traffic_file_;
  std::vector<std::string> troubles_;
  bool rows_told_ = false;     // an error of the file of rows was reported
  bool traffic_told_ = false;  // likewise; no more traffic is written then
  std::string bytes_;          // the parts so far of one write or read
  double first_time_ = -1.0;   // s, wire time of the first part; negative: none yet
  std::vector<LogRow> rows_;
  bool has_header_ = false;                // the header is in the file of rows
  std::size_t in_file_ = 0;                // number of `rows_` in the file
  std::vector<record::CaseRecord> piece_;  // one record, with the rows being written
  std::uint64_t pushed_ = 0;               // rows, counted by the loop
  std::atomic<std::uint64_t> done_ = 0;    // rows written, or kept in memory where writing failed
  int step_ = 0;
  bool written_ = false;
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

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
