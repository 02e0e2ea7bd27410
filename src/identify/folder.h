// The result folder of an identification: tables, figures and the fitted scenario.
#pragma once

#include <string>
#include <vector>

#include "base/whole_folder.h"
#include "identify/identify.h"
#include "plot/gnuplot.h"
#include "report/manifest.h"
#include "scenario/family.h"

namespace palpate::identify {

// curve.gp: data, model and residuals. Reads residuals.csv.
[[nodiscard]] plot::Sheet identified_sheet(const std::string& title,
                                           const identify::Identification& found);
// profile.gp: one panel per unknown, profile likelihood and 95 % level. Reads profile.csv.
[[nodiscard]] plot::Sheet profile_sheet(const std::string& title,
                                        const identify::Identification& found);

// Writes an identification into `folder` and renames it to its final name. `measured` is the path
// of the measured file; run.json stores its hash. Returns warnings, one per figure that could not
// be drawn. Throws SystemError if the folder cannot be written.
[[nodiscard]] std::vector<std::string> write_identification(const Identification& found,
                                                            const scenario::Family& family,
                                                            const std::string& measured,
                                                            const report::Origin& origin,
                                                            WholeFolder& folder);

}  // namespace palpate::identify
