// The words for faults and events, and the histogram of times.
#include "device/sample.h"

namespace palpate::device {

std::string_view fault_text(Fault fault) {
  switch (fault) {
    case Fault::none: return "nothing is wrong";
    case Fault::garbage: return "bytes came that are no reply";
    case Fault::truncated: return "a reply did not end in time";
    case Fault::error_reply: return "the device refused a request";
    case Fault::unit_changed: return "the device changed its unit";
    case Fault::overload: return "the force is beyond what the gauge can measure";
    case Fault::not_finite: return "a reply held a number that cannot be";
    case Fault::missing_field: return "a reply held no position";
    case Fault::wrong_device: return "another device answered";
    case Fault::jump: return "the position jumped farther than the device can move";
    case Fault::brake: return "the device's own safety has acted";
    case Fault::stalled: return "the device says that a motor stalls";
    case Fault::unstable: return "the device says that it is at its stability ceiling";
    case Fault::not_verified: return "a setting did not read back as it was set";
    case Fault::refused: return "the command is not allowed now";
    case Fault::hung_up: return "the device hung up";
    case Fault::silent: return "the device fell silent";
    case Fault::recording_ended: return "the recording has ended";
    case Fault::guarded: return "the stand was stopped, because the program stood still";
    case Fault::unguarded: return "the process that guards the stand has ended";
    case Fault::flooded: return "the device sends more than can be read";
    case Fault::unknown_unit: return "a reading has a unit that is not known";
    case Fault::clock_jumped: return "the device's own time jumped ahead";
    case Fault::restarted: return "the device's own time went back, as after a restart";
    case Fault::reframed: return "the service now turns or scales the arm's coordinates";
  }
  return "unknown";
}

std::string_view event_text(Event event) {
  switch (event) {
    case Event::other: return "other";
    case Event::garbage: return "garbage";
    case Event::other_device: return "other_device";
    case Event::brake: return "ebrake_triggered";
    case Event::released: return "ebrake_released";
    case Event::stage_raised: return "fod_stage_raised";
    case Event::stage_lowered: return "fod_stage_lowered";
    case Event::stall: return "stall_detected";
    case Event::ceiling: return "stability_ceiling";
    case Event::safety: return "other_safety";
    case Event::notice: return "other_safety_notice";
    case Event::disconnected: return "device-disconnected";
    case Event::busy: return "device-busy";
  }
  return "unknown";
}

Fault fault_of(Event event) {
  switch (event) {
    case Event::brake:
    case Event::stage_raised:
    case Event::safety: return Fault::brake;
    case Event::stall: return Fault::stalled;
    case Event::ceiling: return Fault::unstable;
    case Event::disconnected: return Fault::hung_up;
    case Event::other:
    case Event::garbage:
    case Event::other_device:
    case Event::released:
    case Event::stage_lowered:
    case Event::notice:
    case Event::busy: break;
  }
  return Fault::none;
}

void LatencyHistogram::add(double time) {
  std::size_t bin = 0;
  for (double end = 1e-6; bin + 1 < bins && time >= end; end *= 2.0) ++bin;
  ++counts_[bin];
  ++count_;
  if (time > longest_) longest_ = time;
}

double LatencyHistogram::upper_end(std::size_t bin) {
  return 1e-6 * static_cast<double>(std::uint64_t{1} << bin);
}

double LatencyHistogram::quantile(double share) const {
  if (count_ == 0) return 0.0;
  const double wanted = share * static_cast<double>(count_);
  std::uint64_t below = 0;
  for (std::size_t bin = 0; bin < bins; ++bin) {
    below += counts_[bin];
    if (static_cast<double>(below) >= wanted) return upper_end(bin);
  }
  return upper_end(bins - 1);
}

}  // namespace palpate::device
