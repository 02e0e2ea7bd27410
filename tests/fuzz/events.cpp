// Any bytes from an events port: what is obeyed names its event, whole JSON is never garbage, and
// nothing crashes.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string_view>

#include "device/inverse3_protocol.h"
#include "fuzzing.h"

namespace {

bool has(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

}  // namespace

void palpate::fuzz::events(const std::uint8_t* data, std::size_t size) {
  using namespace device;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const Event event = inverse3::parse_event(bytes, "049D");
  require(*event_text(event) != '\0');
  const Fault fault = fault_of(event);
  if (fault == Fault::hung_up) {
    require(has(bytes, "device-disconnected"));
  } else if (fault != Fault::none) {
    require(has(bytes, "device-safety-triggered"));
  }
  if (fault == Fault::stalled) require(has(bytes, "stall_detected"));
  if (fault == Fault::unstable) require(has(bytes, "stability_ceiling"));
  // The scanner goes 32 brackets deep; what another parser takes for an object is one here, too. To
  // that one a zero byte is the end.
  const auto brackets =
      std::count(bytes.begin(), bytes.end(), '{') + std::count(bytes.begin(), bytes.end(), '[');
  if (brackets <= 32 && !has(bytes, {"\0", 1}) &&
      nlohmann::json::parse(bytes, nullptr, false).is_object())
    require(event != Event::garbage);
}
