// Any bytes from a serial line: what is taken for a reading is one, and nothing crashes.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "device/mark10_protocol.h"
#include "device/serial_port.h"
#include "fuzzing.h"

// The first byte says in what portions the rest arrives.
void palpate::fuzz::mark10(const std::uint8_t* data, std::size_t size) {
  using namespace device;
  if (size == 0) return;
  const std::size_t portion = 1 + data[0];
  std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  LineBuffer lines;
  mark10::PairReader pairs;
  require(garbage_share(bytes) >= 0.0 && garbage_share(bytes) <= 1.0);
  while (!bytes.empty()) {
    lines.feed(bytes.substr(0, portion));
    bytes.remove_prefix(std::min(portion, bytes.size()));
    while (const auto line = lines.next()) {
      require(line->size() <= 160);
      const auto step = pairs.take(*line);
      if (step.pair) {
        require(std::isfinite(step.pair->force) && std::isfinite(step.pair->travel));
        require(step.pair->force_unit[0] != 0 && step.pair->force_unit[7] == 0);
        require(step.fault == Fault::none);
      }
      if (const auto quantity = mark10::parse_quantity(*line)) {
        require(std::isfinite(quantity->value) && std::abs(quantity->value) < 1e15);
        if (const auto speed = mark10::metres_per_second(*quantity))
          if (const auto command = mark10::speed_command(*speed)) require(command->size == 7);
        if (const auto length = mark10::metres(*quantity)) {
          const auto low = mark10::lower_limit_command(*length);
          require(!low || low->size == 7 || low->size == 8);
        }
      }
      static_cast<void>(mark10::parse_error(*line));
      static_cast<void>(mark10::parse_status(*line));
      static_cast<void>(mark10::parse_settings(*line));
    }
  }
}
