// The words for faults and events, and the histogram of times.
#include "device/sample.h"

#include "base/words.h"

namespace palpate::device {

namespace {

constexpr auto faults = words_of<Fault>({
    {"none", "nothing is wrong"},
    {"garbage", "bytes came that are no reply"},
    {"truncated", "a reply did not end in time"},
    {"error_reply", "the device refused a request"},
    {"unit_changed", "the device changed its unit"},
    {"overload", "the force is beyond what the gauge can measure"},
    {"not_finite", "a reply held a number that cannot be"},
    {"missing_field", "a reply held no position"},
    {"wrong_device", "another device answered"},
    {"jump", "the position jumped farther than the device can move"},
    {"brake", "the device's own safety has acted"},
    {"stalled", "the device says that a motor stalls"},
    {"unstable", "the device says that it is at its stability ceiling"},
    {"not_verified", "a setting did not read back as it was set"},
    {"refused", "the command is not allowed now"},
    {"hung_up", "the device hung up"},
    {"silent", "the device fell silent"},
    {"recording_ended", "the recording has ended"},
    {"guarded", "the stand was stopped, because the program stood still"},
    {"unguarded", "the process that guards the stand has ended"},
    {"flooded", "the device sends more than can be read"},
    {"unknown_unit", "a reading has a unit that is not known"},
    {"restarted", "the device's own time went back, as after a restart"},
    {"clock_jumped", "the device's own time jumped ahead"},
    {"reframed", "the service now turns or scales the arm's coordinates"},
});

struct EventRow {
  const char* text;
  Fault fault = Fault::none;
};
// In the order of Event.
constexpr std::array events{EventRow{"other"},
                            EventRow{"garbage"},
                            EventRow{"other_device"},
                            EventRow{"ebrake_triggered", Fault::brake},
                            EventRow{"ebrake_released"},
                            EventRow{"fod_stage_raised", Fault::brake},
                            EventRow{"fod_stage_lowered"},
                            EventRow{"stall_detected", Fault::stalled},
                            EventRow{"stability_ceiling", Fault::unstable},
                            EventRow{"other_safety", Fault::brake},
                            EventRow{"other_safety_notice"},
                            EventRow{"device-disconnected", Fault::hung_up},
                            EventRow{"device-busy"}};
static_assert(events.size() == event_kinds, "every event has its row");

}  // namespace

const char* fault_text(Fault fault) { return faults[as_index(fault)].meaning; }
const char* event_text(Event event) { return events[as_index(event)].text; }
Fault fault_of(Event event) { return events[as_index(event)].fault; }

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
