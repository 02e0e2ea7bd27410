// Ranges of a sweep: `{ from = "1 kPa", to = "100 kPa", points = 20, scale = "log" }`.
#pragma once

#include <string>

#include "scenario/design.h"

namespace palpate::scenario {

// Whether `value`, found at `key`, is a range and not a table with keys of a scenario.
[[nodiscard]] bool is_interval(const std::string& key, const Node& value);

// Reads a range. Throws InputError, with its place, for ends that are not finite numbers in one
// unit, equal ends, a logarithmic scale with an end that is not positive, fewer than two points,
// points so many that 12 digits do not distinguish them, and unknown keys.
[[nodiscard]] Interval read_interval(const std::string& key, const Node& table);

}  // namespace palpate::scenario
