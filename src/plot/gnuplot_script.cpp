// The text of a gnuplot script.
#include <algorithm>
#include <cstddef>

#include "base/text.h"
#include "plot/gnuplot.h"
#include "plot/gnuplot_text.h"

namespace palpate::plot {
namespace {

// Opacity of the data lines, so that a fit on top of them is visible.
constexpr const char* pale = "70";

std::string frame(const Figure& figure) {
  std::string text =
      "set datafile separator comma\n"
      "set datafile columnheaders\n"
      "set title " +
      gnuplot_quoted(figure.title) +
      "\n"
      "set xlabel " +
      gnuplot_quoted(figure.x_label) +
      "\n"
      "set ylabel " +
      gnuplot_quoted(figure.y_label) +
      "\n"
      "set border 3 linewidth 1.2 linecolor rgb '#404040'\n"
      "set tics nomirror out scale 0.6 textcolor rgb '#202020'\n"
      "set grid linetype 1 linewidth 0.6 linecolor rgb '#dcdcdc'\n"
      "set key outside right top Left reverse samplen 2.6 spacing 1.25 width -2\n"
      "set tmargin 2.5\n"
      "set samples 500\n";
  if (figure.y_axis == Axis::logarithmic) text += "set logscale y\nset format y '%g'\n";
  return text;
}

std::string function_name(std::size_t series, std::size_t fit) {
  return "fit_" + std::to_string(series + 1) + "_" + std::to_string(fit + 1);
}

std::string functions(const Figure& figure) {
  std::string text;
  for (std::size_t i = 0; i < figure.series.size(); ++i)
    for (std::size_t k = 0; k < figure.series[i].fits.size(); ++k)
      text += function_name(i, k) + "(x) = " + figure.series[i].fits[k].formula + "\n";
  return text;
}

std::string scaled(double scale, const std::string& value) {
  return scale == 1.0 ? value : number_text(scale) + "*" + value;
}

std::string label(const Series& series) {
  if (!series.label.empty()) return series.label;
  return series.scale == 1.0 ? series.case_name
                             : series.case_name + " × " + number_text(series.scale);
}

// The x of a series' rows; for other rows it is NaN, so that gnuplot skips them.
std::string x_expression(const Series& series) {
  const std::string x = gnuplot_column(series.x_column);
  std::string condition;
  if (!series.case_name.empty())
    condition =
        "strcol(" + gnuplot_quoted(series.column) + ") eq " + gnuplot_quoted(series.case_name);
  if (series.step) {
    if (!condition.empty()) condition += " && ";
    condition += "column('step') == " + std::to_string(*series.step);
  }
  return condition.empty() ? "(" + x + ")" : "(" + condition + " ? " + x + " : NaN)";
}

std::string data_line(const Series& series, std::size_t i) {
  const std::string colour = gnuplot_colours[i % gnuplot_colours.size()];
  const std::string data = gnuplot_quoted(series.csv_file) + " using " + x_expression(series) +
                           ":(" + scaled(series.scale, gnuplot_column(series.y_column)) + ")";
  // What was measured is drawn as points, what was computed as a line.
  if (series.y_column.starts_with("measured_"))
    return data + " with points linewidth 1.2 linecolor rgb '#" + colour +
           "' pointtype 6 pointsize 0.5 title " + gnuplot_quoted(label(series));
  return data + " with linespoints linewidth 3.5 linecolor rgb '#" + pale + colour +
         "' pointtype " + std::to_string(gnuplot_markers[i % gnuplot_markers.size()]) +
         " pointsize 0.55 pointnumber 14 title " + gnuplot_quoted(label(series));
}

std::string fit_line(const Series& series, const FittedCurve& fit, const std::string& function,
                     std::size_t i) {
  const std::string x = fit.origin == 0.0 ? "x" : "x - (" + number_text(fit.origin) + ")";
  return "[" + number_text(fit.from) + ":" + number_text(fit.to) + "] " +
         scaled(series.scale, function + "(" + x + ")") +
         " with lines linewidth 1.8 dashtype (7,4) linecolor rgb '#" +
         std::string(gnuplot_colours[i % gnuplot_colours.size()]) + "' notitle noautoscale";
}

}  // namespace

std::string gnuplot_column(const std::string& name) {
  return "column(" + gnuplot_quoted(name) + ")";
}

// A text that begins with an apostrophe would be read as an empty one, with a word behind it.
// Double quotes are for such apostrophes only, because gnuplot runs commands in them.
std::string gnuplot_quoted(const std::string& text) {
  const std::size_t first = std::min(text.find_first_not_of('\''), text.size());
  std::string result = first == 0 ? "'" : "\"" + text.substr(0, first) + "\".'";
  for (const char c : text.substr(first)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7f)
      result += ' ';
    else if (c == '\'')
      result += "''";
    else
      result += c;
  }
  return result + "'";
}

std::string gnuplot_head(const std::string& name, int height) {
  const std::string script = name + ".gp";
  return "# Run in this folder: gnuplot " + script +
         "\n"
         "# For a PDF: gnuplot -e \"format='pdf'\" " +
         script +
         "\n"
         "if (!exists(\"format\")) format = 'svg'\n"
         "if (!exists(\"target\")) target = " +
         gnuplot_quoted(name + ".") +
         ".format\n"
         "if (format eq 'pdf') {\n"
         "  set terminal pdfcairo noenhanced size 18cm," +
         rounded_text(0.022 * height, 3) +
         "cm font 'sans-serif,11' linewidth 1.1\n"
         "} else {\n"
         "  set terminal svg noenhanced size 820," +
         std::to_string(height) + " font 'sans-serif,15' name " + gnuplot_quoted(name) +
         " background '#ffffff'\n"
         "}\n"
         "set encoding utf8\n"
         "set output target\n";
}

std::string gnuplot_script(const Figure& figure) {
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < figure.series.size(); ++i)
    lines.push_back(data_line(figure.series[i], i));
  const std::size_t data_lines = lines.size();
  for (std::size_t i = 0; i < figure.series.size(); ++i)
    for (std::size_t k = 0; k < figure.series[i].fits.size(); ++k)
      lines.push_back(fit_line(figure.series[i], figure.series[i].fits[k], function_name(i, k), i));
  if (lines.size() > data_lines)  // one legend entry for all fits
    lines.push_back("NaN with lines linewidth 1.8 dashtype (7,4) linecolor rgb '#404040' title " +
                    gnuplot_quoted(figure.fit_label));
  return gnuplot_head(figure.name, 500) + frame(figure) + functions(figure) + "plot \\\n  " +
         joined(lines, ", \\\n  ") + "\n";
}

}  // namespace palpate::plot
