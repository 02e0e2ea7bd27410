// Pressure, traction and gap over the contacts as a grid of pixels.
#pragma once

#include <string>
#include <vector>

#include "base/vec3.h"

namespace palpate::record {

// Values row by row from the lowest y, x fastest; the pressure of a pixel is the mean over it.
struct PressureMap {
  int width = 0;
  int height = 0;
  double pitch = 0.0;          // m, side of a pixel
  Vec3 origin = Vec3::Zero();  // m, centre of the first pixel
  double time = 0.0;           // s
  std::string scenario_case;   // the case's name
  int step = 0;                // counted from 1
  double contact_force = 0.0;  // N, the exact value of integral(map)
  // width * height values each
  std::vector<float> pressure;  // Pa, compression positive
  // Pa per area of the map, of the finger on the tissue
  std::vector<float> traction_x, traction_y, traction_z;
  std::vector<float> gap;  // m, between finger and tissue; 0 in contact, infinite beside the finger
};

// The integral of the pressure over the map, N.
[[nodiscard]] inline double integral(const PressureMap& map) {
  double sum = 0.0;
  for (const float pressure : map.pressure) sum += static_cast<double>(pressure);
  return sum * map.pitch * map.pitch;
}

}  // namespace palpate::record
