// GCL2, the gauge's command language.
#pragma once

#include <string>
#include <string_view>

#include "emulator/gauge.h"

namespace emulator {

enum class ListStyle {
  ipol,  // V1.00;N;CUR;FLTC3;FLTP1;AOUT0;AOFF5;FULL;IPOL0;OPOL0;B0
  pol,   // V1.00;LBF;CUR;FLTC8;FLTP1;AOUT00;AOFF5;FULL;MIT;POL;B0, the Series 5 guide's example
};
enum class OverloadReply { text, saturated };

struct Gcl2 {
  ListStyle list = ListStyle::ipol;
  OverloadReply overload = OverloadReply::text;
  int auto_output = 0;  // readings per second
  int auto_off = 5;     // minutes; stored and listed, without effect
};

// Carries out one command (without its line end). Returns the reply with CR LF; it is empty for a
// setter without error. Errors: *10 illegal, *11 not applicable, *12 bad specifier, *22 too large.
[[nodiscard]] std::string obey(Gcl2& language, Gauge& gauge, std::string_view command);

// The reply to `?` with CR LF: a reading, or the sign of an overload.
[[nodiscard]] std::string reading_line(const Gcl2& language, const Gauge& gauge, Reading reading);

}  // namespace emulator
