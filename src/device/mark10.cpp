// Requests to the stand with deadlines, settings that are read back, samples, motion and stop.
#include "device/mark10.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"

namespace palpate::device {
namespace {

constexpr double sample_time = 0.05;               // s, after which a reading is requested again
constexpr double burst = 4e-3;                     // s, within which late replies follow each other
constexpr double byte_time = 10.0 / mark10::baud;  // s, with start and stop bit
constexpr double into_channel = 15e-3;    // s, pause after `/`, as in the published driver LabKit
constexpr double out_of_channel = 10e-3;  // s, pause after `\`
constexpr double planned_period = 0.02;   // s: 50 Hz, as LabKit polls
constexpr double longest_wait = 0.2 * GuardProcess::silence;  // s
// ESM303 data sheet: 0.5 to 1100 mm/min. They cannot be requested: `j` and `k` select them.
constexpr double slowest = 0.5e-3 / 60.0;     // m/s
constexpr double fastest = 1100.0e-3 / 60.0;  // m/s

}  // namespace

Mark10::Mark10(const std::string& port, Purpose purpose, Clock& clock, Tap* tap)
    : LinkParts(clock),
      path_(port),
      purpose_(purpose),
      serial_(port, {.baud = mark10::baud}, tap,
              purpose == Purpose::stop ? SerialPort::Use::shared : SerialPort::Use::alone) {
  identity_.kind = Kind::stand;
  limits_.measures_force = true;
  limits_.slowest = slowest;
  limits_.speed = fastest;
  limits_.period = planned_period;
  limits_.stale_after = 3.0 * planned_period;
  limits_.lost_after = 0.25;
  if (purpose_ == Purpose::stop) {
    send("\\s");  // the channel to the gauge may be open
    return;
  }
  if (purpose_ == Purpose::command) {
    process_ = std::make_unique<GuardProcess>(serial_.port.descriptor(),
                                              clock_.kind() == Clock::Kind::monotonic
                                                  ? GuardProcess::Heed::silence
                                                  : GuardProcess::Heed::end_only);
    guard_ = std::make_unique<StopGuard>(serial_.port.descriptor(), "s");
    StopGuard::watch_child(process_->id());
    signals_ = StopGuard::signals_passed();
    send("s");
  }
  greet();
}

void Mark10::pause(double time) {
  Clock wire(Clock::Kind::monotonic);
  wire.sleep_until(wire_time() + time);
}

Mark10::~Mark10() = default;  // the guard sends the stop, then the port closes

// With a stepped clock every request takes one period, because the emulator replies at its ticks.
void Mark10::pass_time() {
  if (clock_.kind() == Clock::Kind::stepped) clock_.sleep_until(clock_.now() + planned_period);
}

// How long to wait for a reply (s of real time) that is due after `time`. With a stepped clock
// replies are never late, but the emulator may have to wait for a processor.
double Mark10::patience(double time) const {
  constexpr double lockstep = 0.5;  // s
  return clock_.kind() == Clock::Kind::stepped ? std::max(time, lockstep) : time;
}

bool Mark10::send(std::string_view bytes) {
  if (process_) process_->beat();
  return serial_.port.write(bytes);
}

// Waits for at most a part of the time after which the guard process takes this one for dead.
void Mark10::receive(double until) {
  if (process_) process_->beat();
  if (serial_.receive(std::min(until, wire_time() + longest_wait))) heard_ = true;
}

void Mark10::drain() {
  traffic_.discarded += serial_.drain();
  pairs_.clear();
}

std::optional<std::string> Mark10::gauge(std::string_view command, double wait) {
  StopGuard::open_channel("\\");
  send("/");
  pause(into_channel);
  drain();
  std::string line(command);
  line += '\r';
  send(line);
  std::optional<std::string> reply;
  const double until = wire_time() + wait;
  while (const auto got = reply ? std::nullopt : line_until(until)) {
    // The gauge's automatic readings are not replies.
    const auto quantity = mark10::parse_quantity(*got);
    if (!(quantity && mark10::newtons(*quantity))) reply = std::string(*got);
  }
  send("\\");
  pause(out_of_channel);
  drain();
  StopGuard::close_channel();
  return reply;
}

std::optional<mark10::Settings> Mark10::ask_settings() {
  const auto reply = gauge("LIST", patience(answer_time));
  return reply ? mark10::parse_settings(*reply) : std::nullopt;
}

bool Mark10::ask(std::string_view command) {
  // A pending reading would be mistaken for the reply.
  if (asked_) {
    const double until = asked_at_ + patience(sample_time);
    while (const auto line = asked_ ? line_until(until) : std::nullopt)
      if (pairs_.take(*line).pair) asked_ = false;
    if (asked_) give_up();
  }
  drain();
  pass_time();
  return send(command);
}

std::optional<std::string_view> Mark10::line_until(double until) {
  while (true) {
    if (const auto line = serial_.lines.next()) return line;
    if (serial_.port.lost() || wire_time() >= until) return std::nullopt;
    receive(until);
  }
}

std::optional<mark10::Quantity> Mark10::ask_number(std::string_view command) {
  if (!ask(command)) return std::nullopt;
  const double until = wire_time() + patience(answer_time);
  while (const auto line = line_until(until)) {
    if (mark10::parse_error(*line)) break;
    auto number = mark10::parse_quantity(*line);
    if (!number) continue;
    // The unit is a view into the buffer, and is replaced by a literal that outlives it.
    std::string_view known = "?";
    for (const std::string_view unit : {"", "mm", "in", "mm/min", "in/min"})
      if (number->unit == unit) known = unit;
    number->unit = known;
    return number;
  }
  return std::nullopt;
}

std::optional<mark10::Status> Mark10::ask_status() {
  if (!ask("p")) return std::nullopt;
  const double until = wire_time() + patience(answer_time);
  while (const auto line = line_until(until))
    if (const auto status = mark10::parse_status(*line)) return status;
  return std::nullopt;
}

Traffic Mark10::traffic() const {
  Traffic traffic = traffic_;
  traffic.discarded += serial_.lines.dropped();
  return traffic;
}

// The device measures between the arrival of the request and the first byte of its reply; without
// delays elsewhere the middle of that time is the moment of the measurement.
Sample Mark10::accept(const mark10::Pair& pair) {
  Sample sample = finished(Arrival::fresh, Fault::none);
  traffic_.reply.add(sample.received - asked_time_);
  const double line = byte_time * (static_cast<double>(reply_size_) - 1.0);
  sample.taken = clock_.kind() == Clock::Kind::stepped
                     ? sample.received
                     : std::max(asked_time_, 0.5 * (asked_time_ + sample.received - line));
  sample.position = Vec3(0.0, 0.0, pair.travel);
  sample.force = sign_ * pair.force;
  if (last_ && sample.received > last_->received)
    sample.velocity = (sample.position - last_->position) / (sample.received - last_->received);
  if (pair.force_unit != unit_) sample.fault = Fault::unit_changed;
  last_ = sample;
  return sample;
}

// Whether the pair that has just come answers a request that was given up: it came sooner than the
// line can carry the reply to the present request, or another pair follows directly.
bool Mark10::is_late() {
  if (owed_count_ == 0) return false;
  const double soonest = clock_.kind() == Clock::Kind::stepped
                             ? 0.0
                             : byte_time * static_cast<double>(reply_size_ + 1);
  if (wire_time() < asked_at_ + soonest) return true;
  const auto more = [&] {
    return serial_.lines.rest().find_first_not_of("\r\n") != std::string_view::npos;
  };
  for (const double until = wire_time() + burst; !more() && !serial_.port.lost();) {
    if (wire_time() >= until) return false;
    receive(until);
  }
  return more();
}

// Gives up the present request. Its reply is recognised if it comes later. If a reply has come
// since the request and none after it, that was the reply: the earlier ones are lost, and on a line
// faster than its nominal rate, as over USB, every further one would be taken for late as well.
void Mark10::give_up() {
  asked_ = false;
  if (heard_late_) {
    traffic_.unanswered += owed_count_;
    owed_count_ = 0;
    return;
  }
  if (owed_count_ == owed_.size()) {
    std::copy(owed_.begin() + 1, owed_.end(), owed_.begin());
    --owed_count_;
    ++traffic_.unanswered;
  }
  owed_[owed_count_++] = asked_time_;
}

bool Mark10::was_stopped() {
  const unsigned before = signals_;
  signals_ = StopGuard::signals_passed();
  const bool acted = process_->has_acted();
  return acted || signals_ != before;
}

Sample Mark10::sample(double wait) {
  Sample sample = read_sample(wait);
  if (!process_) return sample;
  if (sample.arrival != Arrival::lost && !process_->alive()) {
    send("s");
    return finished(Arrival::lost, Fault::unguarded);
  }
  if (was_stopped() && sample.fault == Fault::none) sample.fault = Fault::guarded;
  return sample;
}

Sample Mark10::read_sample(double wait) {
  if (serial_.port.lost()) return finished(Arrival::lost, Fault::hung_up);
  const double until = wire_time() + std::max(0.0, wait);
  if (!asked_) {
    // The replies to requests that were given up are read: they must not be taken for others.
    if (owed_count_ == 0) drain();
    asked_time_ = clock_.now();
    if (!send("n"))
      return finished(serial_.port.lost() ? Arrival::lost : Arrival::none, Fault::hung_up);
    pass_time();
    asked_ = true;
    ++traffic_.sent;
    heard_ = false;
    heard_late_ = false;
    reply_size_ = 0;
    asked_at_ = wire_time();
  }
  Fault fault = Fault::none;
  while (true) {
    if (const auto line = serial_.lines.next()) {
      reply_size_ += line->size() + 2;  // with its CR and LF
      const auto step = pairs_.take(*line);
      if (step.pair) {
        ++traffic_.received;
        if (is_late()) {
          ++traffic_.late;
          heard_late_ = true;
          traffic_.reply.add(clock_.now() - owed_.front());
          std::copy(owed_.begin() + 1, owed_.end(), owed_.begin());
          --owed_count_;
          reply_size_ = 0;
          continue;
        }
        traffic_.unanswered += owed_count_;
        owed_count_ = 0;
        asked_ = false;
        return accept(*step.pair);
      }
      if (fault == Fault::none) fault = step.fault;
      const bool over = step.fault == Fault::error_reply || step.fault == Fault::truncated ||
                        step.fault == Fault::overload;
      if (over) {
        asked_ = false;
        return finished(Arrival::dropped, fault);
      }
      continue;
    }
    if (serial_.port.lost()) return finished(Arrival::lost, Fault::hung_up);
    const double now = wire_time();
    if (now >= asked_at_ + patience(sample_time)) {
      give_up();
      if (clock_.kind() == Clock::Kind::stepped)
        clock_.sleep_until(clock_.now() + sample_time - planned_period);
      if (!heard_) return finished(Arrival::none, Fault::silent);
      if (fault == Fault::none)
        fault = garbage_share(serial_.lines.rest()) > 0.0 ? Fault::garbage : Fault::truncated;
      return finished(Arrival::dropped, fault);
    }
    if (now >= until) return finished(Arrival::none, fault);
    receive(std::min(until, asked_at_ + patience(sample_time)));
  }
}

// Opens the connection to a stand: ends the gauge's automatic output, reads its identity, sign and
// unit, and diagnoses why a stand does not answer.

namespace {

constexpr double mute_time = 0.03;  // s, to wait for an error after a setter, which has no reply
constexpr double still_time = 0.1;  // s, in which a stand at 12 mm/min moves by its resolution

}  // namespace

void Mark10::greet() {
  drain();
  quiet_gauge();
  ask_gauge_who_it_is();
  if (purpose_ == Purpose::command) send("i");
  std::optional<mark10::Pair> pair;
  bool force_alone = false;
  int error = 0;
  // Two attempts, because earlier bytes may spoil the first reply.
  for (int tries = 0; tries < 2 && !pair; ++tries) {
    pairs_.clear();
    if (!ask("n")) break;
    const double until = wire_time() + patience(answer_time);
    while (const auto line = pair ? std::nullopt : line_until(until)) {
      const auto step = pairs_.take(*line);
      if (step.error != 0) error = step.error;
      const auto quantity = mark10::parse_quantity(*line);
      force_alone = force_alone || (quantity && mark10::newtons(*quantity));
      pair = step.pair;
    }
  }
  if (!pair && error != 0)
    throw LinkError("palpate: the stand on `" + path_ + "` answers `*" + std::to_string(error) +
                    "`, " + std::string(mark10::error_text(error)) +
                    "; switch its PC Control on, and its gauge to the main screen");
  if (!pair && force_alone && !serial_.port.lost())
    throw LinkError("palpate: the stand on `" + path_ +
                    "` sends a force and no travel; it has no travel display, or this is a gauge "
                    "by itself; read that with `serial:" +
                    path_ + ",SETTINGS.toml`");
  if (!pair) refuse_silence();
  if (pairs_.order() == mark10::PairReader::Order::travel_first)
    identity_.notes.push_back("the stand sends the travel before the force");
  unit_ = pair->force_unit;
  identity_.dialect = "gauge in " + std::string(unit_.data());
  ask_stand_limits();
  if (purpose_ == Purpose::command) refuse_without_pc_control();
}

// Without PC Control a stand reads and does not obey: its speed does not change. A stand that
// reports no speed is left to move(), which reads it back.
void Mark10::refuse_without_pc_control() {
  const auto before = ask_number("a");
  const auto shown = before ? mark10::metres_per_second(*before) : std::nullopt;
  if (!shown) return;
  const double other = *shown > 1.5e-3 ? 1e-3 : 2e-3;  // m/s
  send(mark10::speed_command(other)->text());
  const auto after = ask_number("a");
  if (!after || after->value != before->value || after->unit != before->unit) return;
  throw LinkError("palpate: the stand on `" + path_ +
                  "` is read and does not obey; switch PC Control on in its menu");
}

void Mark10::quiet_gauge() {
  gauge("AOUT0", mute_time);
  if (purpose_ != Purpose::command) return;
  gauge("FULL", mute_time);
  gauge("N", mute_time);
}

void Mark10::ask_gauge_who_it_is() {
  const auto settings = ask_settings();
  if (!settings) {
    identity_.notes.push_back(
        "the gauge does not list its settings; a compressive force is assumed to be positive, the "
        "default of the series");
    return;
  }
  using Sign = mark10::Settings::Sign;
  identity_.firmware = settings->version;
  if (settings->sign == Sign::tension_positive) sign_ = -1.0;
  if (!settings->sign_listed && settings->sign == Sign::compression_positive)
    identity_.notes.push_back(
        "the gauge does not list its polarity (IPOL); a compressive force is assumed to be "
        "positive");
  if (settings->auto_output > 0)
    identity_.notes.push_back("the gauge still sends readings by itself, in spite of AOUT0");
  if (!settings->mode.empty() && settings->mode != "CUR")
    identity_.notes.push_back("the gauge shows a peak (" + settings->mode +
                              "), not the current force; set it to CUR");
  if (settings->sign == Sign::omitted) {
    const std::string why = "the gauge omits the sign of its forces; set OPOL0 in its menu";
    if (purpose_ == Purpose::command) throw LinkError("palpate: on `" + path_ + "` " + why);
    identity_.notes.push_back(why);
  }
  if (settings->numbers_only)
    throw LinkError("palpate: on `" + path_ +
                    "` the gauge sends numbers without a unit (NUM); set it to FULL in its menu");
  if (purpose_ == Purpose::command && settings->unit != "N")
    identity_.notes.push_back("the gauge still uses " + settings->unit +
                              "; its forces are converted");
  // Model and serial number.
  for (const auto& [command, into] :
       {std::pair{"RM", &identity_.model}, std::pair{"RS", &identity_.id}}) {
    const auto reply = gauge(command, patience(answer_time));
    if (reply && !mark10::parse_error(*reply) && garbage_share(*reply) == 0.0) *into = *reply;
  }
}

void Mark10::ask_stand_limits() {
  const auto read = [&](std::string_view command, double& into, auto convert) {
    const auto number = ask_number(command);
    const auto si = number ? convert(*number) : std::nullopt;
    if (si) into = *si;
    return si.has_value();
  };
  const auto length = [](const mark10::Quantity& one) {
    return one.unit.empty() ? std::optional(one.value * 1e-3) : mark10::metres(one);
  };
  const bool high = read("v", limits_.high, length);
  const bool low = read("w", limits_.low, length);
  if (!high || !low) identity_.notes.push_back("the stand does not report its travel limits");
  // The status of a stand that moves between its limits may be read in two ways (`DL`).
  const auto status = ask_status();
  has_status_ = status.has_value();
  if (!status)
    identity_.notes.push_back(
        "the stand does not report its status (`p`): two equal readings of its travel count as a "
        "stop, and motion slower than 0.5 mm/s is not seen by them");
  if (!status && !stands_still(still_time)) identity_.notes.push_back(moving_note(""));
  if (!status) return;
  using Moving = mark10::Status::Moving;
  const Moving moving = status->moving;
  if (moving == Moving::stopped || (moving == Moving::unknown && stands_still(still_time))) return;
  identity_.notes.push_back(moving_note(moving == Moving::up     ? " up"
                                        : moving == Moving::down ? " down"
                                                                 : ""));
}

std::string Mark10::moving_note(const char* way) const {
  return "the stand is moving" + std::string(way) + "; `palpate device stop mark10:" + path_ +
         "` stops it";
}

void Mark10::refuse_silence() const {
  const std::string on = "palpate: on `" + path_ + "` ";
  if (serial_.port.lost()) throw LinkError(on + "the device hung up; check its cable");
  if (serial_.first_bytes.empty())
    throw LinkError(on +
                    "nothing answers; switch the stand on, set CONTROL to CONSOLE, PC Control to "
                    "on and the rate to " +
                    std::to_string(mark10::baud) + " baud, and check the cable");
  // At another rate most bytes are not text; a fifth of them is enough for the diagnosis.
  if (garbage_share(serial_.first_bytes) > 0.2)
    throw LinkError(on + "garbage answers, as at a wrong baud rate; set the stand and its gauge " +
                    "to " + std::to_string(mark10::baud) + " baud, 8 bits, no parity");
  throw LinkError(on + "a device answers in words that are no reading (`" +
                  printable(serial_.first_bytes) +
                  "`); is this the stand's port, and is the gauge plugged into the stand?");
}

// Moves a stand and stops it: limits and speeds that are read back, and stops that are confirmed.

namespace {

constexpr double stop_repeat_time = 0.5;  // s, during which stop() repeats the command

}  // namespace

// Compares the limits that the stand reports with `low` and `high` (m).
Fault Mark10::compare_limits(double low, double high) {
  constexpr double close = 0.51 * mark10::travel_step;  // rounding to the stand's resolution
  const auto in_metres = [](const mark10::Quantity& one) {
    return one.unit.empty() ? one.value * 1e-3 : mark10::metres(one).value_or(Sample::nan);
  };
  const auto got_low = ask_number("w");
  const auto got_high = ask_number("v");
  if (serial_.port.lost()) return Fault::hung_up;
  if (!got_low || !got_high) return Fault::silent;
  const bool same = std::abs(in_metres(*got_low) - low) <= close &&
                    std::abs(in_metres(*got_high) - high) <= close;
  return same ? Fault::none : Fault::not_verified;
}

Fault Mark10::set_travel_limits(double low, double high) {
  limits_verified_ = false;
  // Rounded to the stand's resolution, because the stand reports them no finer.
  low = mark10::travel_step * std::round(low / mark10::travel_step);
  high = mark10::travel_step * std::round(high / mark10::travel_step);
  const auto lower = mark10::lower_limit_command(low);
  const auto upper = mark10::upper_limit_command(high);
  if (purpose_ != Purpose::command || !lower || !upper || !(low < high)) return Fault::refused;
  drain();
  send("l");
  send(lower->text());
  send(upper->text());
  // Setters have no reply: the limits are requested up to three times, until they have changed.
  Fault fault = Fault::not_verified;
  for (int tries = 0; tries < 3 && fault != Fault::none; ++tries) fault = compare_limits(low, high);
  if (fault != Fault::none) return fault;
  const auto status = ask_status();
  // Limits are active in limit mode only; a status without a mode is accepted.
  if (status && status->mode != '?' && status->mode != 'L') return Fault::not_verified;
  limits_.low = low;
  limits_.high = high;
  limits_verified_ = true;
  return Fault::none;
}

Fault Mark10::move(const Motion& motion) {
  if (motion.act == Motion::Act::stop) return stop() ? Fault::none : Fault::not_verified;
  if (purpose_ != Purpose::command || !limits_verified_) return Fault::refused;
  if (serial_.port.lost()) return Fault::hung_up;
  if (!process_->alive()) return Fault::unguarded;
  if (!(motion.speed >= limits_.slowest) || !(motion.speed <= limits_.speed)) return Fault::refused;
  const auto speed = mark10::speed_command(motion.speed);
  if (!speed) return Fault::refused;
  // A stand that was switched off and on since the last motion has lost its limits.
  if (const Fault fault = compare_limits(limits_.low, limits_.high); fault != Fault::none)
    return fault;
  send(speed->text());
  const auto got = ask_number("a");
  if (serial_.port.lost()) return Fault::hung_up;
  if (!got) return Fault::silent;
  const auto read_back = mark10::metres_per_second(*got);
  if (!read_back || std::abs(*read_back - motion.speed) > 0.51 * mark10::speed_step)
    return Fault::not_verified;
  process_->watch(true);
  return send(motion.act == Motion::Act::down ? "d" : "u") ? Fault::none : Fault::hung_up;
}

bool Mark10::stop() {
  if (purpose_ == Purpose::look) return true;  // such a link cannot start a motion
  const bool stopped = confirm_stop();
  if (stopped && process_) process_->watch(false);
  return stopped;
}

bool Mark10::confirm_stop() {
  // The stand brakes from its highest speed in about 0.1 s.
  const double until = wire_time() + patience(stop_repeat_time);
  while (!has_status_ && wire_time() < until && !serial_.port.lost()) {
    send("s");
    if (stands_still(2.0 * limits_.period)) return true;
  }
  if (!has_status_) return false;
  do {
    send("s");
    const auto status = ask_status();
    if (status && status->moving == mark10::Status::Moving::stopped) return true;
    if (status && clock_.kind() == Clock::Kind::monotonic) pause(limits_.period);
    if (process_) process_->beat();
  } while (wire_time() < until && !serial_.port.lost());
  // Without a clear status, two equal readings of the travel count as a stop. They cannot detect
  // slow motion: at its lowest speed the stand moves by 0.02 mm, its resolution, in 2.4 s.
  return !serial_.port.lost() && stands_still(2.0 * limits_.period);
}

bool Mark10::stands_still(double time) {
  const auto first = ask_number("x");
  pause(time);
  const auto second = ask_number("x");
  return first && second && first->value == second->value && first->unit == second->unit;
}

}  // namespace palpate::device
