// Contour lines by marching squares.
#include "plot/contours.h"

#include <array>
#include <cmath>

namespace palpate::plot {
namespace {

struct Corner {
  double x, y, value;
};

struct Crossing {
  double x, y;
};

Crossing crossing(const Corner& a, const Corner& b, double level) {
  const double share = (level - a.value) / (b.value - a.value);
  return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
}

// The corners are in the order around the cell.
void add_cell(const std::array<Corner, 4>& corner, double level, std::vector<Segment>& segments) {
  std::array<Crossing, 4> found{};
  std::size_t count = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const Corner& a = corner[k];
    const Corner& b = corner[(k + 1) % 4];
    if ((a.value >= level) != (b.value >= level)) found[count++] = crossing(a, b, level);
  }
  const auto add = [&](std::size_t from, std::size_t to) {
    segments.push_back({level, found[from].x, found[from].y, found[to].x, found[to].y});
  };
  if (count == 2) add(0, 1);
  if (count < 4) return;
  // Every edge is crossed: if the middle is on the first corner's side of the level, that corner
  // and the opposite one are connected; otherwise they are cut off.
  double middle = 0.0;
  for (const Corner& one : corner) middle += 0.25 * one.value;
  if ((middle >= level) == (corner[0].value >= level)) {
    add(0, 1);
    add(2, 3);
  } else {
    add(3, 0);
    add(1, 2);
  }
}

}  // namespace

std::vector<double> round_levels(double low, double high, std::size_t wanted, bool logarithmic) {
  std::vector<double> levels;
  if (!(high > low) || wanted == 0) return levels;
  if (logarithmic) {
    std::vector<double> decades;
    for (int power = -30; power <= 30; ++power)
      for (const double digit : {1.0, 2.0, 5.0}) {
        // Division by a whole power of ten gives the double nearest to 0.2.
        const double level =
            power < 0 ? digit / std::pow(10.0, -power) : digit * std::pow(10.0, power);
        if (level < low || level > high) continue;
        levels.push_back(level);
        if (digit == 1.0) decades.push_back(level);
      }
    return levels.size() > 2 * wanted ? decades : levels;
  }
  const double rough = (high - low) / static_cast<double>(wanted);
  const double power = std::floor(std::log10(rough));
  const double decade = std::pow(10.0, power);
  double step = 10.0;
  for (const double digit : {5.0, 2.0, 1.0})
    if (digit * decade >= 0.999 * rough) step = digit;
  // Whole multiples of the step, each divided or multiplied once, for correct rounding.
  const double first = std::ceil(low / (step * decade) - 1e-9);
  for (double k = first; k * step * decade <= high * (1.0 + 1e-12) + 1e-12 * decade; k += 1.0)
    levels.push_back(power < 0.0 ? k * step / std::pow(10.0, -power) : k * step * decade);
  return levels;
}

std::vector<Segment> contours(const ValueGrid& grid, std::span<const double> levels) {
  std::vector<Segment> segments;
  const std::size_t nx = grid.x.size();
  const auto corner = [&](std::size_t i, std::size_t j) {
    return Corner{grid.x[i], grid.y[j], grid.values[j * nx + i]};
  };
  for (const double level : levels)
    for (std::size_t j = 0; j + 1 < grid.y.size(); ++j)
      for (std::size_t i = 0; i + 1 < nx; ++i) {
        const std::array<Corner, 4> cell{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1),
                                         corner(i, j + 1)};
        bool known = true;
        for (const Corner& one : cell) known = known && std::isfinite(one.value);
        if (known) add_cell(cell, level, segments);
      }
  return segments;
}

}  // namespace palpate::plot
