// Pixels by supersampling, so that the rim is shared by the pixels it runs through.
#include "run/hertz_map.h"

#include <cmath>

#include "contact/hertz.h"

namespace palpate::run {

record::PressureMap hertz_map(double force, double contact_radius) {
  record::PressureMap map;
  map.contact_force = force;
  if (force <= 0.0) {
    map.width = 1;
    map.height = 1;
    map.pitch = 1e-3;
    map.pressure = {0.0F};
    return map;
  }
  constexpr int pixels = 128;
  constexpr int samples = 8;
  map.width = pixels;
  map.height = pixels;
  map.pitch = 2.5 * contact_radius / pixels;
  const double first = -0.5 * (pixels - 1) * map.pitch;
  map.origin = Vec3(first, first, 0.0);
  for (int row = 0; row < pixels; ++row) {
    for (int column = 0; column < pixels; ++column) {
      double sum = 0.0;
      for (int i = 0; i < samples; ++i) {
        const double y = first + map.pitch * (row - 0.5 + (i + 0.5) / samples);
        for (int j = 0; j < samples; ++j) {
          const double x = first + map.pitch * (column - 0.5 + (j + 0.5) / samples);
          sum += contact::hertz::pressure(std::sqrt(x * x + y * y), force, contact_radius);
        }
      }
      map.pressure.push_back(static_cast<float>(sum / (samples * samples)));
    }
  }
  return map;
}

}  // namespace palpate::run
