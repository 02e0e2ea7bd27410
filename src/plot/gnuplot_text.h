// Parts that all scripts for gnuplot share.
#pragma once

#include <array>
#include <string>

namespace palpate::plot {

// Okabe and Ito's colours (2008), which colour-blind readers can distinguish, without the yellow,
// which is invisible on white. With 7 colours and 6 markers, 42 series differ.
inline constexpr std::array<const char*, 7> gnuplot_colours{"0072B2", "D55E00", "009E73", "CC79A7",
                                                            "E69F00", "56B4E9", "000000"};
inline constexpr std::array<int, 6> gnuplot_markers{7, 5, 9, 13, 11, 15};

// The text in single quotes: quotes are doubled, line breaks become spaces.
[[nodiscard]] std::string gnuplot_quoted(const std::string& text);

// The value in a row of the CSV column with this name: `column('NAME')`.
[[nodiscard]] std::string gnuplot_column(const std::string& name);

// The head of the script NAME.gp: how to run it, terminal and output; 820 x `height` pixels.
[[nodiscard]] std::string gnuplot_head(const std::string& name, int height);

}  // namespace palpate::plot
