// `palpate fit` of several curves: one row per curve, and the population.
#pragma once

#include <string>
#include <vector>

#include "cli/fit_models.h"
#include "cli/talk.h"

namespace palpate::cli {

// Fits every curve of the command, prints one row per curve (failures with their reasons) and says
// the population's mean, median and quartiles; with `--out` writes curves.csv, population.csv and a
// figure. Returns exit_good if at least one curve has a result.
[[nodiscard]] int fit_many(const Fit& command, const Talk& talk);

}  // namespace palpate::cli
