// The folder of an identification: tables, figures, and the scenario that repeats the fitted curve.
#pragma once

#include <string>
#include <vector>

#include "fit/identify.h"
#include "report/gnuplot.h"
#include "report/results.h"
#include "scenario/family.h"

namespace palpate::report {

// curve.gp: data, model and residuals. Reads residuals.csv.
[[nodiscard]] Sheet identified_sheet(const std::string& title, const fit::Identification& found);
// profile.gp: a panel an unknown, the profile likelihood and the level of 95 %. Reads profile.csv.
[[nodiscard]] Sheet profile_sheet(const std::string& title, const fit::Identification& found);

class IdentifiedFolder {
 public:
  // OUT/NAME_identified. Throws InputError where it holds an identification and `replace` is false,
  // or anything that is none. Makes nothing yet.
  IdentifiedFolder(const std::string& out, const std::string& name, bool replace);

  // Writes everything and puts it in its place. `measured` is the measurement's file, for its hash.
  // Returns sentences where a figure could not be drawn. Throws SystemError where the folder takes
  // no files.
  [[nodiscard]] std::vector<std::string> write(const fit::Identification& found,
                                               const scenario::Family& family,
                                               const std::string& measured,
                                               const Origin& origin) const;

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace palpate::report
