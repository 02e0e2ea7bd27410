// What the scripts for gnuplot have in common.
#pragma once

#include <array>
#include <string>

namespace palpate::report {

// Okabe and Ito's colours (2008), told apart by colour-blind readers, without the yellow that
// white paper swallows. Markers change at another pace, so that 42 series differ.
inline constexpr std::array<const char*, 7> gnuplot_colours{"0072B2", "D55E00", "009E73", "CC79A7",
                                                            "E69F00", "56B4E9", "000000"};
inline constexpr std::array<int, 6> gnuplot_markers{7, 5, 9, 13, 11, 15};

// A text between single quotes, in which gnuplot knows no escapes.
[[nodiscard]] std::string gnuplot_quoted(const std::string& text);

// How the script is run, its terminal and its output; `height` in pixels of 820 wide.
[[nodiscard]] std::string gnuplot_head(const std::string& name, int height);

}  // namespace palpate::report
