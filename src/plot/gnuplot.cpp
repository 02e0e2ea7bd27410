// Runs gnuplot, which may be missing, fail, or not end.
#include "plot/gnuplot.h"

#include <unistd.h>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <system_error>

#include "base/child_process.h"
#include "base/error.h"
#include "base/files.h"
#include "base/stop_scope.h"
#include "base/text.h"
#include "base/written.h"
#include "plot/gnuplot_text.h"

namespace palpate::plot {
namespace {

namespace fs = std::filesystem;

constexpr const char* was_not_drawn = " was not drawn in ";

// What gnuplot says last, which is the reason; before it stand the script's line and warnings. That
// it widens the range about a curve of one value says nothing: the picture is complete.
std::string last_line(const std::string& output) {
  std::string last;
  for (const std::string& line : split(output, '\n'))
    if (!trimmed(line).empty() && line.find(" range [") == std::string::npos) last = trimmed(line);
  return last;
}

// Why no picture was drawn, as the middle of a sentence; empty on success.
std::string failure(const ChildResult& result, const DrawOptions& options) {
  const std::string program = "`" + options.program + "` ";
  switch (result.end) {
    case ChildResult::End::not_found: return program + "is not installed";
    case ChildResult::End::timed_out:
      return program + "took longer than " + rounded_text(options.limit) + " s";
    case ChildResult::End::killed:
      return program + "was ended by signal " + std::to_string(result.code);
    case ChildResult::End::stopped: return "the drawing was interrupted";
    case ChildResult::End::exited: break;
  }
  if (result.code == 0) return {};
  const std::string said = last_line(result.output);
  return program + "failed " +
         (said.empty() ? "with exit code " + std::to_string(result.code) : "(" + said + ")");
}

std::string remedy(const ChildResult& result, const std::string& script) {
  if (result.end == ChildResult::End::not_found)
    return "; install gnuplot (Debian: gnuplot-nox) and run `gnuplot " + script + "` there";
  return "; run `gnuplot " + script + "` there to see why";
}

// The first file that the script reads and that is missing; gnuplot would omit its curves.
std::optional<std::string> missing_file(const Sheet& sheet, const fs::path& folder) {
  for (const std::string& file : sheet.reads)
    if (!fs::exists(folder / file)) return file;
  return std::nullopt;
}

struct Picture {
  bool drawn = false;
  std::string warning = {};
};

// Draws one picture into a temporary file and renames it.
Picture draw_picture(const Sheet& sheet, const std::string& format, const std::string& folder,
                     const DrawOptions& options) {
  const std::string script = sheet.name + ".gp";
  const std::string picture = sheet.name + "." + format;
  const std::string beside = picture + ".part" + std::to_string(::getpid());
  const std::string not_drawn = picture + was_not_drawn + folder + ": ";
  if (const auto file = missing_file(sheet, folder))
    return {false, not_drawn + "`" + *file + "` is missing; run the scenario again"};
  if (StopScope::stopped()) return {false, not_drawn + "the drawing was interrupted"};
  // -d: without the user's gnuplot settings.
  const ChildResult result =
      run_process({.argv = {options.program, "-d", "-e",
                            "format='" + format + "'; target='" + beside + "'", script},
                   .folder = folder,
                   .limit = options.limit});
  const fs::path from = fs::path(folder) / beside;
  const std::string why = failure(result, options);
  std::error_code error;
  if (why.empty()) fs::rename(from, fs::path(folder) / picture, error);
  if (error) throw SystemError(not_drawn + "it cannot be renamed (" + error.message() + ")");
  if (!why.empty()) {
    fs::remove(from, error);
    return {false, not_drawn + why + remedy(result, script)};
  }
  const std::string said = last_line(result.output);
  if (said.empty()) return {true, {}};
  return {true, picture + " in " + folder + " may not be complete; gnuplot said: " + said};
}

}  // namespace

Sheet sheet_of(const Figure& figure) {
  Sheet sheet{figure.name, gnuplot_script(figure), {}};
  for (const Series& series : figure.series) sheet.reads.push_back(series.csv_file);
  return sheet;
}

Drawing draw(const Sheet& sheet, const std::string& folder, const DrawOptions& options) {
  Drawing drawing;
  const std::string script = sheet.name + ".gp";
  write_atomically((fs::path(folder) / script).string(), sheet.script, Disk::later);
  drawing.files.push_back(script);
  for (const std::string& format : options.formats) {
    const Picture picture = draw_picture(sheet, format, folder, options);
    if (picture.drawn) drawing.files.push_back(sheet.name + "." + format);
    if (!drawing.warning.empty() && !picture.warning.empty()) drawing.warning += "\n";
    drawing.warning += picture.warning;
  }
  return drawing;
}

std::string missing_figures(const std::vector<std::string>& warnings) {
  std::size_t count = 0;
  for (const std::string& warning : warnings)
    for (auto at = warning.find(was_not_drawn); at != std::string::npos;
         at = warning.find(was_not_drawn, at + 1))
      ++count;
  if (count == 0) return {};
  return "; " + std::to_string(count) +
         (count == 1 ? " figure was not drawn" : " figures were not drawn");
}

void draw(const Sheet& sheet, WholeFolder& folder, std::vector<std::string>& warnings,
          const DrawOptions& options) {
  const Drawing drawing = draw(sheet, folder.partial(), options);
  folder.add(drawing.files);
  if (!drawing.warning.empty()) warnings.push_back(drawing.warning);
}

namespace {

// The colour of a fit: that of its data, darker, so that it is visible on top of them.
std::string darker(const std::string& colour) {
  constexpr double share = 0.6;
  std::string text;
  for (std::size_t at = 0; at < 6; at += 2)
    text += hex_text(static_cast<unsigned char>(share * std::stoi(colour.substr(at, 2), {}, 16)));
  return text;
}

std::string label(const Series& series) {
  if (!series.label.empty()) return series.label;
  return series.scale == 1.0 ? series.case_name
                             : series.case_name + " × " + number_text(series.scale);
}

// The legend stands below the plot, which keeps its width, and makes the picture higher.
struct Legend {
  std::vector<std::string> labels = {};  // in the order of the series, each once
  std::size_t lines = 0;
  std::size_t rows = 0;  // where several labels stand side by side; 0: one line is enough
  std::string title = {};

  explicit Legend(const Figure& figure) {
    std::size_t longest = 0;
    bool fits = false;
    for (const Series& series : figure.series) {
      fits = fits || !series.fits.empty();
      if (std::ranges::find(labels, label(series)) == labels.end()) labels.push_back(label(series));
      longest = std::max(longest, letter_count(labels.back()));
    }
    if (labels.size() == 1 && !fits) return;
    lines = labels.size() + (fits ? 1 : 0);
    title = figure.legend;
    if (fits) longest = std::max(longest, letter_count(figure.fit_label));
    constexpr std::size_t short_label = 12;
    if (figure.bar && longest <= short_label) return;
    constexpr std::size_t letters_of_a_row = 64, sample = 8;
    const std::size_t columns = std::max<std::size_t>(1, letters_of_a_row / (longest + sample));
    rows = (lines + columns - 1) / columns;
  }

  [[nodiscard]] int height() const {
    constexpr int plot = 400, line = 20;
    if (lines == 0) return plot;
    return plot + (rows > 0 ? line * static_cast<int>(rows) : 60) + (title.empty() ? 0 : line);
  }
};

std::string frame(const Figure& figure, const Legend& legend) {
  std::string text = "set title " + gnuplot_title(figure.title) + "\nset xlabel " +
                     gnuplot_quoted(figure.x_label) + "\nset ylabel " +
                     gnuplot_quoted(figure.y_label) + "\nset tmargin 2.5\nset samples 500\n";
  if (legend.lines == 0)
    text += "unset key\nset rmargin 3\n";
  else if (legend.rows > 0)
    text += "set key below vertical maxrows " + std::to_string(legend.rows) +
            " height 1 Left reverse samplen 2.6 spacing 1.25\nset rmargin 3\n";
  else
    text += "set key below horizontal height 1 Left reverse samplen 2.6 spacing 1.25\n";
  if (!legend.title.empty())  // over the entries, below an empty line
    text += "set key height 0 title " + gnuplot_quoted(legend.title) + " left\nset xlabel " +
            gnuplot_quoted(figure.x_label) + ".\"\\n \" offset 0,0.4\n";
  if (figure.from_zero && figure.y_axis == Axis::linear) text += "set yrange [*<0:0<*]\n";
  const auto logarithmic = [&](const std::string& axis, double low, double high) {
    text += "set " + axis + "range [" + rounded_text(low, 6) + ":" + rounded_text(high, 6) + "]\n" +
            gnuplot_logarithmic(axis, low, high);
  };
  if (figure.x_axis == Axis::logarithmic) logarithmic("x", figure.x_low, figure.x_high);
  if (figure.y_axis == Axis::logarithmic) logarithmic("y", figure.y_low, figure.y_high);
  if (figure.bar) {
    const ColourBar& bar = *figure.bar;
    text += gnuplot_palette(brightest_line) + "set cbrange [" + number_text(bar.low) + ":" +
            number_text(bar.high) + "]\nset cblabel " + gnuplot_quoted(bar.label) +
            " offset 1,0\nset colorbox\n";
    if (bar.scale == Axis::logarithmic) text += gnuplot_logarithmic("cb", bar.low, bar.high);
  }
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
  if (series.x_from) {
    if (!condition.empty()) condition += " && ";
    condition += x + " >= " + number_text(*series.x_from);
  }
  return condition.empty() ? "(" + x + ")" : "(" + condition + " ? " + x + " : NaN)";
}

// Many cases of one file: gnuplot reads it once and keeps the rows of these cases, each with its
// place in a text of their names, for it would read the whole file for each of them.
struct KeptRows {
  std::string names = {};  // empty: each series reads its file

  explicit KeptRows(const Figure& figure) {
    constexpr std::size_t many = 8;
    if (figure.series.size() <= many) return;
    const Series& first = figure.series.front();
    std::string all = "|";
    for (const Series& one : figure.series) {
      const bool plain = std::ranges::all_of(
          one.case_name, [](char c) { return c >= ' ' && c <= '~' && c != '|'; });
      if (!plain || one.case_name.empty() || one.step || one.x_from ||
          one.csv_file != first.csv_file || one.column != first.column ||
          one.x_column != first.x_column || one.y_column != first.y_column)
        return;
      all += one.case_name + "|";
    }
    names = all;
  }

  [[nodiscard]] std::string text(const Figure& figure) const {
    if (names.empty()) return {};
    const Series& one = figure.series.front();
    return "cases = " + gnuplot_quoted(names) +
           "\nplace(name) = strstrt(cases, '|'.name.'|')\nset table $rows separator comma\nplot " +
           gnuplot_quoted(one.csv_file) + " using (place(strcol(" + gnuplot_quoted(one.column) +
           "))):(" + gnuplot_column(one.x_column) + "):(" + gnuplot_column(one.y_column) +
           ") with table if (place(strcol(" + gnuplot_quoted(one.column) +
           ")) > 0)\nunset table\nunset datafile columnheaders\n";
  }

  // What is plotted of a series, without `using` its y.
  [[nodiscard]] std::string x_of(const Series& series) const {
    if (names.empty())
      return gnuplot_quoted(series.csv_file) + " using " + x_expression(series) + ":";
    return "$rows using ($1 == " + std::to_string(names.find("|" + series.case_name + "|") + 1) +
           " ? $2 : NaN):";
  }
  // The number of a column alone takes gnuplot no system calls for each row, as an expression does.
  [[nodiscard]] std::string y_of(const Series& series) const {
    if (!names.empty() && series.scale == 1.0) return "3";
    const std::string y = names.empty() ? gnuplot_column(series.y_column) : "$3";
    return "(" + scaled(series.scale, y) + ")";
  }
};

// How a series is drawn: by its place in the list, or by its shade and its label.
struct Look {
  std::string colour;
  std::size_t marker = 0;
};
Look look_of(const Figure& figure, const Legend& legend, std::size_t i) {
  const Series& series = figure.series[i];
  if (!figure.bar || !series.shade)
    return {line_colours[series.colour.value_or(i) % line_colours.size()], i};
  const ColourBar& bar = *figure.bar;
  const auto onto = [&](double value) {
    return bar.scale == Axis::logarithmic ? std::log(value) : value;
  };
  const double width = onto(bar.high) - onto(bar.low);
  const double share = width > 0.0 ? (onto(*series.shade) - onto(bar.low)) / width : 0.5;
  const auto place = std::ranges::find(legend.labels, label(series));
  return {palette_colour(brightest_line * share),
          static_cast<std::size_t>(place - legend.labels.begin())};
}

std::string point_style(std::size_t marker) {
  return " pointtype " + std::to_string(gnuplot_markers[marker % gnuplot_markers.size()]) +
         " pointsize 0.55 pointnumber 14";
}

std::string data_line(const Figure& figure, const Legend& legend, const KeptRows& kept,
                      std::size_t i) {
  const Series& series = figure.series[i];
  const Look look = look_of(figure, legend, i);
  const std::string width = figure.bar ? "1.8" : "3.5";
  // What was measured is drawn as points, what was computed as a line.
  if (series.y_column.starts_with("measured_"))
    return kept.x_of(series) + kept.y_of(series) + " with points linewidth 1.6 linecolor rgb '#" +
           look.colour + "' pointtype 7 pointsize 0.4 title " + gnuplot_quoted(label(series));
  if (series.dashed)
    return kept.x_of(series) + kept.y_of(series) +
           " with lines linewidth 2 dashtype (7,4) linecolor rgb '#" + look.colour + "' title " +
           gnuplot_quoted(label(series));
  return kept.x_of(series) + kept.y_of(series) + " with linespoints linewidth " + width +
         " linecolor rgb '#" + look.colour + "'" + point_style(look.marker) +
         (figure.bar || legend.lines == 0 ? " notitle" : " title " + gnuplot_quoted(label(series)));
}

std::string fit_line(const Series& series, const FittedCurve& fit, const std::string& function,
                     const std::string& colour) {
  const std::string x = fit.origin == 0.0 ? "x" : "x - (" + number_text(fit.origin) + ")";
  return "[" + number_text(fit.from) + ":" + number_text(fit.to) + "] " +
         scaled(series.scale, function + "(" + x + ")") +
         " with lines linewidth 1.8 dashtype (7,4) linecolor rgb '#" + colour +
         "' notitle noautoscale";
}

}  // namespace

std::string gnuplot_script(const Figure& figure) {
  const Legend legend(figure);
  const KeptRows kept(figure);
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < figure.series.size(); ++i)
    lines.push_back(data_line(figure, legend, kept, i));
  if (figure.bar) {
    for (std::size_t k = 0; k < legend.labels.size() && legend.lines > 0; ++k)
      lines.push_back("keyentry with linespoints linewidth 1.8 linecolor rgb '#505050'" +
                      point_style(k) + " title " + gnuplot_quoted(legend.labels[k]));
    lines.push_back("NaN with lines linecolor palette notitle");  // without it there is no bar
  }
  const std::size_t data_lines = lines.size();
  for (std::size_t i = 0; i < figure.series.size(); ++i)
    for (std::size_t k = 0; k < figure.series[i].fits.size(); ++k)
      lines.push_back(fit_line(figure.series[i], figure.series[i].fits[k], function_name(i, k),
                               darker(look_of(figure, legend, i).colour)));
  if (lines.size() > data_lines)  // one legend entry for all fits
    lines.push_back("NaN with lines linewidth 1.8 dashtype (7,4) linecolor rgb '#404040' title " +
                    gnuplot_quoted(figure.fit_label));
  const std::string plot = "plot \\\n  " + joined(lines, ", \\\n  ") + "\n";
  return gnuplot_head(figure.name, {.height = legend.height()}) + frame(figure, legend) +
         functions(figure) + kept.text(figure) +
         gnuplot_ticks(plot, std::string(figure.x_axis == Axis::linear ? "x" : "") +
                                 (figure.y_axis != Axis::linear ? ""
                                  : figure.from_zero            ? "y0"
                                                                : "y"));
}

}  // namespace palpate::plot
