// Colours for values.
#pragma once

#include <array>
#include <string>

namespace palpate::plot {

// Okabe and Ito's colours (2008), which colour-blind readers can distinguish, without the yellow,
// which is invisible on white. With 7 colours and 6 markers, 42 series differ.
inline constexpr std::array<const char*, 7> line_colours{"0072B2", "D55E00", "009E73", "CC79A7",
                                                         "E69F00", "56B4E9", "000000"};

// viridis (van der Walt and Smith, CC0), whose lightness rises evenly, so that it can be read in
// grey and by the colour-blind: red, green and blue at `share`, 0 to 1.
[[nodiscard]] std::array<unsigned char, 3> palette_bytes(double share);
// The same as six hexadecimal digits.
[[nodiscard]] std::string palette_colour(double share);

}  // namespace palpate::plot
