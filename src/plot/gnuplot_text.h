// Parts that all scripts for gnuplot share: the one style of all figures.
#pragma once

#include <array>
#include <string>

#include "plot/palette.h"

namespace palpate::plot {

inline constexpr std::array<int, 6> gnuplot_markers{7, 5, 9, 13, 11, 15};

// The text in single quotes: quotes are doubled, line breaks become spaces.
[[nodiscard]] std::string gnuplot_quoted(const std::string& text);

// The value in a row of the CSV column with this name: `column('NAME')`.
[[nodiscard]] std::string gnuplot_column(const std::string& name);

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
