// Labels of a sweep's columns in figures.
#pragma once

#include <span>
#include <string>

#include "sweep/columns.h"

namespace palpate::sweep {

// `force_at_1_mm_N` as "Force at 1 mm (N)", `force_indentation_power_n` as "n, power fit".
[[nodiscard]] std::string output_label(const std::string& column);

// `tissue.young_modulus_kPa` of the factor `tissue.young_modulus` as "Young's modulus (kPa)".
[[nodiscard]] std::string factor_label(const sweep::FactorChoice& factor);

// The column's name with `_` for all but letters and digits, for names of files.
[[nodiscard]] std::string file_word(const std::string& column);

// Whether values need a logarithmic scale: all positive, the largest over 30 times the smallest.
[[nodiscard]] bool spread_wide(std::span<const double> values);

}  // namespace palpate::sweep
