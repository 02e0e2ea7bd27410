// The stability map as a gnuplot script: nine panels and a strip.
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

constexpr Curve methods[] = {
    {"integrator", "lagged_velocity", "lagged_velocity", "D55E00", 5},
    {"integrator", "semi_implicit_euler", "semi_implicit_euler", "009E73", 9},
    {"integrator", "central_difference", "central_difference", "0072B2", 7}};
constexpr Curve volumes[] = {{"volume", "tetrahedron", "of every tetrahedron", "D55E00", 5},
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

std::string panel(const std::string& title, const std::string& x_label, const char* scale) {
  return "\nunset logscale\nset logscale " + std::string(scale) + "\nset title '" + title +
         "'\nset xlabel '" + x_label + "'\n";
}

// Measured over theoretical limits of every model and damping; equal ones lie on the diagonal.
std::string agreement(const stability::StabilityMap& map) {
  std::vector<std::string> lines{"x with lines linewidth 1.2 linecolor rgb '#909090' notitle"};
  for (const Curve& curve : methods) {
    if (!drawn(map, curve, "rung")) continue;
    lines.push_back("'stability.csv' using " + picked(curve, "rung", "theory_us") + ":" +
                    picked(curve, "rung", "limit_us") + " with points pointsize 0.45 pointtype " +
                    std::to_string(curve.marker) + " linecolor rgb '#" + curve.colour +
                    "' title '" + curve.label + "'");
  }
  return panel("Every rung and damping", "limit by theory, us", "xy") +
         "set xtics 100\nset ytics 100\nset key top left Left reverse samplen 1 spacing 1.1 "
         "font ',8'\nplot \\\n  " +
         joined(lines, ", \\\n  ") + "\nunset key\nset xtics autofreq\nset ytics autofreq\n";
}

std::string strip() {
  std::string text =
      "\nunset logscale\nset key top right horizontal samplen 1 font ',9'\n"
      "set lmargin at screen 0.075\nset rmargin at screen 0.985\n"
      "set tmargin at screen 0.16\nset bmargin at screen 0.055\n"
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
  std::string text = plot::gnuplot_head("stability", 700);
  text +=
      "set datafile separator comma\nset datafile columnheaders\nset datafile missing NaN\n"
      "set border 3 linewidth 1.1 linecolor rgb '#404040'\n"
      "set tics nomirror out scale 0.6 textcolor rgb '#202020' font ',8'\n"
      "set xtics offset 0,0.5\nset ytics offset 0.7,0\n"
      "set grid linetype 1 linewidth 0.5 linecolor rgb '#dcdcdc'\n"
      "set title offset 0,-0.6 font ',10'\nset xlabel offset 0,1.4 font ',9'\n"
      "unset key\n"
      "set format x '%g'\nset format y '%g'\n"
      "set multiplot layout 3,3 margins screen 0.075,0.985,0.275,0.915 spacing screen 0.085,0.105 "
      "title " +
      plot::gnuplot_quoted("Limit of the time step (us), " + title +
                           ": theory as lines, measurements as points") +
      " font ',11'\n";
  text += agreement(map);
  text += panel("Young''s modulus", "Pa", "xy") + "set xtics 1000\n" +
          curves(map, methods, "young_modulus_Pa") + "set xtics autofreq\n";
  text +=
      panel("Volume term of coupled springs", "Poisson''s ratio", "y") +
      "set key bottom left Left reverse samplen 1 spacing 1.1 font ',8'\nset xrange [0:0.52]\n" +
      curves(map, volumes, "poisson_ratio", Legend::own) + "unset key\nset xrange [*:*]\n";
  text +=
      panel("Element size", "shortest edge, mm", "xy") + curves(map, methods, "shortest_edge_mm");
  text += panel("Drag on nodes", "1/s", "xy") + curves(map, methods, "drag_per_s");
  text += panel("Dashpots along springs", "retardation time, s", "xy") +
          curves(map, methods, "retardation_time_s");
  text += panel("Standard linear solid", "relaxation time, s", "x") +
          curves(map, methods, "relaxation_time_s");
  text += panel("Explicit contact", "contact stiffness, N/m", "xy") +
          curves(map, methods, "contact_stiffness_N_per_m");
  text += panel("Haptic frame", "device damping, N s/m", "xy") +
          curves(map, device, "device_damping_N_s_per_m");
  text += strip() + "\nunset multiplot\n";
  return {.name = "stability", .script = text, .reads = {"stability.csv", "failures.csv"}};
}

}  // namespace palpate::stability
