// A gauge that sends lines or answers with lines, pressed by hand, with clocks and faults; bytes
// are texts, without a port.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "emulator/faults.h"
#include "emulator/gauge.h"
#include "emulator/serial_device.h"
#include "emulator/tissue.h"

namespace emulator {

// What the lines look like, and what the gauge obeys.
enum class LineStyle {
  hx711,    // `1200,10.35,0.52`: ms, g and mm of a sketch, sent at its rate; `t` tares
  mark10,   // `0.102 N`: a bare Series 5 gauge: GCL2, lines of which `AOUT` sends
  balance,  // `ST,+00010.35  g`: A&D's format, the reply to `Q`; `Z` sets the zero
};

struct TravelPoint {
  double at = 0.0;      // s
  double travel = 0.0;  // m, downwards
};

struct LineGaugeSettings {
  LineStyle style = LineStyle::hx711;
  double rate = 10.0;               // lines per second, of hx711
  bool travel = true;               // whether the lines of hx711 have the travel
  double travel_resolution = 1e-5;  // m
  GaugeSettings gauge = {};
  TissueSettings tissue = {.surface = 0.0};
  std::vector<TravelPoint> points = {};  // the hand moves straight from one to the next
  std::uint64_t seed = 1;
  std::vector<Fault> faults = {};
  Clock clock = Clock::real;
  Nanoseconds tick = 100'000'000;  // lockstep: requests are answered at multiples of it
  int baud = 9600;
};

// The tables [gauge] and [[waypoint]].
void fields(palpate::FieldVisitor& visitor, LineGaugeSettings& settings);
// Reads these tables; keys that the file does not name keep their values. Throws InputError.
void read_line_gauge(const std::string& path, LineGaugeSettings& settings);

class LineGauge : public SerialDevice {
 public:
  LineGauge(const LineGaugeSettings& settings, Log& log);

  // Real clock: sends the lines that are due. Virtual clock: sends the next line of a stream, which
  // begins with the first byte that arrives: somebody listens then.
  void pass(Nanoseconds now) override;
  void take(char byte, Rate rate_of_other_side) override;

  [[nodiscard]] double travel() const;  // m, true
  [[nodiscard]] double force() const { return force_of(tissue_); }
  [[nodiscard]] std::string summary() const override;

 private:
  void go_to(Nanoseconds time, std::int64_t lines);
  void advance_to(Nanoseconds time) override;
  void begin(const Fault& fault) override;
  void log_row(const char* kind, const std::string& text) override;
  [[nodiscard]] double line_rate() const;  // per second; 0: none are sent unasked
  void stream(Nanoseconds until);
  [[nodiscard]] std::string line();
  [[nodiscard]] std::string obey_line(const std::string& command);
  void send_line(std::string line);

  LineGaugeSettings settings_;
  Gauge gauge_;
  Gcl2 language_ = {};
  Tissue tissue_;
  Nanoseconds next_line_ = 0;
  Nanoseconds zero_time_ = 0;  // of the gauge's own clock
  std::int64_t steps_ = 0;     // of 1/7000 s
  std::int64_t lines_ = 0;     // sent
  double last_shown_ = 0.0;    // N, for `ST` and `US`
  bool listened_ = false;      // a byte has arrived
  std::string command_ = {};
  std::string frozen_ = {};
};

}  // namespace emulator
