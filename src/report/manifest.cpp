// Fills the manifest and writes it as JSON.
#include "report/manifest.h"

#include <sched.h>
#include <sys/utsname.h>
#include <Eigen/Core>
#include <array>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "fit/regression.h"
#include "report/exr.h"

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

namespace {

using Json = nlohmann::ordered_json;

Json files_json(const std::vector<HashedFile>& files) {
  Json list = Json::array();
  for (const HashedFile& file : files)
    list.push_back({{"path", file.path}, {"sha256", file.sha256}});
  return list;
}

// The finished cases, whose `why` is empty, or the others.
template <class Wanted>
Json cases_json(const std::vector<CaseEntry>& cases, const Wanted& wanted) {
  Json list = Json::array();
  for (const CaseEntry& each : cases) {
    if (!wanted(each)) continue;
    Json json{{"name", each.name}};
    if (!each.why.empty()) json["why"] = each.why;
    json["timings_s"] = {{"run", each.seconds}};
    list.push_back(json);
  }
  return list;
}

std::string kernel() {
  utsname names{};
  if (::uname(&names) != 0) return "unknown";
  return std::string(names.sysname) + " " + names.release + " " + names.machine;
}

std::string dotted(int major, int minor, int patch) {
  return std::to_string(major) + "." + std::to_string(minor) + "." + std::to_string(patch);
}

}  // namespace

std::string manifest_text(const Manifest& manifest) {
  const Build build = this_build();
  Json json;
  json["program"] = {
      {"name", "palpate"},
      {"version", build.version},
      {"build_type", build.type},
      {"compiler", build.compiler},
      {"flags", build.flags},
      {"libraries",
       {{"ceres", fit::ceres_version()},
        {"eigen", dotted(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
        {"nlohmann_json", dotted(NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                 NLOHMANN_JSON_VERSION_PATCH)},
        {"openexr", exr_version()},
        {"tetgen", "1.5"}}}};
  json["machine"] = {{"cpu", cpu_model()}, {"cores", usable_cores()}, {"kernel", kernel()}};
  json["argv"] = manifest.origin.argv;
  json["started"] = manifest.origin.started;
  json["ended"] = utc_now();
  json["complete"] = manifest.complete;
  const auto finished = [](const CaseEntry& one) { return one.why.empty(); };
  json["finished"] = cases_json(manifest.cases, finished);
  json["failed"] = cases_json(manifest.cases, std::not_fn(finished));
  json["inputs"] = files_json(manifest.inputs);
  json["outputs"] = files_json(manifest.outputs);
  // A path need not be UTF-8; invalid bytes become U+FFFD.
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace palpate::report
