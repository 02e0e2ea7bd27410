// A press as the formats of indenters want it: an approach to the largest force, then a retraction.
#pragma once

#include <string_view>

#include "report/export.h"

namespace palpate::report {

struct Press {
  const ExportColumn* time = nullptr;  // s; may be missing
  const ExportColumn* indentation = nullptr;
  const ExportColumn* force = nullptr;
  const ExportColumn* travel = nullptr;  // of the finger; the indentation where it is missing
  std::size_t peak = 0;                  // the row of the largest force, the approach's last
  double speed = 0.0;                    // mean of the approach, m/s; NaN where the time is missing
};

// Throws InputError where the curve is no press: `format` and what it `wants` are for the message.
[[nodiscard]] Press press_of(const ExportCurve& curve, std::string_view format,
                             std::string_view wants);

}  // namespace palpate::report
