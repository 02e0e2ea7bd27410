// Any text as tolerances of a comparison: what is read can be used.
#include "compare/compare.h"
#include "fuzzing.h"

void palpate::fuzz::tolerances(const std::uint8_t* data, std::size_t size) {
  reads([&] {
    const auto read = compare::parse_tolerances(text_of(data, size), "t.toml");
    for (const auto& [name, tolerance] : read.columns)
      require(tolerance.rel >= 0.0 && tolerance.abs >= 0.0);
    require(read.standard.rel >= 0.0 && read.standard.abs >= 0.0);
    require(!read.tube || read.tube->width >= 0.0);
  });
}
