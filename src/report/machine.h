// The machine, the build and the time with which a result was made, for run.json.
#pragma once

#include <string>

namespace palpate::report {

struct Machine {
  std::string cpu = {};  // model name in /proc/cpuinfo
  int cores = 0;         // number that this process may use; 0 if unknown
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

// The time in UTC as `2026-01-31T12:00:00Z`; SOURCE_DATE_EPOCH, if set, replaces the clock.
[[nodiscard]] std::string utc_now();

// A time in seconds since 1970-01-01 in the same format.
[[nodiscard]] std::string utc_text(long long seconds);

}  // namespace palpate::report
