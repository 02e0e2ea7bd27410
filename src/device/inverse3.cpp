// Messages to the arm and its replies. The client's messages set the pace; the newest reply counts.
#include "device/inverse3.h"

#include <algorithm>

#include "base/error.h"

namespace palpate::device {
namespace {

constexpr double connect_time = 2.0;   // s, from looking up the host to the snapshot
constexpr double version_time = 1.0;   // s, the part of it for the version
constexpr double events_time = 0.5;    // s, the part of it for the events port
constexpr double greeting_time = 0.1;  // s, per reply
constexpr int trials = 6;              // replies in which a spelling must end the idle mode
constexpr double period = 1e-3;        // s: the paper's frame
constexpr double stop_time = 0.02;     // s
constexpr double reply_time = 0.02;    // s, after which a reply counts as lost
// After a pause without messages the arm is idle for one or two replies. More mean a brake.
constexpr int most_idle = 3;  // replies
// Limits per frame. A service that sends more could hide a fault, or hold the frame for ever: its
// link is lost. One message is answered by one reply, so that only a few can be on their way.
constexpr int most_replies = 32;
// Further events wait for the next frame, but not for more than some ten frames: a service sends a
// few events a second, and none that sends 8 a frame is waited for. An event has some 200 bytes.
constexpr int most_events = 64;
constexpr std::size_t most_event_bytes = 65536;
constexpr int usual_events = 8;
constexpr int most_surplus = 512;

}  // namespace

void Unanswered::sent(double time) {
  if (count_ == most) forget(1);
  times_[(begin_ + count_) % most] = time;
  ++count_;
}

void Unanswered::forget(std::size_t count) {
  begin_ = (begin_ + count) % most;
  count_ -= count;
  given_up_ += count;
}

std::optional<double> Unanswered::answered() {
  if (count_ == 0) return std::nullopt;
  const double time = times_[begin_];
  begin_ = (begin_ + 1) % most;
  --count_;
  least_ = std::min(least_, count_);
  if (++replies_ < window) return time;
  if (usual_ && least_ > *usual_) forget(least_ - *usual_);
  usual_ = std::min(usual_.value_or(least_), least_);
  replies_ = 0;
  least_ = most;
  return time;
}

Inverse3::Inverse3(const ArmAddress& address, Purpose purpose, Clock& clock, Tap* tap)
    : LinkParts(clock),
      purpose_(purpose),
      connected_by_(wire_time() + connect_time),
      host_(look_up(address.host, connected_by_)),
      socket_(host_, address.port, connected_by_) {
  socket_.tap(tap);
  identity_.kind = Kind::arm;
  limits_.period = period;
  limits_.stale_after = 3.0 * period;
  limits_.lost_after = 0.1;
  listen(address, tap);
  ask_version(address.port);
  greet(address.id);
}

Inverse3::~Inverse3() {
  if (!socket_.closed()) send(Vec3::Zero());
}

void Inverse3::listen(const ArmAddress& address, Tap* tap) {
  traffic_.events.port = Events::Port::unheard;
  if (!address.events) {
    identity_.notes.push_back(
        "the service's events are not listened to, as the link requests: a brake is detected from "
        "the arm's state only, some frames later");
    return;
  }
  try {
    events_.emplace(host_, *address.events, std::min(connected_by_, wire_time() + events_time));
    events_->tap(tap);
    traffic_.events.port = Events::Port::heard;
  } catch (const LinkError&) {
    identity_.notes.push_back("the service's events are not heard, because no service answers on " +
                              host_.name + ":" + std::to_string(*address.events) +
                              ": a brake is detected from the arm's state only, some frames later");
  }
}

void Inverse3::ask_version(int port) {
  const auto version =
      http_get(host_, port, "/version", std::min(connected_by_, wire_time() + version_time));
  identity_.firmware = version ? inverse3::parse_version(*version) : std::string();
  if (identity_.firmware.empty())
    identity_.notes.push_back("the service does not report its version");
}

void Inverse3::greet(const std::string& wanted_id) {
  const auto first = socket_.receive(std::max(connected_by_, wire_time() + greeting_time));
  if (first.outcome != WebSocket::Outcome::message)
    throw LinkError(first.outcome == WebSocket::Outcome::closed
                        ? "palpate: " + socket_.why_closed() + " before it reported any device"
                        : "palpate: the service takes the connection but sends no snapshot; is "
                          "this its simulation port (10001)?");
  const auto snapshot = inverse3::parse_snapshot(first.text);
  if (!snapshot)
    throw LinkError(
        "palpate: the service's first message is not JSON; is this its simulation port (10001)?");
  if (snapshot->arms.empty())
    throw LinkError(
        "palpate: the service runs, but reports no Inverse3; connect and calibrate it, and check "
        "that no other program uses it");
  std::string ids;
  for (const inverse3::Arm& arm : snapshot->arms) ids += (ids.empty() ? "`" : ", `") + arm.id + "`";
  const auto chosen = std::ranges::find_if(snapshot->arms, [&](const inverse3::Arm& arm) {
    return wanted_id.empty() || arm.id == wanted_id;
  });
  if (chosen == snapshot->arms.end())
    throw LinkError("palpate: the service has no arm `" + wanted_id + "`, only " + ids +
                    "; write one of these after the `/`");
  if (snapshot->arms.size() > 1 && wanted_id.empty()) {
    const std::string several =
        "the service has " + std::to_string(snapshot->arms.size()) + " arms, " + ids;
    if (purpose_ == Purpose::command)
      throw LinkError("palpate: " + several + "; choose one, as `inverse3:HOST:PORT/" + chosen->id +
                      "`");
    identity_.notes.push_back(several + "; the first is read");
  }
  accept(*chosen);
  find_spelling();
  if (socket_.closed()) throw LinkError("palpate: " + socket_.why_closed());
  if (gone_ == Fault::flooded)
    throw LinkError("palpate: the service sends more than can be read; restart it");
  if (gone_ == Fault::reframed)
    throw LinkError("palpate: " + std::string(fault_text(gone_)) +
                    "; let no other program set them");
  if (gone_ != Fault::none)
    throw LinkError("palpate: the service says that the arm " + identity_.id +
                    " was disconnected; connect it again");
  if (traffic_.events.counts[as_index(Event::busy)] > 0)
    identity_.notes.push_back("another session uses the arm; end it");
  identity_.dialect = inverse3::spelling_text(spelling_);
}

// Refuses an arm that cannot be commanded as its positions say; one that is only read gets a note.
void Inverse3::accept(const inverse3::Arm& arm) {
  identity_.id = arm.id;
  identity_.model = arm.model;
  id_form_ = arm.form;
  framed_ = !arm.frame.empty();
  if (!arm.firmware.empty()) identity_.notes.push_back("the arm's own firmware is " + arm.firmware);
  if (arm.shifted)
    identity_.notes.push_back(
        "the service shifts the arm's coordinates; heights, also that of `--surface`, are shifted "
        "as well");
  const auto refuse = [&](const std::string& why, const std::string& remedy) {
    const std::string sentence = "the arm " + arm.id + " " + why + "; " + remedy;
    if (purpose_ == Purpose::command) throw LinkError("palpate: " + sentence);
    identity_.notes.push_back(sentence);
  };
  if (!arm.calibrated) refuse("is not calibrated", "calibrate it as its maker says");
  if (!arm.powered)
    refuse("has no power supply and cannot exert a force", "plug its power supply in");
  if (framed_)
    refuse("is shown in other coordinates (" + arm.frame + ")",
           "set basis `XYZ` and an identity mount and transform in the service: positions and "
           "forces are taken as they are");
}

// The arm stays idle if the service does not know the spelling.
void Inverse3::find_spelling() {
  using inverse3::Spelling;
  const Spelling expected = inverse3::spelling_of(identity_.firmware);
  const Spelling other = expected == Spelling::vector ? Spelling::values : Spelling::vector;
  probes_ = purpose_ != Purpose::command && inverse3::has_probe(identity_.firmware);
  if (!try_spelling(expected) && !probes_) {
    if (!socket_.closed() && try_spelling(other)) {
      identity_.notes.push_back("the service takes a force as `" +
                                std::string(inverse3::spelling_text(other)) +
                                "`, which does not agree with its version");
    } else {
      spelling_ = expected;
      identity_.notes.push_back(
          "the arm stays idle when a zero force is sent as `vector` or as `values`; it is not "
          "known whether it takes forces");
    }
  }
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
    if (probes_ && answers > 1) return true;  // events of the first replies have come by then
    // The first reply may still describe the time before the message.
    if (answers > 1 && mode_ == inverse3::Mode::other) return confirmed_ = true;
  }
  // If the service does not report the mode, the spelling is accepted.
  if (answers > 0 && mode_ == inverse3::Mode::unknown) return true;
  if (answers == 0)
    throw LinkError("palpate: the service does not reply to a message for " + identity_.id +
                    "; restart it");
  return false;
}

bool Inverse3::send(const Vec3& force) {
  // With a stepped clock every message takes one period.
  if (clock_.kind() == Clock::Kind::stepped) clock_.sleep_until(clock_.now() + period);
  const auto message = probes_ ? inverse3::probe_message(identity_.id, id_form_)
                               : inverse3::force_message(identity_.id, spelling_, force, id_form_);
  if (!socket_.send(message.text())) return false;
  if (!awaiting_) asked_at_ = wire_time();
  awaiting_ = true;
  unanswered_.sent(clock_.now());
  ++traffic_.sent;
  return true;
}

// Replies that arrive after all messages were answered or given up: duplicates, or late ones.
void Inverse3::pass_over_duplicates() {
  for (int replies = 0; !awaiting_ && gone_ == Fault::none; ++replies) {
    if (socket_.receive(0.0).outcome != WebSocket::Outcome::message) return;
    if (!charge()) ++traffic_.duplicates;
    if (replies == most_replies) gone_ = Fault::flooded;
  }
}

Sample Inverse3::read(const WebSocket::Received& message) {
  if (message.binary) return finished(Arrival::dropped, Fault::garbage);
  const inverse3::Reply reply = inverse3::parse_reply(message.text, identity_.id);
  if (reply.mode != inverse3::Mode::unknown) mode_ = reply.mode;
  idle_replies_ = reply.mode == inverse3::Mode::idle ? idle_replies_ + 1 : 0;
  if (reply.framed && !framed_) gone_ = Fault::reframed;
  if (!reply.position) return finished(Arrival::dropped, reply.fault);
  const bool braked = confirmed_ && idle_replies_ >= most_idle;
  Sample sample = finished(Arrival::fresh, braked ? Fault::brake : reply.fault);
  sample.position = *reply.position;
  if (reply.velocity) {
    sample.velocity = *reply.velocity;
  } else if (last_ && sample.received > last_->received) {
    sample.velocity = (sample.position - last_->position) / (sample.received - last_->received);
  }
  // A reply that equals the last one to the last bit repeats an old state, unless the arm rests.
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
  surplus_ = std::max(0, surplus_ - usual_events);
  for (int i = 0; i < most_events && bytes < most_event_bytes; ++i) {
    if (traffic_.events.port != Events::Port::heard) return;
    const auto message = events_->glance();
    if (message.outcome == WebSocket::Outcome::closed) traffic_.events.port = Events::Port::lost;
    if (message.outcome != WebSocket::Outcome::message) return;
    bytes += message.text.size();
    obey(inverse3::parse_event(message.text, identity_.id));
    if (++surplus_ > most_surplus) gone_ = Fault::flooded;
  }
}

// A fault is kept in told_ until a sample has returned it, even if a release comes in between.
void Inverse3::obey(Event event) {
  ++traffic_.events.counts[as_index(event)];
  if (event == Event::brake) braked_ = true;
  if (event == Event::released) braked_ = false;
  if (event == Event::disconnected) gone_ = Fault::hung_up;
  if (const Fault fault = fault_of(event); fault != Fault::none) told_ = fault;
}

Sample Inverse3::sample(double wait) {
  Sample sample = exchange(wait);
  hear_events();
  if (gone_ != Fault::none) return finished(Arrival::lost, gone_);
  if (told_ != Fault::none) {
    sample.fault = told_;
    told_ = Fault::none;
  } else if (braked_) {
    sample.fault = Fault::brake;
  }
  return sample;
}

// Charges a reply that has come to its message. Returns false if no message waits for one.
bool Inverse3::charge() {
  const bool late = unanswered_.several();
  const auto sent = unanswered_.answered();
  if (!sent) return false;
  if (late) ++traffic_.late;
  traffic_.reply.add(clock_.now() - *sent);
  return true;
}

Traffic Inverse3::traffic() const {
  Traffic traffic = traffic_;
  traffic.unanswered = unanswered_.given_up();
  return traffic;
}

Sample Inverse3::exchange(double wait) {
  const double until = wire_time() + std::max(0.0, wait);
  if (!awaiting_) {
    pass_over_duplicates();
    if (!send(Vec3::Zero()) && !socket_.closed()) return finished(Arrival::none, Fault::silent);
  }
  Sample newest = finished(Arrival::none, Fault::none);
  bool any = false;
  for (int replies = 0; gone_ == Fault::none; ++replies) {
    const auto message = socket_.receive(any ? 0.0 : until);
    if (message.outcome == WebSocket::Outcome::closed && !any)
      return finished(Arrival::lost, Fault::hung_up);
    if (message.outcome != WebSocket::Outcome::message) break;
    const Sample one = read(message);
    if (any) ++traffic_.duplicates;
    ++traffic_.received;
    (void)charge();
    awaiting_ = false;
    if (replies == most_replies) gone_ = Fault::flooded;
    // Keeps the newest fresh reply, or the last reply if none is fresh.
    if (one.arrival == Arrival::fresh || newest.arrival != Arrival::fresh) newest = one;
    any = true;
  }
  if (!any && wire_time() - asked_at_ >= reply_time) {
    awaiting_ = false;  // the next call sends a new message
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
