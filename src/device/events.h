// What an arm's service tells on its events port: which of it is obeyed, and how often it came.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "device/sample.h"

namespace palpate::device {

// A word for device_health.json, as the service spells it where it has one.
[[nodiscard]] std::string_view event_text(Event event);

// What the next sample says after that event. hung_up: the arm is gone and stays so; brake, stalled
// and unstable trip; none: it is only told.
[[nodiscard]] Fault fault_of(Event event);

// Sentences for people on the events that were counted, and on a port that is not heard; empty
// where there is nothing to say.
[[nodiscard]] std::vector<std::string> event_sentences(const Events& events);

namespace inverse3 {

// Reads {"name","category","level","data":{"device_id","safety_type",..},"message"} for the arm
// `id`. Never allocates, never throws, whatever the bytes. A message about another device counts as
// other_device; one that names no device counts as ours. Garbage is what is no whole JSON object.
// docs.haply.co, Inverse Service 3.5: Events & Monitoring.
[[nodiscard]] Event parse_event(std::string_view message, std::string_view id);

}  // namespace inverse3
}  // namespace palpate::device
