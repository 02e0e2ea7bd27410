// The loading part of a test between platens or grips: its cycles, and where the specimen fails.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace palpate::fit {

// Neighbouring rows [from, to) over which x goes one way, up or down, by more than its scatter.
struct Branch {
  std::size_t from = 0, to = 0;
  bool up = true;
};

// The branches between the turns of x. A turn counts if x goes back by more than `share` of its
// range.
[[nodiscard]] std::vector<Branch> branches_of(std::span<const double> x, double share = 0.1);

// The number of rows up to the largest stress before its first fall by more than `share` of its
// rise until then and more than six deviations of its noise; all rows where it does not fall. A
// fall that is followed by no rise beyond it is a rupture, any other one a partial failure.
[[nodiscard]] std::size_t rows_before_fall(std::span<const double> stress, double share = 0.1);

enum class Way { approach, retract, all };

// The rows of one way of a curve that goes in and out: up to its first turn within a tenth of the
// range of the deepest one, or from there to the next turn; all rows of other curves.
struct OneWay {
  std::size_t from = 0, to = 0;
  std::size_t loadings = 0;  // that reach so deep
};
[[nodiscard]] OneWay one_way(std::span<const double> depth, Way way);

// The rows [from, to) at which y stays at exactly its largest value, as at the limit of a sensor:
// five or more, over three times as many as stay at any of the two values before and after. Empty
// where there are none.
struct Limit {
  std::size_t from = 0, to = 0;
};
[[nodiscard]] Limit limit_of(std::span<const double> y);

// The number of rows of a loading up to the largest force, where those beyond are lower on average
// by more than a tenth of its rise and four deviations of its noise: the specimen gave way.
// Otherwise all rows.
[[nodiscard]] std::size_t rows_before_break(std::span<const double> force);

}  // namespace palpate::fit
