// The stability map as a gnuplot script: nine panels and a strip.
#include "base/text.h"
#include "report/stability_folder.h"

namespace palpate::report {
namespace {

struct Curve {
  const char* column;  // whose word picks the rows
  const char* word;
  const char* label;
  const char* colour;
  int marker;
};

constexpr Curve methods[] = {
    {"integrator", "central_difference", "central_difference", "0072B2", 7},
    {"integrator", "semi_implicit_euler", "semi_implicit_euler", "009E73", 9},
    {"integrator", "lagged_velocity", "lagged_velocity", "D55E00", 5}};
constexpr Curve volumes[] = {{"volume", "tetrahedron", "of every tetrahedron", "D55E00", 5},
                             {"volume", "nodal", "averaged at nodes", "0072B2", 7}};
constexpr Curve device[] = {{"integrator", "zero_order_hold", "frame time", "CC79A7", 7}};

std::string picked(const Curve& curve, const std::string& axis, const char* column) {
  return "(strcol('axis') eq '" + axis + "' && strcol('" + curve.column + "') eq '" + curve.word +
         "' ? column('" + column + "') : NaN)";
}

// Theory as a line through its values, measurements on it; only the first panel has a legend.
std::string curves(std::span<const Curve> all, const std::string& axis, bool legend) {
  std::vector<std::string> lines;
  const std::string file = "'stability.csv' using ";
  for (const Curve& curve : all) {
    const std::string x = picked(curve, axis, "value");
    const std::string colour = std::string("linecolor rgb '#") + curve.colour + "'";
    lines.push_back(file + x + ":" + picked(curve, axis, "theory_us") +
                    " smooth unique with lines linewidth 1.6 " + colour + " notitle");
    lines.push_back(file + x + ":" + picked(curve, axis, "limit_us") +
                    " with points pointsize 0.7 pointtype " + std::to_string(curve.marker) + " " +
                    colour + (legend ? std::string(" title '") + curve.label + "'" : " notitle"));
  }
  return "plot \\\n  " + joined(lines, ", \\\n  ") + "\n";
}

std::string panel(const std::string& title, const std::string& x_label, const char* scale) {
  return "\nunset logscale\nset logscale " + std::string(scale) + "\nset title '" + title +
         "'\nset xlabel '" + x_label + "'\n";
}

// Measured over theoretical limits of every rung and damping, on the diagonal where they agree.
std::string agreement() {
  std::vector<std::string> lines{
      "x with lines linewidth 1.2 linecolor rgb '#909090' title 'theory'"};
  for (const Curve& curve : methods)
    lines.push_back("'stability.csv' using " + picked(curve, "rung", "theory_us") + ":" +
                    picked(curve, "rung", "limit_us") + " with points pointsize 0.7 pointtype " +
                    std::to_string(curve.marker) + " linecolor rgb '#" + curve.colour +
                    "' title '" + curve.label + "'");
  return panel("Every rung and damping", "limit by theory, us", "xy") +
         "set key top left Left reverse samplen 1 spacing 1.1\nplot \\\n  " +
         joined(lines, ", \\\n  ") + "\nunset key\n";
}

std::string strip() {
  std::string text =
      "\nunset logscale\nset key top right horizontal samplen 1\n"
      "set lmargin at screen 0.06\nset rmargin at screen 0.985\n"
      "set tmargin at screen 0.165\nset bmargin at screen 0.055\n"
      "set title 'Kinds of failure, a mark a setting that was tried'\n"
      "unset xlabel\nunset ylabel\nunset ytics\nset xrange [-0.5:7.5]\nset yrange [0:1]\n"
      "set xtics (";
  std::vector<std::string> names;
  std::string index = "NaN";
  for (int i = 1; i <= 8; ++i) {
    const std::string word = study::failure_word(static_cast<study::Failure>(i));
    names.push_back("'" + word + "' " + std::to_string(i - 1));
    index = "word eq '" + word + "' ? " + std::to_string(i - 1) + " : " + index;
  }
  // Marks of one kind stand side by side: each row is moved by its number within the kind.
  text += joined(names, ", ") + ")\nplace(word) = " + index +
          "\nlast = ''\ncount = 0\n"
          "next(word) = (count = word eq last ? count + 1 : 0, last = word, place(word) - 0.3 + "
          "0.12 * count)\n"
          "plot \\\n"
          "  'failures.csv' using (next(strcol('failure'))):(strcol('seen') eq 'yes' ? 0.45 : NaN) "
          "with points pointtype 9 pointsize 1.3 linecolor rgb '#D55E00' title 'it fails', \\\n"
          "  'failures.csv' using (next(strcol('failure'))):(strcol('seen') eq 'yes' ? NaN : 0.45) "
          "with points pointtype 6 pointsize 1.1 linecolor rgb '#009E73' title 'it does not'\n";
  return text;
}

}  // namespace

Script stability_script(const std::string& title) {
  std::string text = script_head("stability", {.width = 1240, .height = 1060});
  text +=
      "set datafile separator comma\nset datafile columnheaders\n"
      "set border 3 linewidth 1.1 linecolor rgb '#404040'\n"
      "set tics nomirror out scale 0.6 textcolor rgb '#202020' font ',12'\n"
      "set grid linetype 1 linewidth 0.5 linecolor rgb '#dcdcdc'\n"
      "set title offset 0,-0.5\nunset key\n"
      "set format x '%g'\nset format y '%g'\nset ylabel 'limit, us'\n"
      "set multiplot layout 3,3 margins screen 0.06,0.985,0.27,0.925 spacing screen 0.06,0.09 "
      "title 'Stability of " +
      title + ": theory as lines, measurements as points'\n";
  text += agreement();
  text += panel("Young''s modulus", "Pa", "xy") + curves(methods, "young_modulus_Pa", false);
  text += panel("Poisson''s ratio, coupled springs", "-", "y") +
          "set key bottom left Left reverse samplen 1\nset xrange [0:0.52]\n" +
          curves(volumes, "poisson_ratio", true) + "unset key\nset xrange [*:*]\n";
  text +=
      panel("Element size", "shortest edge, mm", "xy") + curves(methods, "shortest_edge_mm", false);
  text += panel("Drag on nodes", "1/s", "xy") + curves(methods, "drag_per_s", false);
  text += panel("Dashpots along springs", "retardation time, s", "xy") +
          curves(methods, "retardation_time_s", false);
  text += panel("Standard linear solid", "relaxation time, s", "x") +
          curves(methods, "relaxation_time_s", false);
  text += panel("Explicit contact", "contact stiffness, N/m", "xy") +
          curves(methods, "contact_stiffness_N_per_m", false);
  text += panel("Haptic frame", "device damping, N s/m", "xy") +
          curves(device, "device_damping_N_s_per_m", false);
  text += strip() + "\nunset multiplot\n";
  return {.name = "stability", .text = text, .reads = {"stability.csv", "failures.csv"}};
}

}  // namespace palpate::report
