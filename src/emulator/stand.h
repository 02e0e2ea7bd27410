// The motorised stand with its gauge on the tissue: bytes in, bytes out, and time that passes.
#pragma once

#include <cstdint>
#include <string>

#include "emulator/crosshead.h"
#include "emulator/gauge.h"
#include "emulator/gcl2.h"
#include "emulator/tissue.h"

namespace emulator {

using Nanoseconds = std::int64_t;  // since the emulator's start

[[nodiscard]] constexpr double seconds(Nanoseconds time) {
  return static_cast<double>(time) * 1e-9;
}
[[nodiscard]] constexpr Nanoseconds nanoseconds(double time) {
  return static_cast<Nanoseconds>(time * 1e9 + (time < 0.0 ? -0.5 : 0.5));
}

// How `p` writes its codes, for the guide gives the codes and not the layout.
enum class StatusLayout { compact, spaced };  // "SLUL", "S L UL"

enum class Control {
  off,
  on
};  // the stand's option "PC Control": without it no motion by the line

struct StandSettings {
  CrossheadSettings crosshead = {};
  GaugeSettings gauge = {};
  TissueSettings tissue = {};
  double speed = 60e-3 / 60.0;         // m/s, after switching on
  double travel_resolution = 0.02e-3;  // m
  Control control = Control::on;
  StatusLayout status = StatusLayout::compact;
  ListStyle list = ListStyle::ipol;
  OverloadReply overload = OverloadReply::text;
  std::uint64_t seed = 1;
};

// Tables [stand] and [gauge]; `settings` keeps what the file does not name. Throws `Refused`.
void read_stand(const std::string& path, StandSettings& settings);

struct Stand {
  StandSettings settings;
  Crosshead crosshead;
  Gauge gauge;
  Gcl2 language;
  Tissue tissue;
  std::int64_t steps = 0;  // of 1/7000 s
  double zero = 0;         // m, the position that reads as no travel
  bool inches = false;
  bool to_gauge = false;  // between `/` and `\`
  std::string line = {};  // of the gauge, so far
  char setter = 0;        // `e`, `f`, `g` or `h` while its digits arrive
  std::string digits = {};
  double programmed_speed = 0;  // m/s, what `o` goes back to
  Nanoseconds next_output = 0;  // of the gauge's own output
  std::string unsolicited = {};
  double deepest = 0;         // m, so far
  double greatest_force = 0;  // N, so far
};

// Samples of the gauge a second, which is also the mechanics' step.
inline constexpr std::int64_t rate = 7000;

[[nodiscard]] Stand make_stand(const StandSettings& settings);

// What switching off and on does: settings, zeroes and limits are lost, the crosshead stays put.
void switch_on_again(Stand& stand);

// Moves, presses and samples up to a time; lines of the gauge's own output go to `unsolicited`.
void advance(Stand& stand, Nanoseconds time);

// Whether this byte ends a request: it may bring a reply.
[[nodiscard]] bool ends_request(const Stand& stand, char byte);
// Whether the stand waits for nothing more of a command.
[[nodiscard]] bool between_commands(const Stand& stand);

// Takes one byte now. Returns the reply, mostly nothing.
[[nodiscard]] std::string receive(Stand& stand, char byte);

[[nodiscard]] double travel(const Stand& stand);  // m, true, from its zero
[[nodiscard]] double depth(const Stand& stand);   // m, true, below the surface

}  // namespace emulator
