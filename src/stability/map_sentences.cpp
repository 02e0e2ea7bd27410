// The findings of a map as sentences: limits, agreement with theory, failures.
#include <algorithm>
#include <cmath>
#include <functional>

#include "base/text.h"
#include "base/units.h"
#include "scenario/words.h"
#include "stability/survey.h"

namespace palpate::stability {
namespace {

std::string micro(double seconds) { return rounded_text(1e6 * seconds, 4) + " us"; }

const LimitRow* find(const Survey& survey, const std::string& axis, const std::string& integrator,
                     const std::string& damping, std::optional<double> value = {}) {
  const std::string rung = scenario::rung(survey.rung.model).word;
  const std::string volume = scenario::words::word(scenario::words::volumes, survey.rung.volume);
  for (const LimitRow& row : survey.map.limits)
    if (row.axis == axis && row.integrator == integrator && row.damping == damping &&
        row.rung == rung && row.volume == volume && (!value || row.value == value))
      return &row;
  return nullptr;
}

std::string limits_sentence(const Survey& survey) {
  const scene::TimePlan& plan = survey.own->scene.specimen->plan;
  const LimitRow* free = find(survey, "rung", "central_difference", "none");
  std::string text = std::string(scenario::rung(survey.rung.model).word) + " with volume `" +
                     scenario::words::word(scenario::words::volumes, survey.rung.volume) + "`, " +
                     std::to_string(survey.own->nodes()) + " nodes: ";
  if (free == nullptr || !free->measured || !free->theory) return text + "no limit was measured.";
  return text + "central differences are stable below " + micro(*free->measured) +
         " (2 / omega_max is " + micro(*free->theory) + "); by default " +
         std::to_string(plan.substeps) + (plan.substeps == 1 ? " step of " : " steps of ") +
         micro(plan.substep) + (plan.substeps == 1 ? " is" : " are") + " taken every " +
         rounded_text(1e3 * plan.time_step) + " ms.";
}

std::string agreement_sentence(const Survey& survey) {
  int count = 0;
  double worst = 0.0;
  int unlimited = 0;
  for (const LimitRow& row : survey.map.limits) {
    if (row.rung == "device") continue;
    if (!row.theory) {
      if (!row.measured) ++unlimited;
      continue;
    }
    if (!row.measured) continue;
    ++count;
    worst = std::max(worst, std::abs(*row.measured / *row.theory - 1.0));
  }
  return std::to_string(count) + " measured limits lie within " + percent_text(worst) +
         " of theory; " + std::to_string(unlimited) +
         " trials of methods without a limit were stable at 1000 times 2 / omega_max.";
}

std::string first_to_fail(const Survey& survey) {
  const LimitRow* shortest = nullptr;
  const std::string rung = scenario::rung(survey.rung.model).word;
  for (const LimitRow& row : survey.map.limits)
    if (row.axis == "rung" && row.rung == rung && row.measured && row.theory &&
        (shortest == nullptr || *row.measured < *shortest->measured))
      shortest = &row;
  if (shortest == nullptr) return {};
  return "First to fail as the step grows: `" + shortest->integrator + "` with `" +
         shortest->damping + "` (volume `" + shortest->volume + "`), at " +
         micro(*shortest->measured) + ".";
}

// The number of explicit steps that the stiffest tissue requires.
std::string stiffest_sentence(const Survey& survey) {
  const LimitRow* stiffest = nullptr;
  for (const LimitRow& row : survey.map.limits)
    if (row.axis == "young_modulus_Pa" && row.measured) stiffest = &row;
  if (stiffest == nullptr) return {};
  const double steps = std::ceil(1e-3 / (0.9 * *stiffest->measured));
  return "At " + pressure_text(*stiffest->value) + " an explicit method takes " +
         rounded_text(steps) +
         " steps per millisecond; an implicit one takes as many as its accuracy requires.";
}

// The change of the limit from the first to the last row of an axis.
std::string axis_sentence(const Survey& survey, const std::string& axis, const std::string& name,
                          const std::function<std::string(double)>& text) {
  const LimitRow* low = nullptr;
  const LimitRow* high = nullptr;
  for (const LimitRow& row : survey.map.limits) {
    if (row.axis != axis || row.integrator != "central_difference" || !row.measured) continue;
    if (low == nullptr) low = &row;
    high = &row;
  }
  if (low == nullptr || high == low) return {};
  return name + " from " + text(*low->value) + " to " + text(*high->value) +
         " changes the limit from " + micro(*low->measured) + " to " + micro(*high->measured) + ".";
}

std::string device_sentence(const Survey& survey) {
  const auto spring = contact_spring(*survey.own);
  if (!spring) return {};
  return "On a haptic device: the stiffness of the contact at the deepest travel, " +
         rounded_text(spring->stiffness) + " N/m, requires a device damping of " +
         rounded_text(contact::needed_damping(spring->stiffness, {})) +
         " N s/m at frames of 1 ms (K T / 2).";
}

std::string failures_sentence(const Survey& survey) {
  std::vector<std::string> seen;
  std::vector<std::string> not_seen;
  for (const FailureRow& row : survey.map.failures) {
    auto& list = row.reached ? seen : not_seen;
    if (std::find(list.begin(), list.end(), failure_word(row.failure)) == list.end())
      list.emplace_back(failure_word(row.failure));
  }
  std::erase_if(not_seen, [&](const std::string& word) {
    return std::find(seen.begin(), seen.end(), word) != seen.end();
  });
  std::string text = "Failures shown: " + joined(seen, ", ") + ".";
  if (!not_seen.empty()) text += " Not reached here: " + joined(not_seen, ", ") + ".";
  return text;
}

}  // namespace

std::vector<std::string> map_sentences(const Survey& survey) {
  std::vector<std::string> all{
      limits_sentence(survey),
      agreement_sentence(survey),
      first_to_fail(survey),
      axis_sentence(survey, "young_modulus_Pa", "Young's modulus", pressure_text),
      stiffest_sentence(survey),
      axis_sentence(survey, "contact_stiffness_N_per_m", "An explicit contact's stiffness",
                    [](double value) { return rounded_text(value) + " N/m"; }),
      device_sentence(survey),
      failures_sentence(survey)};
  std::erase_if(all, [](const std::string& text) { return text.empty(); });
  return all;
}

}  // namespace palpate::stability
