// Ranges of a sweep: `{ from = "1 kPa", to = "100 kPa", points = 20, scale = "log" }`.
#pragma once

#include <string>

#include "scenario/design.h"

namespace palpate::scenario {

// Whether what stands at `key` is meant as a range, and not as a table with keys of its own.
[[nodiscard]] bool is_interval(const std::string& key, const Node& value);

// Throws InputError, at its place, for ends that are no finite numbers of one unit, equal ends, a
// logarithmic scale with an end that is not positive, fewer than two points or so many that 12
// digits do not tell them apart, and unknown keys.
[[nodiscard]] Interval read_interval(const std::string& key, const Node& table);

}  // namespace palpate::scenario
