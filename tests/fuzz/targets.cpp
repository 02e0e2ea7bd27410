// The targets by name: a reader, or a reader of files and one of its formats.
#include <algorithm>
#include <array>
#include <utility>

#include "fuzzing.h"

namespace palpate::fuzz {

Run* target(std::string_view name) {
  using Bytes = const std::uint8_t*;
  static constexpr std::pair<std::string_view, Run*> all[] = {
      {"emulator", emulator},
      {"events", events},
      {"inp", [](Bytes data, std::size_t size) { cells("inp", data, size); }},
      {"inverse3", inverse3},
      {"journal", journal},
      {"lines", lines},
      {"mark10", mark10},
      {"measured", measured},
      {"mesh", [](Bytes data, std::size_t size) { cells("mesh", data, size); }},
      {"msh", [](Bytes data, std::size_t size) { cells("msh", data, size); }},
      {"nodes", nodes},
      {"obj", [](Bytes data, std::size_t size) { surface("obj", data, size); }},
      {"off", [](Bytes data, std::size_t size) { surface("off", data, size); }},
      {"plan", plan},
      {"ply", [](Bytes data, std::size_t size) { surface("ply", data, size); }},
      {"recording", recording},
      {"rows", rows},
      {"scenario", scenario},
      {"settings", settings},
      {"stl", [](Bytes data, std::size_t size) { surface("stl", data, size); }},
      {"table", table},
      {"tissues", tissues},
      {"tolerances", tolerances},
      {"vtk", [](Bytes data, std::size_t size) { cells("vtk", data, size); }},
      {"vtu", [](Bytes data, std::size_t size) { cells("vtu", data, size); }},
      {"websocket", websocket},
  };
  const auto found = std::find_if(std::begin(all), std::end(all),
                                  [&](const auto& one) { return one.first == name; });
  return found == std::end(all) ? nullptr : found->second;
}

}  // namespace palpate::fuzz
