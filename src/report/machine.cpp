// Reads the machine from Linux, and the build from the compiler and CMake.
#include "report/machine.h"

#include <sched.h>
#include <sys/utsname.h>

#include <array>
#include <cstdlib>
#include <ctime>
#include <fstream>

#include "base/text.h"

// CMake defines these.
#ifndef PALPATE_VERSION
#define PALPATE_VERSION "unknown"
#endif
#ifndef PALPATE_BUILD_TYPE
#define PALPATE_BUILD_TYPE "unknown"
#endif
#ifndef PALPATE_CXX_FLAGS
#define PALPATE_CXX_FLAGS "unknown"
#endif

namespace palpate::report {
namespace {

std::string cpu_model() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    const std::size_t colon = line.find(':');
    if (colon != std::string::npos && line.starts_with("model name"))
      return trimmed(std::string_view(line).substr(colon + 1));
  }
  return "unknown";
}

int usable_cores() {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (::sched_getaffinity(0, sizeof(set), &set) != 0) return 0;
  return CPU_COUNT(&set);
}

std::string compiler() {
#if defined(__clang__)
  return std::string("Clang ") + __clang_version__;
#elif defined(__GNUC__)
  return std::string("GCC ") + __VERSION__;
#else
  return "unknown";
#endif
}

}  // namespace

Machine this_machine() {
  utsname names{};
  const bool known = ::uname(&names) == 0;
  const std::string kernel =
      known ? std::string(names.sysname) + " " + names.release + " " + names.machine : "unknown";
  return {cpu_model(), usable_cores(), kernel};
}

Build this_build() { return {PALPATE_VERSION, PALPATE_BUILD_TYPE, compiler(), PALPATE_CXX_FLAGS}; }

std::string utc_text(long long seconds) {
  const auto time = static_cast<std::time_t>(seconds);
  std::tm parts{};
  ::gmtime_r(&time, &parts);
  std::array<char, 64> buffer{};
  const std::size_t size =
      std::strftime(buffer.data(), buffer.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return {buffer.data(), size};
}

std::string utc_now() {
  if (const char* given = std::getenv("SOURCE_DATE_EPOCH"))  // reproducible-builds.org
    if (const auto seconds = whole_number(given)) return utc_text(static_cast<long long>(*seconds));
  return utc_text(std::time(nullptr));
}

}  // namespace palpate::report
