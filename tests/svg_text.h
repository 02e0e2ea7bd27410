// The texts and curves of an SVG picture as boxes, to see what overlaps, is clipped or is crushed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <regex>
#include <string>
#include <vector>

namespace palpate::test {

struct Box {
  double left = std::numeric_limits<double>::infinity();
  double top = left, right = -left, bottom = -left;
  std::string words = {};

  void take(double x, double y) {
    left = std::min(left, x);
    right = std::max(right, x);
    top = std::min(top, y);
    bottom = std::max(bottom, y);
  }
  [[nodiscard]] double width() const { return right - left; }
  [[nodiscard]] double height() const { return bottom - top; }
};

// Whether two boxes share more than a hair's breadth.
inline bool overlap(const Box& a, const Box& b) {
  constexpr double hair = 0.5;  // px, for letters are narrower than the estimate of their width
  return a.left < b.right - hair && b.left < a.right - hair && a.top < b.bottom - hair &&
         b.top < a.bottom - hair;
}

// A picture of gnuplot, or of scene_svg().
class SvgPicture {
 public:
  explicit SvgPicture(const std::string& svg) {
    std::smatch size;
    if (std::regex_search(svg, size, std::regex(R"(viewBox="0 0 ([0-9.]+) ([0-9.]+)\")"))) {
      width = std::stod(size[1]);
      height = std::stod(size[2]);
    }
    read_gnuplot_texts(svg);
    read_plain_texts(svg);
    read_curves(svg);
  }

  double width = 0.0, height = 0.0;  // px
  std::vector<Box> texts = {};
  Box frame = {};                // of all grid lines: the place for the curves
  std::vector<Box> curves = {};  // of gnuplot's data, one per plot element with a line

  // Descriptions of what is wrong with the texts.
  [[nodiscard]] std::vector<std::string> faults() const {
    std::vector<std::string> found;
    for (std::size_t i = 0; i < texts.size(); ++i) {
      const Box& one = texts[i];
      if (one.left < 0.0 || one.top < 0.0 || one.right > width || one.bottom > height)
        found.push_back("`" + one.words + "` is clipped");
      if (std::regex_search(one.words, std::regex("[0-9]e[+-][0-9]")))
        found.push_back("`" + one.words + "` is a number for machines");
      for (std::size_t j = i + 1; j < texts.size(); ++j)
        if (overlap(one, texts[j]))
          found.push_back("`" + one.words + "` and `" + texts[j].words + "` overlap");
    }
    return found;
  }

 private:
  // Widths of letters in a common sans-serif font (DejaVu Sans), as parts of the font's size.
  static double letter_width(unsigned char letter) {
    const std::string narrow = "ijlI.,:;'|!()[] ft", wide = "mwMW%@";
    if ((letter & 0xc0u) == 0x80u) return 0.0;  // a later byte of the same letter
    if (narrow.find(static_cast<char>(letter)) != std::string::npos) return 0.36;
    if (wide.find(static_cast<char>(letter)) != std::string::npos) return 0.9;
    return 0.6;
  }

  // The box of words that are anchored at (x, y) on their base line and turned by `angle` degrees.
  void add(const std::string& words, double x, double y, double font, const std::string& anchor,
           double angle) {
    std::string plain = std::regex_replace(words, std::regex("<[^>]*>"), "");
    plain = std::regex_replace(plain, std::regex("&[a-z]+;"), "n");
    if (plain.find_first_not_of(' ') == std::string::npos) return;
    double length = 0.0;
    for (const char letter : plain)
      length += font * letter_width(static_cast<unsigned char>(letter));
    const double start = anchor == "middle" ? -0.5 * length : anchor == "end" ? -length : 0.0;
    const double turn = angle * 3.14159265358979 / 180.0;
    Box box;
    for (const double along : {start, start + length})
      for (const double up : {-0.22 * font, 0.74 * font})  // below and above the base line
        box.take(x + along * std::cos(turn) + up * std::sin(turn),
                 y + along * std::sin(turn) - up * std::cos(turn));
    box.words = plain;
    texts.push_back(box);
  }

  // <g transform="translate(x,y) rotate(a)" ... font-size="s" text-anchor="t"> <text>...</text></g>
  void read_gnuplot_texts(const std::string& svg) {
    const std::regex group(
        R"re(<g transform="translate\(([-0-9.]+),([-0-9.]+)\)( rotate\(([-0-9.]+)\))?"[^>]*font-size="([0-9.]+)"[^>]*text-anchor="([a-z]+)">\s*<text>([^\n]*)</text>)re");
    for (std::sregex_iterator at(svg.begin(), svg.end(), group), end; at != end; ++at)
      add((*at)[7], std::stod((*at)[1]), std::stod((*at)[2]), std::stod((*at)[5]), (*at)[6],
          (*at)[4].matched ? std::stod((*at)[4]) : 0.0);
  }

  // <text x=".." y=".." font-size=".." text-anchor="..">..</text>
  void read_plain_texts(const std::string& svg) {
    const std::regex plain(R"re(<text x="([-0-9.]+)" y="([-0-9.]+)"([^>]*)>([^<]*)</text>)re");
    for (std::sregex_iterator at(svg.begin(), svg.end(), plain), end; at != end; ++at) {
      const std::string attributes = (*at)[3];
      std::smatch size, anchor;
      std::regex_search(attributes, size, std::regex("font-size=\"([0-9.]+)\""));
      std::regex_search(attributes, anchor, std::regex("text-anchor=\"([a-z]+)\""));
      add((*at)[4], std::stod((*at)[1]), std::stod((*at)[2]),
          size.empty() ? 14.0 : std::stod(size[1]), anchor.empty() ? "start" : anchor[1].str(),
          0.0);
    }
  }

  static Box box_of_path(const std::string& path) {
    Box box;
    const char* at = path.c_str();
    while (*at != '\0') {
      char* end = nullptr;
      const double x = std::strtod(at, &end);
      if (end == at || *end != ',') {
        at = end == at ? at + 1 : end;
        continue;
      }
      const double y = std::strtod(end + 1, &end);
      box.take(x, y);
      at = end;
    }
    return box;
  }

  // Grid lines have a class of their own; what follows the first `..._plot_1` is a curve or a
  // sample in the legend, which is short. (A regular expression would need a deep stack for long
  // paths.)
  void read_curves(const std::string& svg) {
    const std::size_t first = svg.find("_plot_1\"");
    for (std::size_t at = svg.find("<path"); at != std::string::npos; at = svg.find("<path", at)) {
      const std::size_t start = svg.find(" d='", at) + 4;
      const std::size_t end = svg.find('\'', start);
      if (end == std::string::npos) return;
      const bool grid = svg.substr(at, start - at).find("gridline") != std::string::npos;
      const Box box = box_of_path(svg.substr(start, end - start));
      if (grid) {
        frame.take(box.left, box.top);
        frame.take(box.right, box.bottom);
      } else if (at > first && box.width() > 60.0) {
        curves.push_back(box);
      }
      at = end;
    }
  }
};

}  // namespace palpate::test
