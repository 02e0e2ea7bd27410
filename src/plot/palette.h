// Colours for values.
#pragma once

#include <array>
#include <string>

namespace palpate::plot {

// Okabe and Ito's colours (2008), which colour-blind readers can distinguish; ochre and violet
// stand for their orange, yellow and light blue, which have a contrast of less than 3 to white.
// Pages invert figures in the dark, where all have 3 as well. With 7 colours and 6 markers, 42
// series differ. The first five are those of skin, muscle, ligament, bone and upper leg in every
// figure.
inline constexpr std::array<const char*, 7> line_colours{"0072B2", "D55E00", "009E73", "CC79A7",
                                                         "8A6A00", "6A4FB3", "000000"};
// The palette below is too light for lines on white from here on.
inline constexpr double brightest_line = 0.58;

// viridis (van der Walt and Smith, CC0), whose lightness rises evenly, so that it can be read in
// grey and by the colour-blind: red, green and blue at `share`, 0 to 1.
[[nodiscard]] std::array<unsigned char, 3> palette_bytes(double share);
// The same as six hexadecimal digits.
[[nodiscard]] std::string palette_colour(double share);

}  // namespace palpate::plot
