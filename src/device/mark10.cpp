// Requests to the stand with deadlines, settings that are read back, samples, motion and stop.
#include "device/mark10.h"

#include <algorithm>
#include <cmath>

namespace palpate::device {
namespace {

constexpr double sample_time = 0.05;               // s, after which a reading is requested again
constexpr double burst = 4e-3;                     // s, within which late replies follow each other
constexpr double byte_time = 10.0 / mark10::baud;  // s, with start and stop bit
constexpr double into_channel = 15e-3;    // s, pause after `/`, as in the published driver LabKit
constexpr double out_of_channel = 10e-3;  // s, pause after `\`
constexpr double planned_period = 0.02;   // s: 50 Hz, as LabKit polls
constexpr double longest_wait = 0.2 * GuardProcess::silence;  // s
constexpr std::size_t greeting_bytes = 400;
constexpr int most_waiting_reads =
    64;  // of 256 bytes: twice what a line at 115200 baud carries in 0.7 s
// ESM303 data sheet: 0.5 to 1100 mm/min. They cannot be requested: `j` and `k` select them.
constexpr double slowest = 0.5e-3 / 60.0;     // m/s
constexpr double fastest = 1100.0e-3 / 60.0;  // m/s

}  // namespace

Mark10::Mark10(const std::string& port, Purpose purpose, Clock& clock, Tap* tap)
    : clock_(clock),
      path_(port),
      purpose_(purpose),
      port_(port, {.baud = mark10::baud},
            purpose == Purpose::stop ? SerialPort::Use::shared : SerialPort::Use::alone) {
  port_.tap(tap);
  identity_.kind = Kind::stand;
  limits_.measures_force = true;
  limits_.slowest = slowest;
  limits_.speed = fastest;
  limits_.period = planned_period;
  limits_.stale_after = 3.0 * planned_period;
  limits_.lost_after = 0.25;
  first_bytes_.reserve(greeting_bytes);
  if (purpose_ == Purpose::stop) {
    send("\\s");  // the channel to the gauge may be open
    return;
  }
  if (purpose_ == Purpose::command) {
    process_ = std::make_unique<GuardProcess>(
        port_.descriptor(), clock_.kind() == Clock::Kind::monotonic ? GuardProcess::Heed::silence
                                                                    : GuardProcess::Heed::end_only);
    guard_ = std::make_unique<StopGuard>(port_.descriptor(), "s");
    StopGuard::watch_child(process_->id());
    signals_ = StopGuard::signals_passed();
    send("s");
  }
  greet();
  greeting_ = false;
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
  return port_.write(bytes);
}

// Waits for at most a part of the time after which the guard process takes this one for dead.
void Mark10::receive(double until) {
  std::array<char, 256> bytes;
  if (process_) process_->beat();
  const auto read = port_.read(bytes, std::min(until, wire_time() + longest_wait));
  if (read.outcome != SerialPort::Outcome::bytes) return;
  heard_ = true;
  const std::string_view got(bytes.data(), read.size);
  if (greeting_ && first_bytes_.size() < greeting_bytes)
    first_bytes_ += got.substr(0, greeting_bytes - first_bytes_.size());
  lines_.feed(got);
}

void Mark10::drain() {
  std::array<char, 256> bytes;
  for (int reads = 0; reads < most_waiting_reads; ++reads) {
    const auto read = port_.read(bytes, 0.0);
    if (read.outcome != SerialPort::Outcome::bytes) break;
    if (greeting_ && first_bytes_.size() < greeting_bytes)
      first_bytes_.append(bytes.data(), std::min(read.size, greeting_bytes - first_bytes_.size()));
    traffic_.discarded += read.size;
  }
  traffic_.discarded += lines_.rest().size();
  lines_.clear();
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
    if (const auto line = lines_.next()) return line;
    if (port_.lost() || wire_time() >= until) return std::nullopt;
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
  traffic.discarded += lines_.dropped();
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
    return lines_.rest().find_first_not_of("\r\n") != std::string_view::npos;
  };
  for (const double until = wire_time() + burst; !more() && !port_.lost();) {
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
  if (port_.lost()) return finished(Arrival::lost, Fault::hung_up);
  const double until = wire_time() + std::max(0.0, wait);
  if (!asked_) {
    // The replies to requests that were given up are read: they must not be taken for others.
    if (owed_count_ == 0) drain();
    asked_time_ = clock_.now();
    if (!send("n")) return finished(port_.lost() ? Arrival::lost : Arrival::none, Fault::hung_up);
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
    if (const auto line = lines_.next()) {
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
    if (port_.lost()) return finished(Arrival::lost, Fault::hung_up);
    const double now = wire_time();
    if (now >= asked_at_ + patience(sample_time)) {
      give_up();
      if (clock_.kind() == Clock::Kind::stepped)
        clock_.sleep_until(clock_.now() + sample_time - planned_period);
      if (!heard_) return finished(Arrival::none, Fault::silent);
      if (fault == Fault::none)
        fault = garbage_share(lines_.rest()) > 0.0 ? Fault::garbage : Fault::truncated;
      return finished(Arrival::dropped, fault);
    }
    if (now >= until) return finished(Arrival::none, fault);
    receive(std::min(until, asked_at_ + patience(sample_time)));
  }
}

}  // namespace palpate::device
