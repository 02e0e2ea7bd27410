// The target FUZZ_TARGET for libFuzzer.
#include "fuzzing.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static palpate::fuzz::Run* const run = palpate::fuzz::target(FUZZ_TARGET);
  run(data, size);
  return 0;
}
