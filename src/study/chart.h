// Speed against accuracy: every variant of a scenario measured, in rounds, with what was measured
// kept at once.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "study/chart_design.h"
#include "study/chart_history.h"
#include "study/chart_reference.h"

namespace palpate::study {

struct ChartOptions {
  int repeats = 5;       // timings of every variant, at most
  double budget = 2.0;   // s, that one variant's timings may take together; one is always made
  double longest = 6.0;  // s, of one run or one set-up; what would take longer is not run
};

// One timing, s. All of them come from the steady clock and differ from call to call.
struct Timing {
  double build = 0.0;      // the scene
  double first_row = 0.0;  // a programme of one row: factorisations, modes, tables
  double whole = 0.0;      // the whole programme, with these
};

enum class Status { measured, diverged, cannot, not_run };
[[nodiscard]] const char* status_word(Status status);

struct Measurement {
  Variant variant;
  Status status = Status::cannot;
  std::string note;  // why not, in a sentence
  // What the variant settled on; empty words where nothing was built.
  std::string model, coupling, integrator, rings;
  double substep = 0.0;  // s, of the solver; 0 without a mesh
  int substeps = 0;      // of a time step
  int nodes = 0, tetrahedra = 0;
  double simulated = 0.0;               // s, of the programme
  double first_simulated = 0.0;         // s, of the programme of one row
  std::optional<Deviation> error;       // from the reference
  std::optional<Deviation> time_error;  // from exact_in_time(), on the same mesh
  double time_floor = 0.0;              // that one's own error
  std::vector<Timing> timings;

  // us a simulated ms, of the run without its set-up, in every timing.
  [[nodiscard]] std::vector<double> costs() const;
  [[nodiscard]] std::vector<double> setups() const;  // s: build, and what the first row prepares
  [[nodiscard]] std::vector<double> totals() const;  // s: build and run
};

struct CaseChart {
  std::string name;
  double tolerance = 0.05;
  Truth truth;
  double reference_error = 0.0;   // the truth's own, the greatest over its moments
  std::vector<Measurement> rows;  // in the order of design()
};

struct ChartProgress {
  std::string what;
  int done = 0, all = 0;            // timings, of all cases; those that the budget forbids are done
  std::optional<double> left = {};  // s, by those that were made
};

class Journal;

// Measures all cases, one round of timings after the other, so that a slow minute of the machine
// strikes all variants alike. What the journal holds is not measured again. Nothing where `stop`
// was set before the end. Errors and their order do not depend on the clock; timings do, and
// whether a variant near the limits of `options` is run.
// Throws what find_truth() throws.
[[nodiscard]] std::optional<std::vector<CaseChart>> measure(
    const Asked& asked, const ChartOptions& options, Journal& journal,
    const std::atomic<bool>& stop, const std::function<void(const ChartProgress&)>& told);

}  // namespace palpate::study
