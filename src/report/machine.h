// Where and by what a result was made: the machine, the build, the clock.
#pragma once

#include <string>

namespace palpate::report {

struct Machine {
  std::string cpu = {};  // the model, as /proc/cpuinfo says
  int cores = 0;         // that this process may use
  std::string kernel = {};
};
[[nodiscard]] Machine this_machine();

struct Build {
  std::string version = {};
  std::string type = {};
  std::string compiler = {};
  std::string flags = {};
};
[[nodiscard]] Build this_build();

// The time in UTC as `2026-01-31T12:00:00Z`; SOURCE_DATE_EPOCH stands in for the clock where set.
[[nodiscard]] std::string utc_now();

// Seconds since 1970-01-01 as such a text.
[[nodiscard]] std::string utc_text(long long seconds);

}  // namespace palpate::report
