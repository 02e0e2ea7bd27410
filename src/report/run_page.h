// report.html of a run.
#pragma once

#include <vector>

#include "base/whole_folder.h"
#include "fit/case_fits.h"
#include "plot/figure.h"
#include "record/record.h"
#include "scenario/family.h"

namespace palpate::report {

// What the page of a run shows.
struct RunShown {
  const scenario::Family& family;
  const std::vector<record::CaseRecord>& records;
  const std::vector<fit::NamedFit>& fits;
  const std::vector<plot::Figure>& figures;  // that were drawn, or tried, in the folder
};

// Writes the page into the folder of the result, whose other data files are there already: the
// answer, figures, findings, fits, pressure maps, the scene, the scenario and how to repeat it.
void write_run_page(const RunShown& shown, WholeFolder& folder);

}  // namespace palpate::report
