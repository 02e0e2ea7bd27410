// Pressure maps as OpenEXR images.
#pragma once

#include <map>
#include <string>

#include "record/record.h"

namespace palpate::report {

// Returns the map as the bytes of an EXR file: FLOAT channels `pressure.Z`, `traction.X`,
// `traction.Y` and `traction.Z` in kPa, `gap.Z` in mm (infinite where the map's gap is infinite);
// ZIP (lossless). The first row of the image is that of the map (lowest y): the position of pixel
// (i, j) is origin + pitch (i, j). Attributes: `palpate:unit:pressure`, `palpate:unit:traction`,
// `palpate:unit:gap`, `palpate:pixelPitch_mm`, `palpate:origin_mm`, `palpate:time_s`,
// `palpate:contactForce_N`, `palpate:case`, `palpate:step`, then `more_attributes` as texts, such
// as `palpate:scenarioSha256`. The same map gives the same bytes. The map must have at least one
// pixel and width * height values of each kind. Throws SystemError if the library fails.
[[nodiscard]] std::string exr_bytes(const record::PressureMap& map,
                                    const std::map<std::string, std::string>& more_attributes);

// The version of the OpenEXR library, as `3.1.5`.
[[nodiscard]] std::string exr_version();

}  // namespace palpate::report
