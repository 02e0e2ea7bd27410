// The style of all figures: colours, and the parts that all scripts for gnuplot share.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace palpate::plot {

// Okabe and Ito's colours (2008), which colour-blind readers can distinguish; ochre and violet
// stand for their orange, yellow and light blue, which have a contrast of less than 3 to white.
// Pages invert figures in the dark, where all have 3 as well. With 7 colours and 6 markers, 42
// series differ. The first five are those of skin, muscle, ligament, bone and upper leg in every
// figure.
inline constexpr std::array<const char*, 7> line_colours{"0072B2", "D55E00", "009E73", "CC79A7",
                                                         "8A6A00", "6A4FB3", "000000"};
// The places there of the colours of a figure's tissues: the paper's five have the first ones, and
// other tissues, in the order in which they first occur, those behind them.
[[nodiscard]] std::vector<std::size_t> tissue_colours(const std::vector<std::string>& tissues);
// The palette below is too light for lines on white from here on.
inline constexpr double brightest_line = 0.58;

// viridis (van der Walt and Smith, CC0), whose lightness rises evenly, so that it can be read in
// grey and by the colour-blind: red, green and blue at `share`, 0 to 1.
[[nodiscard]] std::array<unsigned char, 3> palette_bytes(double share);
// The same as six hexadecimal digits.
[[nodiscard]] std::string palette_colour(double share);

inline constexpr std::array<int, 6> gnuplot_markers{7, 5, 9, 13, 11, 15};

// The text in single quotes: quotes are doubled, line breaks become spaces.
[[nodiscard]] std::string gnuplot_quoted(const std::string& text);
// The title of a picture, with letters so small that a long one fits, on a telephone as well.
[[nodiscard]] std::string gnuplot_title(const std::string& title);

// The value in a row of the CSV column with this name: `column('NAME')`.
[[nodiscard]] std::string gnuplot_column(const std::string& name);

// A key of a scenario as a label: `tissue.young_modulus` as "Young's modulus", `step.1.to` as "Step
// 1 to".
[[nodiscard]] std::string key_label(std::string key);

// The size of a picture in pixels. Texts of 15 pixels stay readable where a telephone shows it at
// 0.6 of this width.
struct Canvas {
  int height = 400;
  int tick_font = 14;
  int width = 600;
};

// The head of the script NAME.gp: how to run it, terminal, output and the style of data, frame,
// ticks and grid.
[[nodiscard]] std::string gnuplot_head(const std::string& name, const Canvas& canvas);

// A number on an axis or a page, with `digits` significant digits: `0.02`, `500`, `2×10⁶`. Powers
// of ten are written below 0.001 and from `powers_from` on.
[[nodiscard]] std::string tick_text(double value, int digits = 5, double powers_from = 1e5);

// A logarithmic scale with its ticks for the axis `x`, `y` or `cb` from `low` to `high`, both
// positive: each power of ten is labelled, and 2 and 5 times it if the range is short.
[[nodiscard]] std::string gnuplot_logarithmic(const std::string& axis, double low, double high);
// `plot`, drawn with at least five ticks on the linear axes `axes`: `x`, `y`, `y0` with zero in it,
// or two of them, as `xy`. It is run twice: the ranges are known after the first, which draws
// nothing.
[[nodiscard]] std::string gnuplot_ticks(const std::string& plot, const std::string& axes);
// A linear scale again.
[[nodiscard]] std::string gnuplot_linear(const std::string& axis);

// `set palette ...` for the colours of palette_colour() up to `most`.
[[nodiscard]] std::string gnuplot_palette(double most = 1.0);

}  // namespace palpate::plot
