// The properties behind a measured curve: estimates, what they are worth, and what cannot be told.
#pragma once

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "fit/box_search.h"
#include "fit/scenario_curve.h"

namespace palpate::fit {

enum class Noise {
  constant,  // one standard deviation for all points
  relative,  // one in proportion to the value, but no less than a hundredth of the largest
};

struct IdentifyOptions {
  Noise noise = Noise::constant;
  Slopes slopes = Slopes::automatic;
  int searches = 3;      // from different starts
  bool profiles = true;  // intervals by the profile likelihood, and contact-point sensitivity
};

// Of one unknown, SI. Nothing where nothing is known.
struct Identified {
  Unknown unknown;
  double u = 0.0;         // at the best fit
  bool tied = false;      // not determined by itself: no number stands for it
  bool at_bound = false;  // the best fit is on the edge of its range
  double estimate = 0.0;  // the best fit, of tied ones too: it repeats the curve
  std::optional<double> std_error;
  std::optional<double> ci95_low, ci95_high;        // Student's t by the slopes at the best fit
  std::optional<double> profile_low, profile_high;  // nothing: open within the range
  bool by_profile = false;                          // the profile is the interval to trust
  std::optional<double> moved_down, moved_up;  // SI, what the estimate changes by where the contact
                                               // point, or time's zero, lies earlier or later
};

// A product of powers, or E / (1 - nu^2), that the data determine where its parts are tied.
struct Combination {
  std::string text;             // with the keys' names
  std::vector<std::size_t> of;  // unknowns
  std::string unit;
  double estimate = 0.0;  // in that unit
  double std_error = 0.0;
  double ci95_low = 0.0, ci95_high = 0.0;
};

struct ProfilePoint {
  std::size_t unknown = 0;
  double value = 0.0;    // SI
  double squares = 0.0;  // least sum of squared residuals there, the others free; y's unit^2
  double delta = 0.0;    // over that of the best fit, in variances of the noise
};

struct Identification {
  CurveKind kind = CurveKind::force_travel;
  scenario::Scenario scenario;            // the whole programme, `auto` answered, estimates put in
  bool given = false;                     // the scenario named the model
  std::optional<double> predicted_error;  // of the model at the estimates, a ratio
  double worst_error = 0.0;               // and the worst over the ranges
  bool closed_form = false;
  bool automatic_slopes = false;
  std::vector<Identified> unknowns;
  std::vector<Combination> combinations;
  std::vector<double> correlation;  // of the determined unknowns, row by row, NaN for tied ones
  std::vector<double> x, measured, model;  // SI, of the points used
  std::vector<ProfilePoint> profile;
  double rmse = 0.0;  // SI
  double r2 = 0.0;
  double noise = 0.0;  // standard deviation, SI; relative: a ratio
  double durbin_watson = 2.0;
  double runs_z = 0.0;         // standard deviations of the number of runs from its mean
  double contact_shift = 0.0;  // SI of x, by which the contact point was moved
  int left_out = 0;
  int evaluations = 0;                // runs of the model
  std::vector<std::string> notes;     // sentences
  std::vector<std::string> warnings;  // sentences
};

// Fits the family's first case to the measurement. Deterministic, serial. Throws InputError where
// the data cannot answer at all: fewer points than unknowns, a constant curve, a key that changes
// nothing in the chosen model, nothing that is determined.
[[nodiscard]] Identification identify(const Measurement& measured, const scenario::Family& family,
                                      const std::vector<Unknown>& unknowns,
                                      const std::atomic<bool>& stop,
                                      const IdentifyOptions& options = {});

}  // namespace palpate::fit
