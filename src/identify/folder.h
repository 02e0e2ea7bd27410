// The result folder of an identification: tables, figures and the fitted scenario.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/whole_folder.h"
#include "identify/identify.h"
#include "plot/gnuplot.h"
#include "report/manifest.h"
#include "scenario/family.h"

namespace palpate::identify {

// curve.gp: data, model and residuals. Reads residuals.csv. Of the pairs of a joint identification
// the names have a suffix: curve_2.gp, residuals_2.csv, scenario_2.toml.
[[nodiscard]] plot::Sheet identified_sheet(const std::string& title,
                                           const identify::Identification& found,
                                           const std::string& suffix);
// profile.gp: one panel per unknown, profile likelihood and 95 % level. Reads profile.csv.
[[nodiscard]] plot::Sheet profile_sheet(const std::string& title,
                                        const identify::Identification& found);

// The files of one pair: the measured one, and the family of its scenario.
struct PairFiles {
  std::string measured;
  const scenario::Family* family = nullptr;
};

// Writes an identification into `folder` and renames it to its final name. run.json stores the
// hashes of the measured files. Returns warnings, one per figure that could not
// be drawn. Throws SystemError if the folder cannot be written.
[[nodiscard]] std::vector<std::string> write_identification(const Identification& found,
                                                            std::span<const PairFiles> pairs,
                                                            const report::Origin& origin,
                                                            WholeFolder& folder);

}  // namespace palpate::identify
