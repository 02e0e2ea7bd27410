// One curve of `palpate fit`: options to a model, and the fit.
#pragma once

#include <string>
#include <vector>

#include "cli/arguments.h"
#include "fit/contact_model.h"
#include "fit/regression.h"
#include "fit/uniaxial.h"
#include "measured/measured.h"

namespace palpate::cli {

// The x of a curve as strain, where it is a stretch, and what the options, the names of the columns
// or the signs tell of the loading.
struct Strained {
  std::vector<double> strain;
  fit::UniaxialTest::Loading loading;
};
[[nodiscard]] Strained strained(const Fit& command, const measured::MeasuredCurve& curve);

// Refuses options that the model does not use, and models without their required options. Throws
// InputError.
void check_fit(const Fit& command);

struct FittedCurve {
  std::string name;  // `force over depth`
  fit::Fit fit;      // with the reader's notes before its own
};

// Reads a curve and fits it. Throws InputError with the file for curves that cannot be read, are
// not what the model wants, or have no minimum.
[[nodiscard]] FittedCurve fit_curve(const Fit& command, const std::string& path);

}  // namespace palpate::cli
