// gnuplot scripts of the data, model, residuals and profiles.
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "identify/folder.h"
#include "identify/tables.h"
#include "plot/gnuplot_text.h"

namespace palpate::identify {
namespace {

std::string label(const char* name, const Unit& unit) {
  return *unit.symbol == '\0' ? name : std::string(name) + " (" + unit.symbol + ")";
}

std::pair<const char*, const char*> axes(identify::CurveKind kind) {
  switch (kind) {
    case identify::CurveKind::force_travel: return {"Displacement", "Force"};
    case identify::CurveKind::force_time: return {"Time", "Force"};
    case identify::CurveKind::tangential_slide: return {"Slide", "Tangential force"};
    case identify::CurveKind::strain_time: return {"Time", "Strain"};
    case identify::CurveKind::stress_time: return {"Time", "Stress"};
    case identify::CurveKind::stress_strain: return {"Strain", "Stress"};
  }
  return {"", ""};
}

// The power of a thousand in which numbers up to `most` have one to three digits before the point;
// 1 for those from 0.001 on, and for 0.
double power_of_thousand(double most) {
  if (most >= 1e-3 || most == 0.0) return 1.0;
  return std::pow(10.0, 3.0 * std::floor(std::log10(most) / 3.0));
}

// `, 10^-12` for numbers that are drawn divided by such a power.
std::string power_text(double scale) { return scale == 1.0 ? "" : ", " + plot::tick_text(scale); }

double largest_residual(const Identification& found) {
  double most = 0.0;
  for (std::size_t i = 0; i < found.x.size(); ++i)
    most = std::max(most, std::abs(found.measured[i] - found.model[i]));
  return words_of(found.kind).y.from_si(most);
}

// Whether the values are positive but for some noise, which needs no tick below zero.
bool noise_about_zero(const Identification& found) {
  const auto [low, high] = std::minmax_element(found.measured.begin(), found.measured.end());
  return low != found.measured.end() && *low < 0.0 && -*low < *high / 20.0;
}

}  // namespace

plot::Sheet identified_sheet(const std::string& title, const identify::Identification& found,
                             const std::string& suffix) {
  const identify::CurveWords& words = identify::words_of(found.kind);
  const auto [x, y] = axes(found.kind);
  const std::string table = "residuals" + suffix + ".csv";
  const std::string file = "'" + table + "' using 1";
  std::string text = plot::gnuplot_head("curve" + suffix, {.height = 660, .tick_font = 12}) +
                     "set datafile missing NaN\nset multiplot\nset lmargin at screen 0.2\nset "
                     "rmargin at screen 0.97\n";
  text += "set title " + plot::gnuplot_quoted(title + ": measured and fitted") +
          "\nset tmargin at screen 0.91\nset bmargin at screen 0.42\n"
          "set format x ''\nset ylabel " +
          plot::gnuplot_quoted(label(y, words.y)) +
          "\nset key top left Left reverse samplen 2 spacing 1.2\n" +
          (noise_about_zero(found) ? "set autoscale yfixmin\n" : "") + "plot \\\n  " + file +
          ":2 with points pointtype 7 pointsize 0.4 linecolor rgb '#0072B2' title 'measured', \\\n"
          "  " +
          file +
          ":3 smooth unique with lines linewidth 1.6 linecolor rgb '#D55E00' title 'model'\n";
  const double scale = power_of_thousand(largest_residual(found));
  text +=
      "unset title\nunset key\nset autoscale y\nset tmargin at screen 0.38\nset bmargin at screen "
      "0.13\n"
      "set format x '%.10g'\nset xlabel " +
      plot::gnuplot_quoted(label(x, words.x)) + "\nset ylabel " +
      plot::gnuplot_quoted(label("Measured - model", words.y) + power_text(scale)) +
      "\nplot \\\n  0 with lines linewidth 1 linecolor rgb '#808080', \\\n  " + file + ":($4 / " +
      rounded_text(scale, 3) +
      ") with points pointtype 7 pointsize 0.4 linecolor rgb '#0072B2'\nunset multiplot\n";
  return {.name = "curve" + suffix, .script = text, .reads = {table}};
}

namespace {

struct ProfileAxis {
  double origin;  // subtracted from the values
  double scale;   // divides what is left
};

// Where the values differ in the fourth digit or later, which the numbers at the axis would not
// show, the axis is the difference from the estimate.
ProfileAxis profile_axis(const Identification& found, std::size_t i) {
  const Unknown& unknown = found.unknowns[i].unknown;
  const double estimate = unknown.shown(found.unknowns[i].estimate);
  double far = 0.0;
  for (const ProfilePoint& point : found.profile)
    if (point.unknown == i) far = std::max(far, std::abs(unknown.shown(point.value) - estimate));
  if (!(far < 1e-3 * std::abs(estimate))) return {0.0, 1.0};
  return {estimate, power_of_thousand(far)};
}

}  // namespace

plot::Sheet profile_sheet(const std::string& title, const identify::Identification& found) {
  const std::size_t panels = found.unknowns.size();
  std::string text = plot::gnuplot_head("profile", {.height = static_cast<int>(60 + 270 * panels)});
  text += "set datafile missing NaN\nset multiplot layout " + std::to_string(panels) + ",1 title " +
          plot::gnuplot_quoted(title + ": profile likelihood, 95 % below the line") +
          "\nunset key\nset ylabel '(SSE - least SSE) / s^2'\nset rmargin 4\n"
          "set yrange [0:*]\n";
  for (std::size_t i = 0; i < panels; ++i) {
    const identify::Identified& one = found.unknowns[i];
    const std::string unit = one.unknown.unit_text();
    const auto [origin, scale] = profile_axis(found, i);
    const std::string pick = "(strcol('unknown') eq '" + one.unknown.name() +
                             "' ? (column('value') - " + number_text(origin) + ") / " +
                             number_text(scale) + " : NaN)";
    text += "set xlabel " +
            plot::gnuplot_quoted(one.unknown.name() +
                                 (origin == 0.0 ? "" : " - " + rounded_text(origin, 4)) +
                                 (unit.empty() ? "" : " (" + unit + ")") + power_text(scale)) +
            " noenhanced\nplot \\\n  'profile.csv' using " + pick +
            ":(column('threshold')) with lines linewidth 1 linecolor rgb '#808080', \\\n"
            "  'profile.csv' using " +
            pick +
            ":(column('delta')) with linespoints pointtype 7 pointsize 0.5 linewidth 1.4 linecolor "
            "rgb '#0072B2'\n";
  }
  text += "unset multiplot\n";
  return {.name = "profile", .script = text, .reads = {"profile.csv"}};
}

}  // namespace palpate::identify
