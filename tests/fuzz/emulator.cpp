// Any text as a settings file of the emulator; the first byte says which.
#include <cmath>

#include "emulator/arm.h"
#include "emulator/faults.h"
#include "emulator/stand.h"
#include "emulator/tissue.h"
#include "fuzzing.h"

void palpate::fuzz::emulator(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return;
  const std::string path = file("e.toml", text_of(data + 1, size - 1));
  reads([&] {
    emulator::ArmSettings arm;
    emulator::StandSettings stand;
    switch (data[0] % 5) {
      case 0: emulator::read_hand(path, arm); break;
      case 1: emulator::read_stand(path, stand); break;
      case 2: require(std::isfinite(emulator::read_tissue(path).E0)); break;
      case 3: (void)emulator::read_faults(path, emulator::stand_faults()); break;
      default: (void)emulator::read_faults(path, emulator::arm_faults()); break;
    }
  });
}
