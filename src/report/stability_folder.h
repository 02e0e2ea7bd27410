// The folder of a stability map: two tables and their figure, written beside and renamed.
#pragma once

#include <string>

#include "report/gnuplot.h"
#include "study/stability.h"

namespace palpate::report {

// stability.gp: a panel an axis, theory as lines and measurements as points over them, and a strip
// of the kinds of failure. Reads stability.csv and failures.csv, and
// draws the axes that the map has.
[[nodiscard]] Sheet stability_sheet(const std::string& title, const study::StabilityMap& map);

class StabilityFolder {
 public:
  // OUT/NAME_stability. Throws InputError where it holds a map and `replace` is false, or anything
  // that is no map. Makes nothing yet.
  StabilityFolder(const std::string& out, const std::string& name, bool replace);

  // Writes everything and puts it in its place, that of an older map included. Returns a sentence
  // where the figure could not be drawn. Throws SystemError where the folder takes no files.
  [[nodiscard]] std::string write(const study::StabilityMap& map) const;

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string name_;
  std::string path_;
};

}  // namespace palpate::report
