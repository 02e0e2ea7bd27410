// `palpate device`: identifies a device, reports the rate of its samples, or stops it.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "cli/interrupt.h"
#include "cli/program.h"
#include "cli/verbs.h"
#include "device/health.h"
#include "device/link.h"

namespace palpate::cli {
namespace {

using Json = nlohmann::ordered_json;
using device::Arrival;

constexpr double patience = 1.0;     // s without a fresh sample before the session ends
constexpr double probe_time = 0.5;   // s, duration of a probe
constexpr double shown_every = 0.2;  // s between lines of a monitor

const char* kind_text(device::Kind kind) {
  switch (kind) {
    case device::Kind::stand: return "stand with force gauge";
    case device::Kind::arm: return "haptic arm";
    case device::Kind::gauge: return "gauge on a serial line";
    case device::Kind::recording: return "recording";
  }
  return "unknown";
}

std::string in_mm(double metres) { return rounded_text(1e3 * metres, 6) + " mm"; }

std::string or_none(const std::string& text) { return text.empty() ? "unknown" : text; }

std::string sample_text(const device::Sample& sample) {
  std::string text = "position";
  for (int axis = 0; axis < 3; ++axis) text += " " + rounded_text(1e3 * sample.position[axis]);
  text += " mm";
  if (std::isfinite(sample.force)) text += ", force " + rounded_text(sample.force) + " N";
  return text;
}

Json sample_json(double time, const device::Sample& sample) {
  Json json{{"event", "sample"},
            {"time_s", time},
            {"position_m", {sample.position.x(), sample.position.y(), sample.position.z()}},
            {"velocity_m_per_s", {sample.velocity.x(), sample.velocity.y(), sample.velocity.z()}}};
  if (std::isfinite(sample.force)) json["force_N"] = sample.force;
  if (sample.fault != device::Fault::none) json["fault"] = device::fault_text(sample.fault);
  return json;
}

struct Session {
  device::Health health;
  device::LatencyHistogram reply;  // s
  device::Sample last;             // the last fresh sample
  double span = 0.0;               // s, duration
  device::Fault ended_by = device::Fault::none;
};

// Reads samples for `time` s with the period of the link; an arm answers to zero forces.
Session read(device::Link& link, device::Clock& clock, double time, const Talk* talk,
             const std::atomic<bool>& stop) {
  Session session;
  const double begin = clock.now();
  double next = begin;
  double shown = begin - shown_every;
  double heard = begin;
  const double period = link.limits().period;
  while (clock.now() - begin < time && !stop) {
    const device::Sample sample = link.sample(std::max(period, 0.02));
    const double now = clock.now();
    session.health.count(now - begin, sample);
    if (sample.arrival == Arrival::fresh) {
      session.last = sample;
      heard = now;
    }
    session.ended_by = sample.fault;
    if (sample.arrival == Arrival::lost) break;
    session.ended_by = device::Fault::silent;
    if (now - heard > patience) break;
    session.ended_by = device::Fault::none;
    if (talk != nullptr && sample.arrival == Arrival::fresh && now - shown >= shown_every) {
      shown = now;
      talk->progress(sample_text(sample));
      if (talk->json()) print(sample_json(now - begin, sample).dump() + "\n");
    }
    next = std::max(next + period, now);
    clock.sleep_until(next);
  }
  session.span = clock.now() - begin;
  session.health.end_of_samples(session.span);
  session.reply = link.traffic().reply;
  return session;
}

double rate_of(const Session& session) {
  return session.span > 0.0 ? static_cast<double>(session.health.fresh) / session.span : 0.0;
}

std::vector<std::string> sentences(const device::Link& link) {
  const device::Identity& who = link.identity();
  const device::Limits& limits = link.limits();
  std::vector<std::string> lines{std::string("kind      ") + kind_text(who.kind),
                                 "id        " + or_none(who.id), "model     " + or_none(who.model),
                                 "firmware  " + or_none(who.firmware),
                                 "speaks    " + or_none(who.dialect)};
  if (std::isfinite(limits.low) && std::isfinite(limits.high))
    lines.push_back("travel    " + in_mm(limits.low) + " to " + in_mm(limits.high));
  if (std::isfinite(limits.speed))
    lines.push_back("speed     " + in_mm(limits.slowest) + "/s to " + in_mm(limits.speed) + "/s");
  return lines;
}

std::string rate_sentence(const Session& session) {
  const device::Health& health = session.health;
  return "rate      " + rounded_text(rate_of(session), 3) + " samples/s; reply p50 below " +
         rounded_text(1e3 * session.reply.quantile(0.5), 3) + " ms, p99 below " +
         rounded_text(1e3 * session.reply.quantile(0.99), 3) + " ms, longest gap " +
         rounded_text(1e3 * health.longest_gap, 3) + " ms; " + std::to_string(health.dropped) +
         " dropped, " + std::to_string(health.duplicates) + " duplicate, " +
         std::to_string(health.missing) + " missing";
}

// The fault that most of the samples had, as a clause.
std::string most_frequent(const device::Health& health) {
  const auto most = std::ranges::max_element(health.faults);
  return *most == 0 ? "nothing came"
                    : std::string(device::fault_text(
                          static_cast<device::Fault>(most - health.faults.begin())));
}

int stop(const Device& command, const Talk& talk) {
  if (device::only_reads(device::parse_link(command.link)))
    throw InputError({"device stop", 0, 0},
                     "wants a device that moves, got `" + command.link +
                         "`; give the link of the stand, as `mark10:/dev/ttyUSB0`");
  device::Clock clock(device::Clock::Kind::monotonic);
  device::Link link(command.link, device::Purpose::stop, clock);
  if (!link.stop())
    throw LinkError("palpate: `" + command.link +
                    "`: the stop was sent, and the device did not confirm it; use its own stop");
  talk.say(command.link + ": the device confirms that it stands still");
  talk.event("stop", {{"link", command.link}});
  return exit_good;
}

}  // namespace

int perform(const Device& command, const Arguments&, const Talk& talk) {
  if (command.act == Device::Act::stop) return stop(command, talk);
  device::Clock clock(device::Clock::Kind::monotonic);
  const std::atomic<bool>& stop = listen_for_interrupts(exit_interrupted);
  device::Link link(command.link, device::Purpose::look, clock);
  const bool monitor = command.act == Device::Act::monitor;
  if (!talk.json()) {
    for (const std::string& line : sentences(link)) print(line + "\n");
    for (const std::string& note : link.identity().notes) print("note      " + note + "\n");
  }
  const Session session =
      read(link, clock, monitor ? command.seconds : probe_time, monitor ? &talk : nullptr, stop);
  talk.progress("");
  link.stop();
  if (talk.json()) {
    Json json = Json::parse(
        device::health_json(link.identity(), link.limits(), link.traffic(), session.health));
    Json event{{"event", monitor ? "monitor" : "probe"},
               {"link", command.link},
               {"kind", kind_text(link.identity().kind)},
               {"rate_per_s", rate_of(session)}};
    if (link.identity().kind == device::Kind::gauge) event["lines"] = link.heard();
    event.update(json);
    print(event.dump() + "\n");
  } else {
    if (session.health.fresh > 0) print("now       " + sample_text(session.last) + "\n");
    print(rate_sentence(session) + "\n");
    for (const std::string& line : link.heard()) print("line      " + line + "\n");
  }
  if (stop) return exit_interrupted;
  // The end of a recording is not a fault. A link that gives no sample at all does not work.
  if (session.ended_by == device::Fault::recording_ended) return exit_good;
  if (session.ended_by == device::Fault::none && session.health.fresh == 0 &&
      session.health.frames > 0) {
    Talk::error("palpate: `" + command.link + "`: 0 samples of " +
                std::to_string(session.health.frames) + ": " + most_frequent(session.health) +
                "; look at what it sends with `palpate run ... --traffic`, and at its settings");
    return exit_device;
  }
  if (session.ended_by != device::Fault::none) {
    Talk::error("palpate: `" + command.link +
                "`: " + std::string(device::fault_text(session.ended_by)) +
                "; check that the device is switched on and its cable is plugged in");
    return exit_device;
  }
  talk.next(monitor ? "run SCENARIO --device" : "device monitor", command.link);
  return exit_good;
}

}  // namespace palpate::cli
