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

// A script by itself, and the files of its folder that it reads.
struct Sheet {
  std::string name = {};  // the files' name without its ending
  std::string script = {};
  std::vector<std::string> reads = {};
};

// Writes the script and its pictures into `folder`, beside and renamed. A missing or failing
// gnuplot leaves the script and a warning. Throws SystemError where the folder takes no files.
[[nodiscard]] Drawing draw(const Figure& figure, const std::string& folder,
                           const DrawOptions& options = {});
[[nodiscard]] Drawing draw(const Sheet& sheet, const std::string& folder,
                           const DrawOptions& options = {});

}  // namespace palpate::report
