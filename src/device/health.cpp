// Counts the statistics of a link without allocating, and writes them as JSON at the end.
#include "device/health.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "base/words.h"

namespace palpate::device {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinity, so that a missing limit is null.
Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json histogram_json(const LatencyHistogram& histogram) {
  Json json;
  json["count"] = histogram.count();
  json["longest_s"] = histogram.longest();
  json["p50_below_s"] = histogram.quantile(0.5);
  json["p99_below_s"] = histogram.quantile(0.99);
  json["p999_below_s"] = histogram.quantile(0.999);
  Json bins = Json::array();
  for (std::size_t bin = 0; bin < LatencyHistogram::bins; ++bin) {
    if (histogram.counts()[bin] == 0) continue;
    const bool last = bin + 1 == LatencyHistogram::bins;
    bins.push_back(
        {{"below_us", last ? Json(nullptr) : Json(1e6 * LatencyHistogram::upper_end(bin))},
         {"count", histogram.counts()[bin]}});
  }
  json["bins"] = bins;
  return json;
}

Json rules_json(const RuleCounts& rules) {
  return {{"not_finite", rules.not_finite}, {"force_clamped", rules.clamped},
          {"slew_clamped", rules.slewed},   {"stale_frames", rules.stale},
          {"jumps", rules.jumps},           {"too_fast", rules.too_fast},
          {"outside", rules.outside},       {"damped", rules.damped}};
}

constexpr std::array port_texts{"none", "not heard", "heard", "lost"};  // of Events::Port

Json events_json(const Events& events) {
  Json counts = Json::object();
  for (std::size_t i = 0; i < event_kinds; ++i)
    if (events.counts[i] > 0) counts[event_text(static_cast<Event>(i))] = events.counts[i];
  return {{"port", port_texts[as_index(events.port)]}, {"counts", counts}};
}

}  // namespace

void Health::count(double now, const Sample& sample) {
  if (frames == 0) last_fresh_ = now;
  ++frames;
  switch (sample.arrival) {
    case Arrival::fresh:
      ++fresh;
      end_of_samples(now);
      last_fresh_ = now;
      break;
    case Arrival::duplicate: ++duplicates; break;
    case Arrival::dropped: ++dropped; break;
    case Arrival::none:
    case Arrival::lost: ++missing; break;
  }
  const auto fault = as_index(sample.fault);
  if (fault > 0 && fault < faults.size()) ++faults[fault];
}

void Health::end_of_samples(double now) {
  if (frames > 0) longest_gap = std::max(longest_gap, now - last_fresh_);
}

void Health::pass(const Transition& transition) {
  if (transition_count > 0 && state_ == transition.to) return;
  state_ = transition.to;
  if (transition_count < first_kept)
    first_[transition_count] = transition;
  else
    last_[(transition_count - first_kept) % last_kept] = transition;
  ++transition_count;
}

std::vector<Transition> Health::transitions() const {
  const auto count = [&](std::size_t most) { return std::min(transition_count, most); };
  std::vector<Transition> kept(first_.begin(), first_.begin() + count(first_kept));
  for (std::size_t i = std::max(first_kept + last_kept, transition_count) - last_kept;
       i < transition_count; ++i)
    kept.push_back(last_[(i - first_kept) % last_kept]);
  return kept;
}

std::vector<std::string> health_warnings(const Health& health) {
  constexpr double most = 0.01;  // of the frames
  std::vector<std::string> sentences;
  const auto warn = [&](std::uint64_t count, const std::string& what) {
    const double share = static_cast<double>(count) / static_cast<double>(health.frames);
    if (health.frames == 0 || share <= most) return;
    sentences.push_back(std::to_string(count) + " of " + std::to_string(health.frames) +
                        " frames, " + rounded_text(100.0 * share, 2) + " %, " + what);
  };
  warn(health.without_sample(),
       "had no new sample; `samples` and `faults` of device_health.json count why: the device is "
       "slower than expected, sends what is no reading, or is used by another program");
  warn(health.rules.stale,
       "were stale, so that the safety rules took the force back or halted the stand; give the run "
       "a free processor and `--realtime`");
  return sentences;
}

std::vector<std::string> event_sentences(const Events& events) {
  std::vector<std::string> sentences;
  if (events.port == Events::Port::lost)
    sentences.emplace_back(
        "the service's events port closed; from then on a brake was detected from the arm's state "
        "only");
  for (std::size_t i = 0; i < event_kinds; ++i) {
    const auto event = static_cast<Event>(i);
    const std::uint64_t count = events.counts[i];
    if (count == 0 || event == Event::other) continue;
    if (event == Event::busy)
      sentences.emplace_back("another session uses the arm (`device-busy`); end it");
    else
      sentences.push_back(std::string("the service reported `") + event_text(event) + "`" +
                          (count > 1 ? ", " + std::to_string(count) + " times" : ""));
  }
  return sentences;
}

std::string health_json(const Identity& identity, const Limits& limits, const Traffic& traffic,
                        const Health& health) {
  Json json;
  json["id"] = identity.id;
  json["model"] = identity.model;
  json["firmware"] = identity.firmware;
  json["dialect"] = identity.dialect;
  json["notes"] = identity.notes;
  json["limits"] = {{"force_N", number(limits.force)},  {"speed_m_per_s", number(limits.speed)},
                    {"low_m", number(limits.low)},      {"high_m", number(limits.high)},
                    {"period_s", limits.period},        {"stale_after_s", limits.stale_after},
                    {"lost_after_s", limits.lost_after}};
  json["traffic"] = {{"sent", traffic.sent},
                     {"received", traffic.received},
                     {"duplicates", traffic.duplicates},
                     {"late", traffic.late},
                     {"unanswered", traffic.unanswered},
                     {"discarded_bytes", traffic.discarded}};
  if (traffic.events.port != Events::Port::none) json["events"] = events_json(traffic.events);
  json["frames"] = health.frames;
  json["deadline_misses"] = health.deadline_misses;
  json["samples"] = {{"fresh", health.fresh},
                     {"duplicate", health.duplicates},
                     {"dropped", health.dropped},
                     {"missing", health.missing}};
  json["frames_without_sample"] = health.without_sample();
  json["longest_gap_s"] = health.longest_gap;
  json["least_energy_J"] = health.least_energy;
  json["rules"] = rules_json(health.rules);
  Json faults = Json::object();
  for (std::size_t i = 1; i < health.faults.size(); ++i)
    if (health.faults[i] > 0) faults[fault_text(static_cast<Fault>(i))] = health.faults[i];
  json["faults"] = faults;
  json["reply"] = histogram_json(traffic.reply);
  json["lateness"] = histogram_json(health.lateness);
  json["compute"] = histogram_json(health.compute);
  Json passed = Json::array();
  for (const Transition& one : health.transitions()) {
    passed.push_back({{"time_s", one.time}, {"state", name_of<LinkState::closed>(one.to)}});
    if (one.why != Trip::none) passed.back()["why"] = trip_text(one.why);
    if (one.fault != Fault::none) passed.back()["fault"] = fault_text(one.fault);
  }
  json["states"] = passed;
  json["state_changes"] = health.transition_count;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace palpate::device
