// Moves a stand and stops it: limits and speeds that are read back, and stops that are confirmed.
#include <algorithm>
#include <cmath>

#include "device/mark10.h"

namespace palpate::device {
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
  if (port_.lost()) return Fault::hung_up;
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
  if (port_.lost()) return Fault::hung_up;
  if (!process_->alive()) return Fault::unguarded;
  if (!(motion.speed >= limits_.slowest) || !(motion.speed <= limits_.speed)) return Fault::refused;
  const auto speed = mark10::speed_command(motion.speed);
  if (!speed) return Fault::refused;
  // A stand that was switched off and on since the last motion has lost its limits.
  if (const Fault fault = compare_limits(limits_.low, limits_.high); fault != Fault::none)
    return fault;
  send(speed->text());
  const auto got = ask_number("a");
  if (port_.lost()) return Fault::hung_up;
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
  while (!has_status_ && wire_time() < until && !port_.lost()) {
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
  } while (wire_time() < until && !port_.lost());
  // Without a clear status, two equal readings of the travel count as a stop. They cannot detect
  // slow motion: at its lowest speed the stand moves by 0.02 mm, its resolution, in 2.4 s.
  return !port_.lost() && stands_still(2.0 * limits_.period);
}

bool Mark10::stands_still(double time) {
  const auto first = ask_number("x");
  pause(time);
  const auto second = ask_number("x");
  return first && second && first->value == second->value && first->unit == second->unit;
}

}  // namespace palpate::device
