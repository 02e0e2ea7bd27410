// The integral of a pressure map.
#include "record/pressure_map.h"

namespace palpate::record {

double integral(const PressureMap& map) {
  double sum = 0.0;
  for (const float pressure : map.pressure) sum += static_cast<double>(pressure);
  return sum * map.pitch * map.pitch;
}

}  // namespace palpate::record
