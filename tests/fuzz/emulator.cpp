// Any text as a settings file of the emulator; the first byte says which.
#include <cmath>

#include "emulator/arm.h"
#include "emulator/faults.h"
#include "emulator/stand.h"
#include "emulator/tissue.h"
#include "fuzzing.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace palpate;
  if (size == 0) return 0;
  const std::string path = fuzz::file("e.toml", fuzz::text_of(data + 1, size - 1));
  fuzz::reads([&] {
    emulator::ArmSettings arm;
    emulator::StandSettings stand;
    switch (data[0] % 5) {
      case 0: emulator::read_hand(path, arm); break;
      case 1: emulator::read_stand(path, stand); break;
      case 2: fuzz::require(std::isfinite(emulator::read_tissue(path).E0)); break;
      case 3: (void)emulator::read_faults(path, emulator::stand_faults()); break;
      default: (void)emulator::read_faults(path, emulator::arm_faults()); break;
    }
  });
  return 0;
}
