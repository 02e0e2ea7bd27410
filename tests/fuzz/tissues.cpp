// Any text as a table of tissues: what is found in it has a density, a modulus and Poisson's ratio.
#include <cmath>

#include "fuzzing.h"
#include "material/tissue_table.h"

void palpate::fuzz::tissues(const std::uint8_t* data, std::size_t size) {
  file("t.toml", text_of(data, size));
  reads([] {
    const auto found = material::find("t.toml#gel", folder().string(), {"s.toml", 1, 1});
    for (const double value : {found.tissue.density.value, found.tissue.young_modulus.value})
      require(std::isfinite(value) && value > 0.0);
    require(found.tissue.poisson_ratio.value < 0.5 + 1e-9);
  });
}
