// Any text as a recorded run: its samples are finite and their times never decrease.
#include "device/recording.h"

#include <cmath>

#include "fuzzing.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace palpate;
  fuzz::reads([&] {
    const auto samples = device::parse_recording(fuzz::text_of(data, size), "r.csv");
    fuzz::require(!samples.empty());
    double time = samples.front().device_time;
    for (const device::Sample& sample : samples) {
      fuzz::require(std::isfinite(sample.device_time) && sample.device_time >= time);
      fuzz::require(sample.position.allFinite() && sample.velocity.allFinite());
      time = sample.device_time;
    }
  });
  return 0;
}
