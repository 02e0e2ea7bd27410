// Any text as tolerances of a comparison: what is read can be used.
#include "compare/compare.h"
#include "fuzzing.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace palpate;
  fuzz::reads([&] {
    const auto read = compare::parse_tolerances(fuzz::text_of(data, size), "t.toml");
    for (const auto& [name, tolerance] : read.columns)
      fuzz::require(tolerance.rel >= 0.0 && tolerance.abs >= 0.0);
    fuzz::require(read.standard.rel >= 0.0 && read.standard.abs >= 0.0);
    fuzz::require(!read.tube || read.tube->width >= 0.0);
  });
  return 0;
}
