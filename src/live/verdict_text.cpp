// A verdict in words, and as findings.
#include <array>
#include <cmath>

#include "base/text.h"
#include "live/verdict.h"

namespace palpate::live {
namespace {

// A number that is only rounding is 0: no gauge has a nanometre or a nanonewton.
std::string text_of(double number, int digits = 2) {
  return rounded_text(std::abs(number) < 1e-6 ? 0.0 : number, digits);
}
std::string force_text(double force) { return text_of(force, 3) + " N"; }
std::string millinewtons(double force) { return text_of(1e3 * force) + " mN"; }
std::string length_text(double length) { return text_of(1e3 * length) + " mm"; }
std::string percent(double share) { return text_of(100.0 * share) + " %"; }

// In the order of Cause.
constexpr std::array names{
    "no_specimen", "wrong_sign",  "wrong_tare", "wrong_surface", "wrong_stiffness",
    "outliers",    "drift",       "friction",   "lag",           "lost_force",
    "overload",    "short_press", "noise"};
static_assert(names.size() == static_cast<std::size_t>(Cause::noise) + 1);

// What is wrong, and what to do about it.
std::string cause_clause(Cause cause, const Verdict& verdict) {
  switch (cause) {
    case Cause::no_specimen:
      return "no specimen: nothing is measured where the model has " + force_text(verdict.peak) +
             "; put it under the finger, or give its height by `--surface`";
    case Cause::wrong_sign:
      return "wrong sign: the gauge shows compression as negative; change its polarity (IPOL), or "
             "the way it is mounted";
    case Cause::wrong_tare:
      return "wrong tare: the gauge shows " + force_text(verdict.offset) +
             " out of contact; zero it out of contact";
    case Cause::wrong_surface:
      return "wrong surface: the specimen begins " + length_text(std::abs(verdict.surface)) +
             (verdict.surface > 0.0 ? " lower" : " higher") +
             " than assumed; give its height by `--surface`, or leave the option out";
    case Cause::wrong_stiffness:
      return "another stiffness: the specimen's force is " +
             rounded_text(std::abs(verdict.stiffness), 3) +
             " times the model's; `palpate identify` estimates its properties, if the gauge's unit "
             "is "
             "right";
    case Cause::outliers:
      return "outliers: " + std::to_string(verdict.outliers) +
             (verdict.outliers == 1 ? " reading is" : " readings are") +
             " far off, and all others agree; look for a loose cable";
    case Cause::drift:
      return "drift: the gauge's zero moves by " + millinewtons(verdict.drift) +
             " during the run; let it warm up, and zero it out of contact";
    case Cause::friction:
      return "friction: " + millinewtons(verdict.friction) +
             " along the motion, added on the way in and taken off on the way out; see what "
             "rubs";
    case Cause::lag:
      return "lag: the force is shown " + text_of(1e3 * verdict.lag) +
             " ms late; shorten the gauge's filter, or press slower";
    case Cause::lost_force:
      return "lost force: from " + text_of(verdict.lost_at, 3) +
             " s on the gauge does not follow the press; look at its cable";
    case Cause::overload:
      return "overload: the gauge shows no more than " + force_text(verdict.ceiling) +
             "; take one with a larger range, or press less deep";
    case Cause::short_press:
      return "short press: it ends at " + length_text(verdict.deepest) + " of " +
             length_text(verdict.asked) + "; press to the displacement that the scenario asks for";
    case Cause::noise:
      return "noise: the gauge scatters by " + millinewtons(verdict.noise) +
             ", and a smaller difference cannot be told; use a gauge of a smaller range, or its "
             "filter";
  }
  return {};
}

// Two numbers side by side, or the reason why there are none.
std::string beside_model(double measured, double model, std::string (*text)(double)) {
  return (std::isfinite(measured) ? text(measured) : "unknown") + " (model " +
         (std::isfinite(model) ? text(model) : "unknown") + ")";
}

}  // namespace

std::string verdict_sentence(const Verdict& verdict) {
  if (verdict.outcome == Verdict::Outcome::not_judged)
    return "measured and model are not compared, because no row has both a measured force and a "
           "force of the model";
  std::string text = verdict.outcome == Verdict::Outcome::agrees ? "measured and model agree: "
                                                                 : "measured and model differ: ";
  text += millinewtons(verdict.difference) + " rms, " + percent(verdict.difference / verdict.peak) +
          " of " + force_text(verdict.peak) + " (" + percent(verdict.allowed / verdict.peak) +
          " allowed)";
  if (std::isfinite(verdict.offset))
    text += ", " + millinewtons(verdict.offset) + " before contact";
  text += verdict.stiffness < 0.0 ? ", sign -" : ", sign +";
  if (std::isfinite(verdict.drift)) text += ", drift " + millinewtons(verdict.drift);
  if (std::isfinite(verdict.hysteresis_model))
    text += ", hysteresis " + beside_model(verdict.hysteresis, verdict.hysteresis_model, percent);
  text += ", contact at " + beside_model(verdict.contact, verdict.contact_model, length_text);
  if (std::isfinite(verdict.release_model))
    text += ", release at " + beside_model(verdict.release, verdict.release_model, length_text);
  for (const Cause cause : verdict.causes) text += "; " + cause_clause(cause, verdict);
  if (verdict.outcome == Verdict::Outcome::differs && !verdict.explained)
    text += "; no single fault of gauge, stand or specimen explains it";
  else if (!verdict.sure)
    text +=
        "; that leaves more than half of what is allowed, so that it cannot be told from "
        "another relaxation of the specimen or from two faults at once";
  return text;
}

std::vector<record::Finding> verdict_findings(const Verdict& verdict) {
  using Outcome = Verdict::Outcome;
  if (verdict.outcome == Outcome::not_judged) return {};
  std::string causes;
  for (const Cause cause : verdict.causes)
    causes += std::string(causes.empty() ? "" : " ") + names[static_cast<std::size_t>(cause)];
  if (!verdict.explained)
    causes += causes.empty() ? "unexplained" : " unexplained";
  else if (!verdict.sure)
    causes += " unsure";
  std::vector<record::Finding> findings;
  findings.push_back({"measured_verdict", verdict.outcome == Outcome::agrees
                                              ? std::string("agrees")
                                              : std::string("differs")});
  if (!causes.empty()) findings.push_back({"measured_causes", causes});
  const auto add = [&](const char* what, double value) {
    if (std::isfinite(value)) findings.push_back({what, value});
  };
  add("measured_difference_N", verdict.difference);
  add("measured_difference", verdict.difference / verdict.peak);
  add("measured_allowed", verdict.allowed / verdict.peak);
  add("measured_offset_N", verdict.offset);
  add("measured_noise_N", verdict.noise);
  add("measured_drift_N", verdict.drift);
  add("measured_stiffness", verdict.stiffness);
  add("measured_surface_mm", 1e3 * verdict.surface);
  add("measured_hysteresis", verdict.hysteresis);
  add("model_hysteresis", verdict.hysteresis_model);
  add("measured_contact_mm", 1e3 * verdict.contact);
  add("model_contact_mm", 1e3 * verdict.contact_model);
  add("measured_release_mm", 1e3 * verdict.release);
  add("model_release_mm", 1e3 * verdict.release_model);
  return findings;
}

}  // namespace palpate::live
