// Figures by gnuplot: the script, and the picture if gnuplot is installed.
#pragma once

#include <string>
#include <vector>

#include "base/whole_folder.h"
#include "plot/figure.h"

namespace palpate::plot {

// The script NAME.gp, which reads the folder's CSV files by relative paths and writes NAME.svg, or
// NAME.pdf if run as `gnuplot -e "format='pdf'" NAME.gp`; `png` likewise.
[[nodiscard]] std::string gnuplot_script(const Figure& figure);

struct DrawOptions {
  std::vector<std::string> formats{"svg"};  // and `pdf`, `png`
  std::string program = "gnuplot";
  double limit = 30.0;  // s, per picture
};

struct Drawing {
  std::vector<std::string> files = {};  // written, relative to the folder; the script first
  std::string warning = {};             // why a picture could not be drawn; otherwise empty
};

// A script with the files of its folder that it reads.
struct Sheet {
  std::string name = {};  // the files' name without its ending
  std::string script = {};
  std::vector<std::string> reads = {};
};
[[nodiscard]] Sheet sheet_of(const Figure& figure);

// Writes the script and its pictures into `folder`. If gnuplot is missing or fails, only the script
// is written and `warning` is set. Throws SystemError if `folder` cannot be written to.
[[nodiscard]] Drawing draw(const Sheet& sheet, const std::string& folder,
                           const DrawOptions& options = {});

// The same into the partial folder of a result, with the files added to its list; a warning is
// added to `warnings`.
void draw(const Sheet& sheet, WholeFolder& folder, std::vector<std::string>& warnings,
          const DrawOptions& options = {});

// The end of a verb's last line: "; 2 figures were not drawn" after such warnings, or nothing.
[[nodiscard]] std::string missing_figures(const std::vector<std::string>& warnings);

}  // namespace palpate::plot
