// Moduli from stress over strain of a specimen that is compressed or stretched between platens.
#pragma once

#include <optional>
#include <span>

#include "fit/regression.h"

namespace palpate::fit {

struct UniaxialTest {
  enum class Model {
    modulus,      // tangent and secant modulus over a range of strain
    neo_hookean,  // P = E/3 (lambda - lambda^-2), incompressible
    ogden,        // P = 2 E/(3 alpha) (lambda^(alpha-1) - lambda^(-alpha/2-1)), incompressible
    yeoh,         // three powers of I1 - 3, incompressible; E = 6 C1, C2, C3
    ogden3,       // three terms; E, mu_k and alpha_k
  };
  enum class Loading { unknown, compression, tension };

  Model model = Model::modulus;
  Loading loading = Loading::unknown;
  std::optional<double> from = {};  // strain, as a positive number in compression too
  std::optional<double> to = {};
  // With bonded platens: diameter over 4 heights, the loaded over the free area of a cylinder.
  std::optional<double> shape_factor = {};
  std::optional<double> poisson_ratio = {};  // between bonded platens; else 1/2, with a warning
  int cycle = 0;                             // of several loadings, from 1; 0: there is one only
  bool toe = false;  // strain counts from where the line through the stress begins
  Residuals residuals = Residuals::independent;
};

// Fits engineering strain and nominal stress (Pa), of equal size. Where strain and stress are both
// negative, both are turned, and the loading is compression. Parameters: `modulus`: E_tangent, the
// slope of the least-squares line, sigma_0, its stress at strain 0, and E_secant from the first row
// to the end of the range; `neo_hookean`: E = 3 mu; `ogden`: E = 3 mu and alpha; all in kPa. Rows
// beyond `to` are cut first; then the loading of a cycle is taken, up to the largest stress before
// its first fall by 10 %. Rows on both sides of strain 0 are tension and compression of one law and
// are fitted together. Throws InputError for fewer than 4 rows, stretches of 0 or less, a loading
// that is not known and matters, several loadings of which none is chosen, and a stress that falls.
//                                             docs/theory.md [stretch], [bonded], [loading_part]
[[nodiscard]] Fit fit_uniaxial(std::span<const double> strain, std::span<const double> stress,
                               const UniaxialTest& test);

}  // namespace palpate::fit
