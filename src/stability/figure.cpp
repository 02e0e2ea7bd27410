// The stability map as a gnuplot script: nine panels and a strip.
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "plot/gnuplot_text.h"
#include "stability/stability.h"

namespace palpate::stability {
namespace {

struct Curve {
  const char* column;  // the rows that contain `word` in this column are drawn
  const char* word;
  const char* label;
  const char* colour;
  int marker;
};

constexpr Curve method_curves[] = {
    {"integrator", "lagged_velocity", "lagged_velocity", "D55E00", 5},
    {"integrator", "semi_implicit_euler", "semi_implicit_euler", "009E73", 9},
    {"integrator", "central_difference", "central_difference", "0072B2", 7}};
constexpr Curve volume_curves[] = {{"volume", "tetrahedron", "of every tetrahedron", "D55E00", 5},
                                   {"volume", "nodal", "averaged at nodes", "0072B2", 7}};
constexpr Curve device[] = {{"integrator", "zero_order_hold", "frame time", "CC79A7", 7}};

// Whether the map has points of the curve on this axis; gnuplot warns of curves without points.
bool drawn(const stability::StabilityMap& map, const Curve& curve, const std::string& axis) {
  const bool by_volume = std::string("volume") == curve.column;
  for (const stability::LimitRow& row : map.limits)
    if (row.axis == axis && row.measured && row.theory &&
        (by_volume ? row.volume : row.integrator) == curve.word)
      return true;
  return false;
}

std::string picked(const Curve& curve, const std::string& axis, const char* column) {
  return "(strcol('axis') eq '" + axis + "' && strcol('" + curve.column + "') eq '" + curve.word +
         "' ? column('" + column + "') : NaN)";
}

// Theory as a line, measurements as points. The panel of an axis without rows stays empty.
enum class Legend { none, own };
std::string curves(const stability::StabilityMap& map, std::span<const Curve> all,
                   const std::string& axis, Legend legend = Legend::none) {
  std::vector<std::string> lines;
  const std::string file = "'stability.csv' using ";
  for (const Curve& curve : all) {
    if (!drawn(map, curve, axis)) continue;
    const std::string x = picked(curve, axis, "value");
    const std::string colour = std::string("linecolor rgb '#") + curve.colour + "'";
    lines.push_back(file + x + ":" + picked(curve, axis, "theory_us") +
                    " smooth unique with lines linewidth 1.2 " + colour + " notitle");
    lines.push_back(
        file + x + ":" + picked(curve, axis, "limit_us") +
        " with points pointsize 0.45 pointtype " + std::to_string(curve.marker) + " " + colour +
        (legend == Legend::own ? std::string(" title '") + curve.label + "'" : " notitle"));
  }
  if (lines.empty()) return "set multiplot next\n";
  return "plot \\\n  " + joined(lines, ", \\\n  ") + "\n";
}

// The least and the largest of positive numbers.
struct Range {
  double low = INFINITY, high = 0.0;
  void take(double value) {
    if (!(value > 0.0) || !std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  // With a margin on both sides; from 1 to 10 if there are no numbers.
  [[nodiscard]] Range wide() const {
    if (!(high > 0.0)) return {1.0, 10.0};
    return {low / 1.3, high * 1.3};
  }
};

std::string scaled(const char* axis, const Range& range) {
  const Range wide = range.wide();
  return std::string("set ") + axis + "range [" + rounded_text(wide.low, 4) + ":" +
         rounded_text(wide.high, 4) + "]\n" + plot::gnuplot_logarithmic(axis, wide.low, wide.high);
}

enum class Scale { linear_x, linear_y, logarithmic };

// The frame of a panel. `axis` names the rows whose range it shows.
std::string panel(const stability::StabilityMap& map, const std::string& axis, Scale scale,
                  const std::string& title, const std::string& x_label) {
  Range x, y;
  for (const stability::LimitRow& row : map.limits) {
    if (row.axis != axis || !row.measured || !row.theory) continue;
    y.take(1e6 * *row.measured);
    y.take(1e6 * *row.theory);
    x.take(axis == "rung" ? 1e6 * *row.theory : row.value.value_or(0.0));
  }
  std::string text = "\n" + plot::gnuplot_linear("x") + plot::gnuplot_linear("y") +
                     "set xrange [*:*]\nset yrange [*:*]\n";
  if (scale != Scale::linear_x) text += scaled("x", x);
  if (scale != Scale::linear_y) text += scaled("y", y);
  return text + "set title " + plot::gnuplot_quoted(title) + "\nset xlabel " +
         plot::gnuplot_quoted(x_label) + "\n";
}

// Measured over theoretical limits of every model and damping; equal ones lie on the diagonal.
std::string agreement(const stability::StabilityMap& map) {
  std::vector<std::string> lines{"x with lines linewidth 1.2 linecolor rgb '#909090' notitle"};
  for (const Curve& curve : method_curves) {
    if (!drawn(map, curve, "rung")) continue;
    lines.push_back("'stability.csv' using " + picked(curve, "rung", "theory_us") + ":" +
                    picked(curve, "rung", "limit_us") + " with points pointsize 0.45 pointtype " +
                    std::to_string(curve.marker) + " linecolor rgb '#" + curve.colour +
                    "' title '" + curve.label + "'");
  }
  return panel(map, "rung", Scale::logarithmic, "Every model and damping", "limit by theory, µs") +
         "set key at screen 0.5, screen 0.955 center top vertical maxrows 1 Left reverse samplen 1 "
         "font ',12'\n"
         "plot \\\n  " +
         joined(lines, ", \\\n  ") + "\nunset key\n";
}

std::string strip() {
  std::string text =
      "\n" + plot::gnuplot_linear("x") + plot::gnuplot_linear("y") +
      "set key default top right horizontal Left reverse samplen 1 font ',12'\n"
      "set lmargin at screen 0.075\nset rmargin at screen 0.985\n"
      "set tmargin at screen 0.16\nset bmargin at screen 0.045\n"
      "set title 'Kinds of failure: one mark per setting that was tried'\n"
      "unset xlabel\nunset ylabel\nunset ytics\nset xrange [-0.5:7.5]\nset yrange [0:1]\n"
      "set xtics (";
  std::vector<std::string> names;
  std::string index = "NaN";
  for (int i = 1; i <= 8; ++i) {
    const std::string word = stability::failure_word(static_cast<stability::Failure>(i));
    names.push_back("'" + word + "' " + std::to_string(i - 1));
    index = "word eq '" + word + "' ? " + std::to_string(i - 1) + " : " + index;
  }
  // Marks of one kind are drawn side by side, shifted by their number within the kind.
  text += joined(names, ", ") + ")\nplace(word) = " + index +
          "\nlast = ''\ncount = 0\n"
          "next(word) = (count = word eq last ? count + 1 : 0, last = word, place(word) - 0.3 + "
          "0.12 * count)\n"
          "plot \\\n"
          "  'failures.csv' using (next(strcol('failure'))):(strcol('seen') eq 'yes' ? 0.45 : NaN) "
          "with points pointtype 9 pointsize 0.8 linecolor rgb '#D55E00' title 'it fails', \\\n"
          "  'failures.csv' using (next(strcol('failure'))):(strcol('seen') eq 'yes' ? NaN : 0.45) "
          "with points pointtype 6 pointsize 0.7 linecolor rgb '#009E73' title 'it does not'\n";
  return text;
}

}  // namespace

plot::Sheet stability_sheet(const std::string& title, const stability::StabilityMap& map) {
  std::string text = plot::gnuplot_head("stability", 960, 11);
  text +=
      "set datafile missing NaN\nset xtics offset 0,0.3\nset ytics offset 0.5,0\n"
      "set title offset 0,-0.6 font ',13'\nset xlabel offset 0,0.9 font ',12'\nunset key\n"
      "set multiplot layout 3,3 margins screen 0.075,0.985,0.255,0.89 spacing screen 0.085,0.085 "
      "title " +
      plot::gnuplot_quoted("Limit of the time step (µs), " + title +
                           ": theory as lines, measurements as points") +
      " font ',14'\n";
  text += agreement(map);
  const auto of_methods = [&](const char* axis, Scale scale, const char* heading,
                              const char* x_label) {
    text += panel(map, axis, scale, heading, x_label) + curves(map, method_curves, axis);
  };
  of_methods("young_modulus_Pa", Scale::logarithmic, "Young's modulus", "Pa");
  text += panel(map, "poisson_ratio", Scale::linear_x, "Volume term of coupled springs",
                "Poisson's ratio") +
          "set key default bottom left Left reverse samplen 1 spacing 1.1 font ',11'\nset xrange "
          "[0:0.52]\n"
          "set xtics 0.1\n" +
          curves(map, volume_curves, "poisson_ratio", Legend::own) +
          "unset key\nset xrange [*:*]\n";
  of_methods("shortest_edge_mm", Scale::logarithmic, "Element size", "shortest edge, mm");
  of_methods("drag_per_s", Scale::logarithmic, "Drag on nodes", "1/s");
  of_methods("retardation_time_s", Scale::logarithmic, "Dashpots along springs",
             "retardation time, s");
  of_methods("relaxation_time_s", Scale::linear_y, "Standard linear solid", "relaxation time, s");
  of_methods("contact_stiffness_N_per_m", Scale::logarithmic, "Explicit contact",
             "contact stiffness, N/m");
  text += panel(map, "device_damping_N_s_per_m", Scale::logarithmic, "Haptic frame",
                "device damping, N s/m") +
          curves(map, device, "device_damping_N_s_per_m");
  text += strip() + "\nunset multiplot\n";
  return {.name = "stability", .script = text, .reads = {"stability.csv", "failures.csv"}};
}

}  // namespace palpate::stability
