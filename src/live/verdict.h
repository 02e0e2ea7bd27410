// Whether the force that a live run measured agrees with the model, and what explains it if not.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "record/record.h"
#include "scenario/scenario.h"

namespace palpate::live {

// Columns of a live run in SI units; `travel`, `model` and `measured` are equally long.
struct MeasuredCurve {
  std::vector<double> time = {};      // s; empty: rows are taken at a constant rate
  std::vector<double> travel = {};    // m, of the device below the surface, as measured
  std::vector<double> model = {};     // N, computed at that travel
  std::vector<double> measured = {};  // N, compression positive; NaN where nothing was measured
  std::vector<double> free = {};      // N, readings out of contact before the first row
  double asked = 0.0;                 // m, deepest travel of the loading history; 0: none is asked
};

// The columns of a record until a time (s), with the readings before its loading history and the
// deepest travel of `steps`.
[[nodiscard]] MeasuredCurve measured_curve(const record::CaseRecord& record,
                                           const std::vector<scenario::Step>& steps,
                                           std::span<const double> free, double until);

// Explanations of a difference.
enum class Cause {
  no_specimen,      // nothing is measured where the model presses
  wrong_sign,       // the gauge shows compression as negative
  wrong_tare,       // the gauge shows a force out of contact
  wrong_surface,    // the specimen begins at another travel
  wrong_stiffness,  // the specimen's force is a multiple of the model's
  outliers,         // a few readings are far off, the others agree
  drift,            // the gauge's zero moves during the run
  friction,         // a force along the motion adds on the way in and takes on the way out
  lag,              // the force is shown late
  lost_force,       // from a time on the gauge shows no force
  overload,         // the gauge shows no more than a largest force
  short_press,      // the press ends above the travel that the loading history asks for
  noise,            // the gauge scatters so much that less could not be told
};

struct Verdict {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  enum class Outcome { agrees, differs, not_judged };
  Outcome outcome = Outcome::not_judged;
  // Together they explain a difference. With an agreement: `noise` or `outliers`, or none.
  std::vector<Cause> causes = {};
  bool explained = false;    // whether they do so within what is allowed
  bool sure = false;         // and leave too little for another cause beside them
  std::size_t outliers = 0;  // readings that are far off

  double peak = 0.0;            // N, largest force of the model
  double difference = unknown;  // N, root mean square of measured minus model, over all rows
  double allowed = unknown;     // N, for that difference
  double offset = unknown;      // N, measured before contact
  double noise = unknown;       // N, standard deviation of a reading
  double drift = unknown;       // N, measured after contact minus before it
  double stiffness =
      unknown;               // measured over model, by least squares; below 0 if the sign is turned
  double surface = unknown;  // m, by which the specimen lies below the assumed surface
  double friction = unknown;  // N
  double lag = unknown;       // s
  double lost_at = unknown;   // s, from which on no force is shown
  double ceiling = unknown;   // N, the largest force that is shown
  double deepest = 0.0;       // m, of the travel
  double asked = 0.0;         // m, by the loading history
  // Energy lost in the press over energy put in.
  double hysteresis = unknown, hysteresis_model = unknown;
  // m, travel at which the force begins and ends: where F^(2/3), extrapolated, is zero.
  double contact = unknown, contact_model = unknown;
  double release = unknown, release_model = unknown;

  [[nodiscard]] bool has(Cause cause) const;
};

// Judges a run: measured and model agree if the root mean square of their difference is at most
// `tolerance` times the model's largest force, or twice the noise of the gauge if that is more, and
// the press was as deep as asked. A difference is explained by the one cause that leaves the least
// of it, if that is within what is allowed, or by a tare and another cause; it is not sure if it
// leaves more than half of that. A turned sign and a short press are seen by themselves. A value
// that the columns do not determine is NaN.
[[nodiscard]] Verdict judge(const MeasuredCurve& curve, double tolerance);

// One line for people, without a full stop.
[[nodiscard]] std::string verdict_sentence(const Verdict& verdict);

// The same as findings, with the names of docs/results.md; nothing that is NaN.
[[nodiscard]] std::vector<record::Finding> verdict_findings(const Verdict& verdict);

}  // namespace palpate::live
