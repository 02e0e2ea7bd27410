// A scenario against a live device: who is there, what would be done, and the run itself.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "run/live_loop.h"

namespace palpate::run {

// Refuses what no device can do: a uniform test, and on a stand a slide or a finger of several
// spheres where the link presses one. Throws InputError with a place in `file`.
void refuse_beyond_device(const scene::Scene& scene, const std::string& file,
                          const LiveOptions& options);

class Live {
 public:
  // Opens the link. Throws LinkError with a diagnosis, InputError where its text is wrong.
  // Scene and options outlive it.
  Live(const scene::Scene& scene, const LiveOptions& options);
  ~Live();
  Live(const Live&) = delete;
  Live& operator=(const Live&) = delete;

  // Sentences: who is there, the limits that hold, what would be done, and what is to be known.
  // Measures the model's cost on this machine. Throws InputError, at `file`, where the model
  // cannot keep the pace of the device, or the programme is predicted beyond the force ceiling, and
  // LinkError where an arm is to be commanded whose hand is inside the tissue.
  [[nodiscard]] std::vector<std::string> plan(const std::string& file);

  // Who is told and what is written while the run goes on, both on another thread.
  struct Output {
    std::function<void(int step)> on_step;                        // that begins, of the programme
    std::function<void(const std::string& sentence)> on_warning;  // of the files, and of gaps
    std::string rows_file;     // force_indentation.csv as it grows; empty: none
    std::string traffic_file;  // likewise, where the traffic is to be kept
  };
  // The run. The record has the rows and device_health.json whatever the end.
  struct Result {
    record::CaseRecord record;
    LiveEnd end;
    std::vector<std::string> warnings;
    bool rows_are_written = false;  // `rows_file` has them all, and is on the disk
  };
  [[nodiscard]] Result go(const std::atomic<bool>& stop, const Output& output);

 private:
  void refuse_inside(std::vector<std::string>& lines);

  const scene::Scene* scene_;
  const LiveOptions* options_;
  device::Clock clock_;
  std::unique_ptr<device::Tap> tap_;  // where the traffic is kept
  std::unique_ptr<LiveModel> model_;  // before the link: what takes long is done when it opens
  device::Link link_;
  FrameCost cost_;
  std::vector<std::string> notes_;
};

}  // namespace palpate::run
