// Builds surfaces from loops with equal arcs, each one triangle height above the last and shifted
// by half an arc. sin, cos and arcs are those of the C library, and may differ in their last bit.
#include "geometry/shape_loops.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace palpate::geometry {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double row_height = 0.8660254037844386;  // of an equilateral triangle of side 1
// Lengths that are equal by symmetry may differ by rounding; then the first candidate is taken.
constexpr double equal = 1.0 - 1e-9;
// Fraction of a loop: beyond it, a loop would be connected to the returning half of a double line.
constexpr double farthest_ahead = 0.25;

int count_of(double length, double spacing, int least) {
  return std::max(least, static_cast<int>(std::lround(length / spacing)));
}

// Points around the surface; the first is not repeated at the end. A single point is a pole. A loop
// that follows a line and returns contains the points between its ends twice.
using Loop = std::vector<Vec3>;

// Numbers the points of a loop; a point that occurs twice gets a single number.
std::vector<int> added(const Loop& loop, std::vector<Vec3>& vertices) {
  const std::size_t first = vertices.size();
  std::vector<int> numbers;
  for (const Vec3& point : loop) {
    const auto known =
        std::find(vertices.begin() + static_cast<std::ptrdiff_t>(first), vertices.end(), point);
    numbers.push_back(static_cast<int>(known - vertices.begin()));
    if (known == vertices.end()) vertices.push_back(point);
  }
  return numbers;
}

double share(double steps, std::size_t all) { return steps / static_cast<double>(all); }

void stitch(const std::vector<int>& below, const std::vector<int>& above, Surface& surface) {
  const auto distance = [&](int a, int b) {
    return (surface.vertices[as_index(a)] - surface.vertices[as_index(b)]).norm();
  };
  std::size_t start = 0;
  for (std::size_t j = 1; j < above.size(); ++j)
    if (distance(below[0], above[j]) < equal * distance(below[0], above[start])) start = j;
  const auto low = [&](std::size_t i) { return below[i % below.size()]; };
  const auto high = [&](std::size_t j) { return above[(start + j) % above.size()]; };
  // A pole has no edges.
  const std::size_t low_steps = below.size() > 1 ? below.size() : 0;
  const std::size_t high_steps = above.size() > 1 ? above.size() : 0;
  for (std::size_t i = 0, j = 0; i < low_steps || j < high_steps;) {
    bool along_low = j == high_steps;
    if (i < low_steps && j < high_steps) {
      // The fractions of a loop by which the edges' midpoints would be ahead of the opposite point.
      const double low_ahead = share(i + 0.5, low_steps) - share(j, high_steps);
      const double high_ahead = share(j + 0.5, high_steps) - share(i, low_steps);
      along_low = high_ahead > farthest_ahead ||
                  (low_ahead <= farthest_ahead &&
                   distance(low(i + 1), high(j)) < equal * distance(low(i), high(j + 1)));
    }
    if (along_low) {
      surface.triangles.push_back({low(i), low(i + 1), high(j)});
      ++i;
    } else {
      surface.triangles.push_back({low(i), high(j + 1), high(j)});
      ++j;
    }
  }
}

double perimeter(const Section& section) {
  return 4.0 * section.straight + 2.0 * pi * section.radius;
}

// The point at the arc length `arc` (m) from the lowest point, towards smaller x and then upwards.
Vec3 on_section(const Sweep& sweep, const Section& section, double y, double arc) {
  const double straight = 2.0 * section.straight;
  const double half_circle = pi * section.radius;
  arc = std::fmod(arc, 2.0 * (straight + half_circle));
  if (arc < 0.5 * straight) return {sweep.x - arc, y, sweep.z - section.radius};
  arc -= 0.5 * straight;
  if (arc < half_circle) {
    const double angle = arc / section.radius;
    return {sweep.x - section.straight - section.radius * std::sin(angle), y,
            sweep.z - section.radius * std::cos(angle)};
  }
  arc -= half_circle;
  if (arc < straight) return {sweep.x - section.straight + arc, y, sweep.z + section.radius};
  arc -= straight;
  if (arc < half_circle) {
    const double angle = arc / section.radius;
    return {sweep.x + section.straight + section.radius * std::sin(angle), y,
            sweep.z + section.radius * std::cos(angle)};
  }
  return {sweep.x + section.straight - (arc - half_circle), y, sweep.z - section.radius};
}

// Every second loop is shifted by half an arc. A circle starts at its lowest point; a flat section
// starts at its side, where the nearest point of its double middle line occurs only once.
Loop section_loop(const Sweep& sweep, const Section& section, double y, int count, int row) {
  const double around = perimeter(section);
  const double start = section.straight > 0.0 ? 0.25 * around : 0.0;
  Loop loop;
  for (int i = 0; i < count; ++i)
    loop.push_back(on_section(sweep, section, y, start + around * ((i + 0.5 * (row % 2)) / count)));
  return loop;
}

// The number of points around a section at height y: the same from end to end if their distance
// then stays within a quarter of `spacing`, so that triangles are alike; otherwise as many as fit.
int count_around(const Sweep& sweep, std::size_t which, double y, double spacing) {
  constexpr int looks = 32;
  const auto& section = sweep.sections[which];
  double least = perimeter(section(0.0));
  double most = least;
  for (int i = 1; i <= looks; ++i) {
    const double around = perimeter(section(sweep.length * i / looks));
    least = std::min(least, around);
    most = std::max(most, around);
  }
  const bool alike = most <= 1.6 * least;
  return count_of(alike ? std::sqrt(least * most) : perimeter(section(y)), spacing, 6);
}

// The parameters in [0, to] at which a sum reaches 0, 1/count, 2/count ... 1 of its last value.
// `sums` are its values at the ends of equal parts of [0, to], ascending; it is linear in a part.
std::vector<double> equal_parts(const std::vector<double>& sums, double to, int count) {
  const std::size_t last = sums.size() - 1;
  std::vector<double> parameters;
  std::size_t end = 1;  // of the part that contains the wanted sum
  for (int k = 0; k <= count; ++k) {
    const double wanted = sums.back() * k / count;
    while (end < last && sums[end] < wanted) ++end;
    const double part = (wanted - sums[end - 1]) / (sums[end] - sums[end - 1]);
    parameters.push_back(to * (static_cast<double>(end) - 1.0 + part) / static_cast<double>(last));
  }
  return parameters;
}

// The heights of a side's rows, one triangle height apart for triangles of the local width. The
// number of rows is even or odd as `like` is.
std::vector<double> row_heights(const Sweep& sweep, std::size_t which, double spacing,
                                std::optional<int> like) {
  constexpr int slices = 1000;
  std::vector<double> rows{0.0};  // number of rows up to each slice
  for (int i = 0; i < slices; ++i) {
    const double y = sweep.length * (i + 0.5) / slices;
    const double chord =
        perimeter(sweep.sections[which](y)) / count_around(sweep, which, y, spacing);
    // Six points around a thin rod are closer than `spacing`; its triangles may then be longer.
    const double width = chord < 0.7 * spacing ? std::min(spacing, 2.0 * chord) : chord;
    rows.push_back(rows.back() + sweep.length / slices / (row_height * width));
  }
  int count = count_of(rows.back(), 1.0, 1);
  if (like) count += (count - *like) % 2 != 0;
  return equal_parts(rows, sweep.length, count);
}

// The middle of an end face: a point, or a line followed forth and back.
Loop middle(const Sweep& sweep, double straight, double y, double spacing) {
  if (straight == 0.0) return {Vec3(sweep.x, y, sweep.z)};
  const int steps = count_of(2.0 * straight, spacing, 1);
  Loop loop;
  for (int i = 0; i < 2 * steps; ++i) {
    const int at = i <= steps ? i : 2 * steps - i;
    loop.emplace_back(sweep.x - straight + 2.0 * straight * (static_cast<double>(at) / steps), y,
                      sweep.z);
  }
  return loop;
}

// An end face from its middle outwards to the edge of section `which`. All edges are shifted
// according to `row`. Between two edges the spacing changes linearly.
std::vector<Loop> end_face(const Sweep& sweep, double y, std::size_t which, const Spacing& spacing,
                           int row) {
  const std::size_t last = sweep.sections.size() - 1;
  std::vector<Loop> loops{middle(sweep, sweep.sections[last](y).straight, y, spacing.of(last))};
  double inner = 0.0;
  for (std::size_t s = last + 1; s-- > which;) {
    const Section edge = sweep.sections[s](y);
    const double from = spacing.of(std::min(s + 1, last));
    const double to = spacing.of(s);
    const int rows = count_of(edge.radius - inner, row_height * 0.5 * (from + to), 1);
    for (int k = 1; k < rows; ++k) {
      const double part = static_cast<double>(k) / rows;
      const Section within{edge.straight, inner + part * (edge.radius - inner)};
      const int count = count_of(perimeter(within), from + part * (to - from), 6);
      loops.push_back(section_loop(sweep, within, y, count, row + rows - k));
    }
    // The edge is bitwise equal to the loop of the side.
    loops.push_back(section_loop(sweep, edge, y, count_around(sweep, s, y, to), row));
    inner = edge.radius;
  }
  return loops;
}

// Parameters t at the ends of `count` equal arcs of (a sin t, b cos t) over [0, to]; 2000 chords.
std::vector<double> equal_arcs(double a, double b, double to, int count) {
  constexpr int chords = 2000;
  std::vector<double> arc{0.0};
  const auto at = [&](int i) {
    const double t = to * i / chords;
    return Eigen::Vector2d(a * std::sin(t), b * std::cos(t));
  };
  for (int i = 1; i <= chords; ++i) arc.push_back(arc.back() + (at(i) - at(i - 1)).norm());
  return equal_parts(arc, to, count);
}

// Perimeter of an ellipse with these semi-axes (Ramanujan 1914; error 1e-4 even at 5 : 1).
double ellipse_perimeter(double a, double b) {
  return pi * (3.0 * (a + b) - std::sqrt((3.0 * a + b) * (a + 3.0 * b)));
}

// The surface through `loops`. Between two loops, each next edge is the shorter one of two
// candidates. The surface is closed if the first and last loops enclose no area. The triangles face
// outwards if every loop runs to the right, seen from outside with the sequence of loops upwards.
// Points that a loop contains twice become one vertex.
Surface stitched(const std::vector<Loop>& loops) {
  Surface surface;
  std::vector<int> below;
  for (const Loop& loop : loops) {
    const std::vector<int> above = added(loop, surface.vertices);
    if (!below.empty()) stitch(below, above, surface);
    below = above;
  }
  return surface;
}

}  // namespace

std::vector<Surface> sweep_surfaces(const Sweep& sweep, const Spacing& spacing) {
  std::optional<int> rows_outside;
  std::vector<Surface> surfaces;
  for (std::size_t which = 0; which < sweep.sections.size(); ++which) {
    const double edge = spacing.of(which);
    // At the far end face the loops of all sides have the same shift.
    const std::vector<double> heights = row_heights(sweep, which, edge, rows_outside);
    const int rows = static_cast<int>(heights.size()) - 1;
    if (!rows_outside) rows_outside = rows;
    std::vector<Loop> loops = end_face(sweep, 0.0, which, spacing, 0);
    for (int row = 1; row < rows; ++row) {
      const double y = heights[as_index(row)];
      loops.push_back(section_loop(sweep, sweep.sections[which](y), y,
                                   count_around(sweep, which, y, edge), row));
    }
    std::vector<Loop> far = end_face(sweep, sweep.length, which, spacing, *rows_outside);
    loops.insert(loops.end(), far.rbegin(), far.rend());
    surfaces.push_back(stitched(loops));
  }
  return surfaces;
}

Surface ellipsoid_surface(const Vec3& centre, const Vec3& size, double spacing) {
  const Vec3 half = 0.5 * size;
  const double mean = std::sqrt(half.x() * half.y());
  const int rows = count_of(0.5 * ellipse_perimeter(mean, half.z()), row_height * spacing, 3);
  const std::vector<double> polar = equal_arcs(mean, half.z(), pi, rows);
  std::vector<Loop> loops{{centre - Vec3(0.0, 0.0, half.z())}};
  for (int row = 1; row < rows; ++row) {
    const double wide = std::sin(polar[as_index(row)]);
    const double height = -half.z() * std::cos(polar[as_index(row)]);
    const int count = count_of(wide * ellipse_perimeter(half.x(), half.y()), spacing, 5);
    // Twice as many arcs; every second end is a vertex, the others are for the next row.
    const std::vector<double> around = equal_arcs(half.y(), half.x(), 2.0 * pi, 2 * count);
    Loop loop;
    for (int i = 0; i < count; ++i) {
      const double angle = around[as_index(2 * i + row % 2)];
      loop.push_back(centre + Vec3(wide * half.x() * std::cos(angle),
                                   wide * half.y() * std::sin(angle), height));
    }
    loops.push_back(std::move(loop));
  }
  loops.push_back({centre + Vec3(0.0, 0.0, half.z())});
  return stitched(loops);
}

}  // namespace palpate::geometry
