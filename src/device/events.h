// Events that an arm's service sends on its events port, and the fault that follows from each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "device/sample.h"

namespace palpate::device {

// The event's name in device_health.json: the service's own spelling if it has one.
[[nodiscard]] std::string_view event_text(Event event);

// The fault that the next sample reports after `event`. After hung_up the arm stays lost; brake,
// stalled and unstable trip the link; none means that the event is only counted.
[[nodiscard]] Fault fault_of(Event event);

// Sentences for people on a port that closed and on all events that were counted, except `other`.
[[nodiscard]] std::vector<std::string> event_sentences(const Events& events);

namespace inverse3 {

// Reads {"name","category","level","data":{"device_id","safety_type",..},"message"} for the arm
// `id`. Never allocates and never throws. An event of another device is other_device; an event that
// names no device is taken as ours; a message that is not a complete JSON object is garbage.
// docs.haply.co, Inverse Service 3.5: Events & Monitoring.
[[nodiscard]] Event parse_event(std::string_view message, std::string_view id);

}  // namespace inverse3
}  // namespace palpate::device
