// Figures by gnuplot: the script that makes them, and the picture where gnuplot is installed.
#pragma once

#include <string>
#include <vector>

#include "report/figure.h"

namespace palpate::report {

enum class PictureFormat { svg, svg_and_pdf };

// The script NAME.gp: reads the folder's CSV files by relative paths, writes NAME.svg, or NAME.pdf
// where it is run as `gnuplot -e "format='pdf'" NAME.gp`.
[[nodiscard]] std::string gnuplot_script(const Figure& figure);

struct DrawOptions {
  PictureFormat format = PictureFormat::svg;
  std::string program = "gnuplot";
  double limit = 30.0;  // s, a picture
};

struct Drawing {
  std::vector<std::string> files = {};  // written, relative to the folder; the script first
  std::string warning = {};             // a sentence where a picture could not be made
};

// A figure whose script is not made from a Figure; `reads` are the CSV files that it wants to find.
struct Script {
  std::string name = {};  // the files' name without its ending
  std::string text = {};
  std::vector<std::string> reads = {};
};

// Writes the script and its pictures into `folder`, beside and renamed. A missing or failing
// gnuplot leaves the script and a warning. Throws SystemError where the folder takes no files.
[[nodiscard]] Drawing draw(const Figure& figure, const std::string& folder,
                           const DrawOptions& options = {});
[[nodiscard]] Drawing draw(const Script& script, const std::string& folder,
                           const DrawOptions& options = {});

// A script's first lines: the output NAME.svg of so many points, or NAME.pdf on demand.
struct Canvas {
  int width = 820;
  int height = 500;
};
[[nodiscard]] std::string script_head(const std::string& name, const Canvas& canvas);

}  // namespace palpate::report
