// Tissue properties from a measured curve: estimates, intervals, and unknowns that are not
// separately identifiable.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "identify/scenario_curve.h"

namespace palpate::identify {

enum class Noise {
  constant,  // the same standard deviation at all points
  relative,  // proportional to the value, but at least that of a hundredth of the largest value
};

struct IdentifyOptions {
  Noise noise = Noise::constant;
  int searches = 3;         // from different starts
  bool model_error = true;  // the intervals contain the stated error of the model
  bool profiles = true;     // computes profile likelihoods and the sensitivity to the contact point
};

// The result for one unknown, SI. An empty optional means that the value was not determined.
struct Identified {
  Unknown unknown;
  double u = 0.0;            // at the best fit
  bool inseparable = false;  // the data do not determine this unknown by itself
  bool at_bound = false;     // the best fit is on the edge of its range
  double estimate = 0.0;     // the best fit; needed for inseparable unknowns too, to
                             // repeat the curve
  std::optional<double> std_error;
  std::optional<double> ci95_low, ci95_high;        // Student's t, docs/theory.md [interval]
  std::optional<double> profile_low, profile_high;  // nothing: the interval is open on this side
  bool by_profile = false;                          // trusted() returns the profile's interval
  std::optional<double> moved_down, moved_up;  // change if x = 0 moves down, up by contact_shift
};

// A combination of inseparable unknowns that the data determine: E / (1 - nu^2), a
// product of powers or, if a lower bound is not positive, a weighted sum.
struct Combination {
  std::string text;             // formula in the keys' names
  std::vector<std::size_t> of;  // indices of the unknowns
  std::string unit;             // of the numbers below
  double estimate = 0.0;
  double std_error = 0.0;
  double ci95_low = 0.0, ci95_high = 0.0;
  std::vector<double> gradient;  // over u, of the combination or, if it is a product, its logarithm
  bool product = false;
  std::vector<double> exponents =
      {};  // of a product of powers, as `of`; they are those near the best fit
};

struct ProfilePoint {
  std::size_t unknown = 0;  // index
  double value = 0.0;       // SI
  double squares = 0.0;     // least sum of squared weighted residuals at this value
  double delta = 0.0;       // its excess over that of the best fit, in variances of the noise
};

// What the uncertainty of a given number adds to the standard error of each unknown.
struct GivenPart {
  std::string key, value, deviation;  // as text, with unit
  std::vector<double> deviations;     // one per unknown, SI
};

// What belongs to a single curve.
struct CurveFit {
  CurveKind kind = CurveKind::force_travel;
  scenario::Scenario scenario;  // whole loading history, every `auto` resolved, with the estimates
  scenario::Model taken = scenario::Model::hertz;
  bool given = false;                     // the scenario names the model
  std::optional<double> predicted_error;  // estimated relative error of the model at the estimates
  double worst_error = 0.0;               // the largest estimate over the ranges
  bool closed_form = false;
  double rmse = 0.0;                  // SI
  double r2 = 0.0;                    // docs/theory.md [errors]; of several pairs the smallest
  std::optional<double> deep_effect;  // relative change of the force by the deep-press factor
};

// `pairs` is empty for one measurement. For several, each has its own curve, model and scenario
// there, x, measured and model are those of all pairs one after the other, and what belongs to a
// single curve (also contact_shift) is that of the first.
struct Identification : CurveFit {
  std::vector<Identification> pairs;
  std::vector<Identified> unknowns;
  std::vector<Combination> combinations;
  std::vector<double> correlation;         // row by row; NaN for unknowns that are not separately
                                           // identifiable or at a bound
  std::vector<double> x, measured, model;  // SI, of the points used
  std::vector<ProfilePoint> profile;
  double threshold = 0.0;       // of their `delta`, at the ends of the 95 % intervals
  double noise = 0.0;           // standard deviation, SI; relative noise: a ratio
  double rho = 0.0;             // correlation of neighbouring residuals; 0: taken as independent
  double effective_size = 0.0;  // independent points of the same worth
  double durbin_watson = 2.0;
  double contact_shift = 0.0;         // SI of x; moves the contact point for moved_down, moved_up
  int excluded = 0;                   // measured points that were not used
  int evaluations = 0;                // of the model
  std::vector<GivenPart> givens;      // in the order of `--given`
  std::vector<std::string> notes;     // sentences
  std::vector<std::string> warnings;  // sentences
};

// The pairs of a joint identification, or the only one itself.
[[nodiscard]] std::vector<const Identification*> views(const Identification& found);

// A measurement, the scenario of its test, and the path of the measured file.
struct Pair {
  const Measurement* measured = nullptr;
  const scenario::Family* family = nullptr;
  std::string file = {};
};

// Fits the first case of each pair's family to its measurement, with the unknowns that it has (see
// read_unknowns). Every pair is weighted by the scatter of its own rows, from their second
// differences, but at least 1e-3 of its range. Two moduli that correlate by more than 0.95 are told
// apart only where the pairs change with them by more than their models' stated errors.
//                                                                      docs/theory.md [told_apart]
[[nodiscard]] Identification identify(const std::vector<Pair>& pairs,
                                      const std::vector<Unknown>& unknowns,
                                      const IdentifyOptions& options = {});

// Fits the family's first case to the measurement, on one thread and deterministically. Throws
// InputError for fewer points than unknowns plus one, a constant curve, an unknown that changes
// nothing in the chosen model, ranges in which the scenario cannot be run, a best fit at the edge
// of all ranges, and data that determine nothing; Stopped or InputError once stopped.
[[nodiscard]] Identification identify(const Measurement& measured, const scenario::Family& family,
                                      const std::vector<Unknown>& unknowns,
                                      const IdentifyOptions& options = {});

// Repeats the search with each given a standard deviation lower and higher, and widens the
// intervals of the unknowns: the variance of an estimate grows by the square of half the difference
// (docs/theory.md [givens]). The parts are kept in Identification::givens. `family` has the values
// set.
void carry_givens(Identification& found, const Measurement& measured,
                  const scenario::Family& family, const std::vector<Given>& givens, Noise noise);

}  // namespace palpate::identify
