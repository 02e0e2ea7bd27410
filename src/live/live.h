// Runs a scenario with a live device, after describing the device and the plan; and the loading
// history that a stand really carried out.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "live/loop.h"
#include "live/verdict.h"
#include "record/record.h"
#include "scenario/scenario.h"

namespace palpate::live {

// Refuses scenarios that the device cannot carry out: uniform tests and, on a stand, slides. Throws
// InputError with the place `file`.
void refuse_beyond_device(const scene::Scene& scene, const std::string& file,
                          const LiveOptions& options);

class Live {
 public:
  // Opens the link. Throws LinkError with a diagnosis, and InputError if the link's text is wrong.
  // `scene` and `options` outlive the object.
  Live(const scene::Scene& scene, const LiveOptions& options);
  ~Live();
  Live(const Live&) = delete;
  Live& operator=(const Live&) = delete;

  // Sentences that describe the device, its limits, the steps and the model's cost per frame, which
  // is measured on this machine. Throws InputError with the place `file` if the model cannot keep
  // the pace of the device or the force predicted for a stand exceeds the ceiling, and LinkError if
  // an arm is to be commanded while the hand is inside the tissue.
  [[nodiscard]] std::vector<std::string> plan(const std::string& file);

  // The file of the rows in the result: `force_time.csv` if the device measures no travel, which
  // the model could follow.
  [[nodiscard]] const char* rows_name() const;
  [[nodiscard]] bool measures_force() const { return link_.limits().measures_force; }

  // Callbacks and files of a run, which another thread calls and writes.
  struct Output {
    std::function<void(const std::string& sentence)> say;         // what the person is to do
    std::function<void(const std::string& sentence)> on_warning;  // errors of files, lost rows
    std::string rows_file;     // the file of rows_name(), written during the run; empty: none
    std::string traffic_file;  // likewise, for LiveOptions::Traffic::kept
  };
  // Carries out the run. The record has the rows and device_health.json however the run ends.
  struct Result {
    record::CaseRecord record;
    LiveEnd end;
    std::optional<Verdict> verdict;  // nothing if the link measures no force
    std::vector<std::string> warnings;
    std::size_t rows = 0;
    bool rows_are_written = false;  // all rows are in `rows_file` and on the disk
  };
  [[nodiscard]] Result go(const std::atomic<bool>& stop, const Output& output);

 private:
  [[nodiscard]] std::string step_sentence(int step) const;
  void refuse_inside(std::vector<std::string>& lines);

  const scene::Scene* scene_;
  const LiveOptions* options_;
  device::Clock clock_;
  std::unique_ptr<device::Tap> tap_;  // null unless the traffic is kept
  std::unique_ptr<LiveModel> model_;  // before link_, so that its long preparation precedes it
  device::Link link_;
  std::vector<std::string> notes_;
};

// The presses and holds of a loading history up to its first withdrawal, with the rates, travels
// and times of the record. The first step is a hold until the stand sets off. The rate and the ends
// of a motion are those of a line fitted to the readings in its middle, which averages their
// resolution. Nothing without five readings in every motion, and for a run that diverged or was
// stopped.
[[nodiscard]] std::optional<std::vector<scenario::Step>> as_moved(
    const record::CaseRecord& record, const std::vector<scenario::Step>& planned);

}  // namespace palpate::live
