// How columns of a sweep are called in figures, and the colours of values.
#pragma once

#include <span>
#include <string>

#include "study/sweep_columns.h"

namespace palpate::report {

// `force_at_1_mm_N` as "Force at 1 mm (N)", `force_indentation_power_n` as "n, power fit".
[[nodiscard]] std::string output_label(const std::string& column);

// `tissue.young_modulus_kPa` of the factor `tissue.young_modulus` as "tissue.young_modulus (kPa)".
[[nodiscard]] std::string factor_label(const study::FactorChoice& factor);

// A name that files and SVG figures can have: letters, digits and `_`.
[[nodiscard]] std::string file_word(const std::string& column);

// Whether values are better seen by their logarithms: all above 0, over more than a decade and a
// half.
[[nodiscard]] bool spread_wide(std::span<const double> values);

// `set palette ...`: viridis (van der Walt and Smith, CC0), whose lightness rises evenly, so that
// it can be read in grey and by the colour-blind.
[[nodiscard]] std::string palette_text();
// The colour at a share from 0 to 1 of it, six hexadecimal digits.
[[nodiscard]] std::string palette_colour(double share);

}  // namespace palpate::report
