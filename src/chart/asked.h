// A scenario that a chart is asked for.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenario/family.h"

namespace palpate::chart {

// A scenario file with the settings of the command line.
struct Asked {
  std::string path;
  std::string text;
  std::vector<std::string> settings;
  scenario::Family family;
  // What `contact.depth = "auto"` becomes in the cases, as `model = "auto"` has it: for the
  // reference and every variant but the scenario as it stands.
  std::vector<scenario::Contact::Depth> depths = {};
};

// Reads a scenario for a chart. Throws InputError if it is invalid, has more than 8 cases, sweeps a
// key that the chart varies, or presses to a force (every variant would end at another travel).
[[nodiscard]] Asked read_for_chart(const std::string& path,
                                   const std::vector<std::string>& settings);
// The same, of a text that was read from `path`.
[[nodiscard]] Asked read_for_chart(const std::string& path, const std::string& text,
                                   const std::vector<std::string>& settings);

// Throws InputError with `sentence` at the first step to a force, which would end at another travel
// in every variant and on every mesh.
void refuse_forces(const scenario::Family& family, std::span<const scenario::Step> steps,
                   const std::string& sentence);

// Case `of_case` with further settings, as a family of one case. Throws InputError if invalid.
[[nodiscard]] scenario::Family with_settings(const Asked& asked, std::size_t of_case,
                                             const std::vector<std::string>& settings);

// The settings that leave to palpate what it chooses by itself: model, coupling, mesh and steps.
[[nodiscard]] std::vector<std::string> left_open(const scenario::Scenario& scenario);

// Case `of_case` with these.
[[nodiscard]] scenario::Case opened(const Asked& asked, std::size_t of_case);

}  // namespace palpate::chart
