// The emulated stand without a port: bytes in, bytes out, in lock-step.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "emulator/stand.h"

namespace emulator::test {

// A stand above no tissue whose gauge has no noise.
inline Mark10Settings quiet(std::vector<Fault> faults = {}) {
  Mark10Settings settings;
  settings.clock = Clock::lockstep;
  settings.stand.gauge.noise = 0.0;
  settings.stand.tissue.surface = -1.0;
  settings.faults = std::move(faults);
  return settings;
}

class Conversation {
 public:
  explicit Conversation(const Mark10Settings& settings) : mark10_(settings, log_) {}
  std::string say(const std::string& bytes) {
    std::string reply;
    for (const char byte : bytes) {
      mark10_.take(byte, Mark10::Rate::same);
      reply += mark10_.give();
    }
    return reply;
  }
  Mark10& operator*() { return mark10_; }
  Mark10* operator->() { return &mark10_; }

 private:
  Log log_{"", ""};
  Mark10 mark10_;
};

}  // namespace emulator::test
