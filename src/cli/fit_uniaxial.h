// The uniaxial models of `palpate fit`: strain and stress from the columns and the specimen.
#pragma once

#include "cli/arguments.h"
#include "fit/uniaxial.h"
#include "measured/measured.h"

namespace palpate::cli {

// Fits stress over strain, force over strain or force over length, where the sizes of the specimen
// turn forces into stresses and lengths into strains. Throws InputError for missing sizes.
[[nodiscard]] fit::Fit uniaxial_fit(const Fit& command, const measured::MeasuredCurve& curve);

}  // namespace palpate::cli
