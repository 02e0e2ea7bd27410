// Speed against accuracy: measures every variant of a scenario in rounds and keeps each result.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "chart/design.h"
#include "chart/history.h"
#include "chart/truth.h"
#include "run/displaced_surface.h"

namespace palpate::chart {

struct ChartOptions {
  int repeats = 5;      // largest number of timings of a variant
  double budget = 2.0;  // s, for all timings of a variant; the first is made in any case
  double again = 15.0;  // s, for all timings of the chart but the first ones
  // s, for one run or one set-up; longer ones are not run. Half of it where there are several
  // cases.
  double longest = 6.0;
};

// One timing, s, by the steady clock; not reproducible.
struct Timing {
  double build = 0.0;      // building the scene
  double first_row = 0.0;  // until the first row after the start: factorisations, modes, tables
  double whole = 0.0;      // the whole loading history
};

enum class Status { measured, diverged, cannot, not_run };
[[nodiscard]] constexpr const char* status_word(Status status) {
  return name_of<Status::not_run>(status);
}

struct Measurement {
  Variant variant;
  Status status = Status::cannot;
  std::string note;  // the reason if it was not measured, as a sentence
  // The choices that the variant resulted in; empty if no scene could be built.
  std::string model, coupling, integrator, rings;
  double substep = 0.0;  // s, of the solver; 0 without a mesh
  int substeps = 0;      // per time step
  int nodes = 0, tetrahedra = 0;
  double simulated = 0.0;               // s, duration of the loading history
  double first_simulated = 0.0;         // s, until its first row
  std::optional<Deviation> error;       // from the reference
  std::optional<Deviation> time_error;  // from exact_in_time(), on the same mesh
  double time_floor = 0.0;              // error of exact_in_time(), relative
  std::optional<double> surface_error;  // run::surface_error()
  std::vector<Timing> timings;

  // One number per timing: run time per simulated time without the set-up, us per ms; set-up (build
  // and first row), s; build and whole run, s.
  [[nodiscard]] std::vector<double> costs() const;
  [[nodiscard]] std::vector<double> setups() const;
  [[nodiscard]] std::vector<double> totals() const;
};

struct CaseChart {
  std::string name;
  double tolerance = 0.05;
  Truth truth;
  double reference_error = 0.0;   // largest error of the truth over its moments, relative
  run::SurfaceReference surface;  // without pieces: no configuration has a surface_error
  std::vector<Measurement> rows;  // in the order of design()
};

struct ChartProgress {
  std::string what;
  int done = 0, all = 0;            // timings of all cases; skipped ones count as done
  std::optional<double> left = {};  // s, estimated from the timings made
};

class Journal;

// Measures all cases in rounds of one timing per variant, so that a slow minute of the machine
// affects all variants alike. Measurements in the journal are not repeated. Errors and their order
// do not depend on the clock, but whether a variant near the limits of `options` is run does.
// Throws Stopped, and like find_truth().
[[nodiscard]] std::vector<CaseChart> measure(const Asked& asked, const ChartOptions& options,
                                             Journal& journal,
                                             const std::function<void(const ChartProgress&)>& told);

}  // namespace palpate::chart
