// Any text as a table of tissues: what is found in it has a density, a modulus and Poisson's ratio.
#include <cmath>

#include "fuzzing.h"
#include "material/tissue_table.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace palpate;
  fuzz::file("t.toml", fuzz::text_of(data, size));
  fuzz::reads([] {
    const auto found = material::find("t.toml#gel", fuzz::folder().string(), {"s.toml", 1, 1});
    for (const double value : {found.tissue.density.value, found.tissue.young_modulus.value})
      fuzz::require(std::isfinite(value) && value > 0.0);
    fuzz::require(found.tissue.poisson_ratio.value < 0.5 + 1e-9);
  });
  return 0;
}
