// Any text as a recorded run: its samples are finite and their times never decrease.
#include "device/link.h"

#include <cmath>

#include "fuzzing.h"

void palpate::fuzz::recording(const std::uint8_t* data, std::size_t size) {
  reads([&] {
    const auto samples = device::parse_recording(text_of(data, size), "r.csv");
    require(!samples.empty());
    double time = samples.front().device_time;
    for (const device::Sample& sample : samples) {
      require(std::isfinite(sample.device_time) && sample.device_time >= time);
      require(sample.position.allFinite() && sample.velocity.allFinite());
      time = sample.device_time;
    }
  });
}
