// The stand's loop on its port.
#include "emulator/mark10_link.h"

namespace emulator {

int run_mark10(const Mark10Run& run) {
  Log log(run.line.log, "position_m,travel_m,velocity_m_s,depth_m,force_N");
  Mark10Settings settings = run.settings;
  settings.clock = run.line.clock;
  settings.tick = run.line.tick;
  settings.baud = run.line.baud;
  Mark10 mark10(settings, log);
  return PtyLoop<Mark10>(run.line, mark10).go();
}

}  // namespace emulator
