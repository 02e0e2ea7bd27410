// The style of all figures, and numbers and texts in gnuplot's language.
#include "plot/gnuplot_text.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"

namespace palpate::plot {
namespace {

// Nine colours of matplotlib's viridis, evenly apart.
constexpr std::array<unsigned, 9> viridis{0x440154, 0x472d7b, 0x3b528b, 0x2c728e, 0x21918c,
                                          0x28ae80, 0x5ec962, 0xaddc30, 0xfde725};

std::string superscript(int power) {
  constexpr std::array<const char*, 10> digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = power < 0 ? "⁻" : "";
  for (const char digit : std::to_string(std::abs(power)))
    text += digits[static_cast<std::size_t>(digit - '0')];
  return text;
}

}  // namespace

std::vector<std::size_t> tissue_colours(const std::vector<std::string>& tissues) {
  std::vector<std::string> known{"skin", "muscle", "ligament", "bone", "upper_leg"};
  std::vector<std::size_t> places;
  for (const std::string& tissue : tissues) {
    const auto place = std::ranges::find(known, tissue);
    places.push_back(static_cast<std::size_t>(place - known.begin()));
    if (place == known.end()) known.push_back(tissue);
  }
  return places;
}

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

std::string gnuplot_title(const std::string& title) {
  constexpr double most = 60.0;  // letters in the usual size
  if (static_cast<double>(title.size()) <= most) return gnuplot_quoted(title);
  return gnuplot_quoted(title) + " font '," +
         rounded_text(15.0 * most / static_cast<double>(title.size()), 3) + "'";
}

std::string key_label(std::string key) {
  for (const std::string table : {"tissue.", "contact.", "solver."})
    if (key.starts_with(table)) key.erase(0, table.size());
  std::ranges::replace_if(
      key, [](char c) { return c == '.' || c == '_'; }, ' ');
  for (const std::string name : {"young", "poisson"})  // who is meant
    if (const std::size_t at = key.find(name + " "); at != std::string::npos)
      key.replace(at, name.size(), capitalized(name) + "'s");
  return capitalized(key);
}

std::string gnuplot_head(const std::string& name, const Canvas& canvas) {
  const std::string script = name + ".gp";
  return "# Run in this folder: gnuplot " + script +
         "\n"
         "# For a PDF or PNG: gnuplot -e \"format='pdf'\" " +
         script +
         "\n"
         "if (!exists(\"format\")) format = 'svg'\n"
         "if (!exists(\"target\")) target = " +
         gnuplot_quoted(name + ".") +
         ".format\n"
         "if (format eq 'pdf') {\n"
         "  set terminal pdfcairo noenhanced size " +
         rounded_text(0.022 * canvas.width, 3) + "cm," + rounded_text(0.022 * canvas.height, 3) +
         "cm font 'sans-serif,15' fontscale 0.62 linewidth 1.1\n"
         "} else { if (format eq 'png') {\n"
         "  set terminal pngcairo noenhanced size " +
         std::to_string(2 * canvas.width) + "," + std::to_string(2 * canvas.height) +
         " font 'sans-serif,15' fontscale 1.5 linewidth 2 background '#ffffff'\n"
         "} else {\n"
         "  set terminal svg noenhanced size " +
         std::to_string(canvas.width) + "," + std::to_string(canvas.height) +
         " font 'sans-serif,15' name " + gnuplot_quoted(name) +
         " background '#ffffff'\n"
         "} }\n"
         "set encoding utf8\n"
         "set output target\n"
         "set datafile separator comma\n"
         "set datafile columnheaders\n"
         "set border 3 linewidth 1.2 linecolor rgb '#404040'\n"
         "set tics nomirror out scale 0.6 textcolor rgb '#202020' font '," +
         std::to_string(canvas.tick_font) +
         "'\n"
         "set grid linetype 1 linewidth 0.6 linecolor rgb '#dcdcdc'\n"
         "set format x '%.10g'\nset format y '%.10g'\nset format cb '%.10g'\n";
}

std::string tick_text(double value, int digits, double powers_from) {
  const double size = std::abs(value);
  if (size == 0.0 || !std::isfinite(size) || (size > 0.999e-3 && size < 0.999 * powers_from))
    return rounded_text(value, digits);
  const int power = static_cast<int>(std::floor(std::log10(size) + 1e-9));
  const std::string front = rounded_text(value / std::pow(10.0, power), digits);
  return (front == "1" ? "" : front + "×") + "10" + superscript(power);
}

std::string gnuplot_logarithmic(const std::string& axis, double low, double high) {
  const double decades = std::log10(high / low);
  const int apart = std::max(1, static_cast<int>(std::ceil(decades / 8.0)));
  std::string tics;
  const auto add = [&](double value, const std::string& text, bool labelled) {
    if (value < low * (1.0 - 1e-9) || value > high * (1.0 + 1e-9)) return;
    tics += (tics.empty() ? "" : ", ") + gnuplot_quoted(labelled ? text : "") + " " +
            rounded_text(value, 5) + (labelled ? "" : " 1");
  };
  const int first = static_cast<int>(std::floor(std::log10(low)));
  for (int power = first; power <= first + static_cast<int>(decades) + 2; ++power)
    for (int digit = 1; digit < 10; ++digit) {
      const double value =
          power < 0 ? digit / std::pow(10.0, -power) : digit * std::pow(10.0, power);
      // At least five labels wherever there is room for them.
      const bool labelled = digit == 1                 ? power % apart == 0
                            : digit == 2 || digit == 5 ? decades < 2.6
                            : digit == 3
                                ? decades < 1.7 || (decades >= 2.6 && decades < 5.0 && axis != "x")
                            : digit == 7 ? decades < 1.7
                            : digit == 4 ? decades < 0.9
                                         : decades < 0.5;
      if (labelled || apart == 1) add(value, tick_text(value, 5, 1e4), labelled);
    }
  return "set logscale " + axis + "\nset " + axis + "tics (" + tics + ")\n";
}

std::string gnuplot_ticks(const std::string& plot, const std::string& axes) {
  if (axes.empty()) return plot;
  // The largest of 1, 2 and 5 times a power of ten that lies in `s` four times.
  std::string text =
      "power(s) = 10**floor(log10(s/4) + 1e-9)\n"
      "step(s) = power(s)*(s/power(s) > 19.999 ? 5 : s/power(s) > 7.999 ? 2 : 1)\n"
      "set output '/dev/null'\n" +
      plot;
  for (const std::string axis : {"x", "y"}) {
    if (axes.find(axis) == std::string::npos) continue;
    const std::string data = axis == "x" ? "GPVAL_DATA_X_" : "GPVAL_DATA_Y_";
    text += "low = " + data + "MIN\nhigh = " + data + "MAX\n";
    if (axis == "y" && axes.ends_with('0'))
      text +=
          "if (low > 0) low = 0\nif (high < 0) high = 0\n"
          "if (low < 0 && -low < high/20) set autoscale yfixmin\n";  // noise about zero
    text += "if (high > low) set " + axis + "tics step(high - low)\n";
  }
  return text + "set output target\nset termoption noenhanced\nreplot\n";
}

std::string gnuplot_linear(const std::string& axis) {
  return "unset logscale " + axis + "\nset " + axis + "tics autofreq\n";
}

std::string gnuplot_palette(double most) {
  std::string text = "set palette defined (";
  constexpr int colours = 8;
  for (int i = 0; i <= colours; ++i)
    text +=
        (i == 0 ? "" : ", ") + std::to_string(i) + " '#" + palette_colour(most * i / colours) + "'";
  return text + ")\n";
}

std::array<unsigned char, 3> palette_bytes(double share) {
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(viridis.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), viridis.size() - 2);
  const double part = place - static_cast<double>(below);
  std::array<unsigned char, 3> bytes{};
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    const std::size_t shift = 16 - 8 * k;
    const double a = (viridis[below] >> shift) & 0xffu;
    const double b = (viridis[below + 1] >> shift) & 0xffu;
    bytes[k] = static_cast<unsigned char>(std::lround(a + part * (b - a)));
  }
  return bytes;
}

std::string palette_colour(double share) {
  std::string text;
  for (const unsigned char byte : palette_bytes(share)) text += hex_text(byte);
  return text;
}

}  // namespace palpate::plot
