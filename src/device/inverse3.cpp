// The arm's conversation: our message is the clock, the newest reply counts.
#include "device/inverse3.h"

#include <algorithm>
#include <cstddef>

#include "base/error.h"
#include "device/events.h"

namespace palpate::device {
namespace {

constexpr double connect_time = 2.0;   // s, for all of it
constexpr double version_time = 1.0;   // s of that, at most
constexpr double events_time = 0.5;    // s of that, at most
constexpr double greeting_time = 0.1;  // s a reply
constexpr int trials = 6;              // replies a spelling has, to leave the idle mode
constexpr double period = 1e-3;        // s: the paper's frame
constexpr double stop_time = 0.02;     // s
constexpr double reply_time = 0.02;    // s, after which a reply is taken for lost
// After a silence of ours the arm is idle once or twice; longer, and it does not do as it is told.
constexpr int most_idle = 3;  // replies
// Of the events a frame; what is more waits for the next one. A whole one is some 200 bytes.
constexpr int most_events = 16;
constexpr std::size_t most_event_bytes = 16384;

}  // namespace

Inverse3::Inverse3(const ArmAddress& address, Purpose purpose, Clock& clock, Tap* tap)
    : clock_(clock),
      purpose_(purpose),
      connected_by_(wire_time() + connect_time),
      host_(look_up(address.host, connected_by_)),
      socket_(host_, address.port, connected_by_) {
  socket_.tap(tap);
  identity_.kind = Kind::arm;
  limits_.takes_force = true;
  limits_.period = period;
  limits_.stale_after = 3.0 * period;
  limits_.lost_after = 0.1;
  listen(address, tap);
  ask_version(address.port);
  greet();
}

Inverse3::~Inverse3() {
  if (!socket_.closed()) send(Vec3::Zero());
}

void Inverse3::listen(const ArmAddress& address, Tap* tap) {
  traffic_.events.port = Events::Port::unheard;
  if (!address.events) {
    identity_.notes.push_back(
        "the service's events are not listened to, as the link says: a brake is noticed by the "
        "arm's state alone, some frames later");
    return;
  }
  try {
    events_.emplace(host_, *address.events, std::min(connected_by_, wire_time() + events_time));
    events_->tap(tap);
    traffic_.events.port = Events::Port::heard;
  } catch (const LinkError&) {
    identity_.notes.push_back("the service's events are not heard, nobody serves them on " +
                              host_.name + ":" + std::to_string(*address.events) +
                              ": a brake is noticed by the arm's state alone, some frames later");
  }
}

void Inverse3::ask_version(int port) {
  const auto version =
      http_get(host_, port, "/version", std::min(connected_by_, wire_time() + version_time));
  identity_.firmware = version ? inverse3::parse_version(*version) : std::string();
  if (identity_.firmware.empty())
    identity_.notes.push_back("the service does not tell its version");
}

void Inverse3::greet() {
  const auto first = socket_.receive(std::max(connected_by_, wire_time() + greeting_time));
  if (first.outcome != WebSocket::Outcome::message)
    throw LinkError(first.outcome == WebSocket::Outcome::closed
                        ? "palpate: " + socket_.why_closed() + " before it said who is there"
                        : "palpate: the service takes the connection but sends no snapshot; is "
                          "this its simulation port (10001)?");
  const auto snapshot = inverse3::parse_snapshot(first.text);
  if (!snapshot)
    throw LinkError(
        "palpate: the service's first message is no JSON; is this its simulation "
        "port (10001)?");
  if (snapshot->arms.empty())
    throw LinkError(
        "palpate: the service runs, but no Inverse3 is there; connect and calibrate "
        "it, and see that no other program owns it");
  identity_.id = snapshot->arms.front().id;
  identity_.model = snapshot->arms.front().model;
  if (snapshot->arms.size() > 1)
    identity_.notes.push_back("of " + std::to_string(snapshot->arms.size()) +
                              " arms the first is used, " + identity_.id);
  if (!snapshot->arms.front().firmware.empty())
    identity_.notes.push_back("the arm's own firmware is " + snapshot->arms.front().firmware);

  // A spelling the service does not know leaves the arm idle.
  using inverse3::Spelling;
  const Spelling expected = inverse3::spelling_of(identity_.firmware);
  const Spelling other = expected == Spelling::vector ? Spelling::values : Spelling::vector;
  if (!try_spelling(expected)) {
    if (!socket_.closed() && try_spelling(other)) {
      identity_.notes.push_back("a force is spelled `" +
                                std::string(inverse3::spelling_text(other)) +
                                "`, against what the service's version says");
    } else {
      spelling_ = expected;
      identity_.notes.push_back(
          "the arm stays idle on a zero force in either spelling; whether it takes forces is not "
          "known");
    }
  }
  if (socket_.closed()) throw LinkError("palpate: " + socket_.why_closed());
  if (gone_)
    throw LinkError("palpate: the service says that the arm " + identity_.id +
                    " was disconnected; connect it again");
  if (traffic_.events.counts[static_cast<std::size_t>(Event::busy)] > 0)
    identity_.notes.push_back("another session uses the arm; end it");
  identity_.dialect = inverse3::spelling_text(spelling_);
}

bool Inverse3::try_spelling(inverse3::Spelling spelling) {
  spelling_ = spelling;
  mode_ = inverse3::Mode::unknown;
  int answers = 0;
  for (int i = 0; i < trials; ++i) {
    const Sample got = sample(greeting_time);
    if (got.arrival == Arrival::lost) return false;
    if (got.arrival == Arrival::none) continue;
    ++answers;
    // The first reply may still speak of the time before.
    if (answers > 1 && mode_ == inverse3::Mode::other) return confirmed_ = true;
  }
  // A service that does not tell the mode gives no reason to doubt.
  if (answers > 0 && mode_ == inverse3::Mode::unknown) return true;
  if (answers == 0)
    throw LinkError("palpate: the service does not answer a zero force for " + identity_.id +
                    "; restart it");
  return false;
}

bool Inverse3::send(const Vec3& force) {
  // In lock-step every message takes a frame.
  if (clock_.kind() == Clock::Kind::stepped) clock_.sleep_until(clock_.now() + period);
  const auto message = inverse3::force_message(identity_.id, spelling_, force);
  if (!socket_.send(message.text())) return false;
  if (!awaiting_) asked_at_ = wire_time();
  awaiting_ = true;
  ++traffic_.sent;
  return true;
}

// What comes unasked is a reply once more.
void Inverse3::pass_over_duplicates() {
  while (!awaiting_ && socket_.receive(0.0).outcome == WebSocket::Outcome::message)
    ++traffic_.duplicates;
}

Sample Inverse3::finished(Arrival arrival, Fault fault) const {
  Sample sample;
  sample.arrival = arrival;
  sample.fault = fault;
  sample.received = clock_.now();
  return sample;
}

Sample Inverse3::read(const WebSocket::Received& message) {
  if (message.binary) return finished(Arrival::dropped, Fault::garbage);
  const inverse3::Reply reply = inverse3::parse_reply(message.text, identity_.id);
  if (reply.mode != inverse3::Mode::unknown) mode_ = reply.mode;
  idle_replies_ = reply.mode == inverse3::Mode::idle ? idle_replies_ + 1 : 0;
  if (!reply.position) return finished(Arrival::dropped, reply.fault);
  const bool braked = confirmed_ && idle_replies_ >= most_idle;
  Sample sample = finished(Arrival::fresh, braked ? Fault::brake : reply.fault);
  sample.position = *reply.position;
  if (reply.velocity) {
    sample.velocity = *reply.velocity;
  } else if (last_ && sample.received > last_->received) {
    sample.velocity = (sample.position - last_->position) / (sample.received - last_->received);
  }
  // A moving arm is never twice at the same place to the last bit: that is an old state.
  // Below a micrometre a second it may well be.
  const bool frozen = last_ && reply.velocity && sample.velocity.norm() > 1e-6 &&
                      sample.position == last_->position && sample.velocity == last_->velocity;
  if (frozen) {
    sample.arrival = Arrival::duplicate;
    return sample;
  }
  last_ = sample;
  return sample;
}

void Inverse3::hear_events() {
  std::size_t bytes = 0;
  for (int i = 0; i < most_events && bytes < most_event_bytes; ++i) {
    if (traffic_.events.port != Events::Port::heard) return;
    const auto message = events_->glance();
    if (message.outcome == WebSocket::Outcome::closed) traffic_.events.port = Events::Port::lost;
    if (message.outcome != WebSocket::Outcome::message) return;
    bytes += message.text.size();
    obey(inverse3::parse_event(message.text, identity_.id));
  }
}

// What was told stays told until a sample has said so; a release takes back the state, not that.
void Inverse3::obey(Event event) {
  ++traffic_.events.counts[static_cast<std::size_t>(event)];
  if (event == Event::brake) braked_ = true;
  if (event == Event::released) braked_ = false;
  if (event == Event::disconnected) gone_ = true;
  if (const Fault fault = fault_of(event); fault != Fault::none) told_ = fault;
}

Sample Inverse3::sample(double wait) {
  Sample sample = exchange(wait);
  hear_events();
  if (gone_) return finished(Arrival::lost, Fault::hung_up);
  if (told_ != Fault::none) {
    sample.fault = told_;
    told_ = Fault::none;
  } else if (braked_) {
    sample.fault = Fault::brake;
  }
  return sample;
}

Sample Inverse3::exchange(double wait) {
  const double until = wire_time() + std::max(0.0, wait);
  if (!awaiting_) {
    pass_over_duplicates();
    if (!send(Vec3::Zero()) && !socket_.closed()) return finished(Arrival::none, Fault::silent);
  }
  Sample newest = finished(Arrival::none, Fault::none);
  bool any = false;
  while (true) {
    const auto message = socket_.receive(any ? 0.0 : until);
    if (message.outcome == WebSocket::Outcome::closed && !any)
      return finished(Arrival::lost, Fault::hung_up);
    if (message.outcome != WebSocket::Outcome::message) break;
    const Sample one = read(message);
    if (any) ++traffic_.duplicates;
    ++traffic_.received;
    awaiting_ = false;
    // The newest that is good; of bad ones the last.
    if (one.arrival == Arrival::fresh || newest.arrival != Arrival::fresh) newest = one;
    any = true;
  }
  if (!any && wire_time() - asked_at_ >= reply_time) {
    awaiting_ = false;  // the next call asks anew
    newest.fault = Fault::silent;
  }
  return newest;
}

Fault Inverse3::command_force(const Vec3& force) {
  if (purpose_ != Purpose::command && !force.isZero(0.0)) return Fault::refused;
  if (!awaiting_) pass_over_duplicates();
  if (send(force)) return Fault::none;
  return socket_.closed() ? Fault::hung_up : Fault::silent;
}

bool Inverse3::stop() {
  if (!send(Vec3::Zero())) return false;
  return sample(stop_time).arrival != Arrival::lost;
}

}  // namespace palpate::device
