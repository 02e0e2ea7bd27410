// Events of the service's manual. An unknown safety event that is a warning also trips.
#include "device/events.h"

#include "device/json_scanner.h"

namespace palpate::device {

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

std::vector<std::string> event_sentences(const Events& events) {
  std::vector<std::string> sentences;
  if (events.port == Events::Port::lost)
    sentences.emplace_back(
        "the service's events port closed; from then on a brake was detected from the arm's state "
        "only");
  for (std::size_t i = 0; i < event_kinds; ++i) {
    const auto event = static_cast<Event>(i);
    const std::uint64_t count = events.counts[i];
    if (count == 0 || event == Event::other) continue;
    if (event == Event::busy)
      sentences.emplace_back("another session uses the arm (`device-busy`); end it");
    else
      sentences.push_back("the service reported `" + std::string(event_text(event)) + "`" +
                          (count > 1 ? ", " + std::to_string(count) + " times" : ""));
  }
  return sentences;
}

namespace inverse3 {
namespace {

struct Words {
  std::string_view name;
  std::string_view level;
  std::string_view device;  // empty if the message names none
  std::string_view safety;
};

void read_data(JsonScanner& scanner, Words& words) {
  if (!scanner.enter('{')) return scanner.skip();
  while (const auto key = scanner.next_key()) {
    if (*key == "device_id") {
      words.device = scanner.string().value_or("");
    } else if (*key == "safety_type") {
      words.safety = scanner.string().value_or("");
    } else {
      scanner.skip();
    }
  }
}

Event safety_event(const Words& words) {
  if (words.safety == "ebrake_triggered") return Event::brake;
  if (words.safety == "ebrake_released") return Event::released;
  if (words.safety == "stall_detected") return Event::stall;
  if (words.safety == "stability_ceiling") return Event::ceiling;
  // A change of the stage is a warning if the risk has grown, and `info` if it has fallen.
  const bool harmless = words.level == "info" || words.level == "notice";
  if (words.safety == "fod_stage_changed")
    return harmless ? Event::stage_lowered : Event::stage_raised;
  return harmless ? Event::notice : Event::safety;
}

}  // namespace

Event parse_event(std::string_view message, std::string_view id) {
  JsonScanner scanner(message);
  if (!scanner.enter('{')) return Event::garbage;
  Words words;
  while (const auto key = scanner.next_key()) {
    if (*key == "name") {
      words.name = scanner.string().value_or("");
    } else if (*key == "level") {
      words.level = scanner.string().value_or("");
    } else if (*key == "data") {
      read_data(scanner, words);
    } else {
      scanner.skip();
    }
  }
  if (!scanner.at_end()) return Event::garbage;
  const bool safety = words.name == "device-safety-triggered";
  const bool gone = words.name == "device-disconnected";
  if (!safety && !gone && words.name != "device-busy") return Event::other;
  if (!words.device.empty() && words.device != id) return Event::other_device;
  if (safety) return safety_event(words);
  return gone ? Event::disconnected : Event::busy;
}

}  // namespace inverse3
}  // namespace palpate::device
