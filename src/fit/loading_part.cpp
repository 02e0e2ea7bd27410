// Turning points by hysteresis, and the running maximum of the stress.
#include "fit/loading_part.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "fit/step_origin.h"

namespace palpate::fit {

std::vector<Branch> branches_of(std::span<const double> x, double share) {
  std::vector<Branch> branches;
  if (x.empty()) return branches;
  const auto [least, most] = std::minmax_element(x.begin(), x.end());
  const double back = share * (*most - *least);
  std::size_t start = 0;
  std::size_t low = 0;  // first lowest and highest row since the last turn
  std::size_t high = 0;
  int way = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] < x[low]) low = i;
    if (x[i] > x[high]) high = i;
    if (way >= 0 && x[high] - x[i] > back) {
      if (high > start || way > 0) branches.push_back({start, high + 1, true});
      start = high;
      low = i;
      high = i;
      way = -1;
    } else if (way <= 0 && x[i] - x[low] > back) {
      if (low > start && way < 0) branches.push_back({start, low + 1, false});
      if (way < 0) start = low;
      low = i;
      high = i;
      way = 1;
    }
  }
  branches.push_back({start, x.size(), way >= 0});
  return branches;
}

OneWay one_way(std::span<const double> depth, Way way) {
  const auto [low, high] = std::minmax_element(depth.begin(), depth.end());
  OneWay part{0, depth.size()};
  const std::vector<Branch> branches = branches_of(depth);
  for (std::size_t k = 0; k < branches.size(); ++k) {
    if (!branches[k].up || depth[branches[k].to - 1] < *high - 0.1 * (*high - *low)) continue;
    if (++part.loadings > 1 || way == Way::all) continue;
    if (way == Way::approach)
      part.to = branches[k].to;
    else if (k + 1 < branches.size())
      part = {branches[k].to - 1, branches[k + 1].to, part.loadings};
  }
  return part;
}

Limit limit_of(std::span<const double> y) {
  const auto from = std::max_element(y.begin(), y.end());
  auto to = from;
  while (to != y.end() && *to == *from) ++to;
  // The longest of the next two runs of equal values.
  const auto longest = [](auto at, auto end) {
    std::ptrdiff_t most = 0;
    for (int k = 0; k < 2 && at != end; ++k) {
      const auto next = std::find_if(at, end, [&](double each) { return each != *at; });
      most = std::max<std::ptrdiff_t>(most, next - at);
      at = next;
    }
    return most;
  };
  const std::ptrdiff_t beside =
      std::max(longest(std::make_reverse_iterator(from), y.rend()), longest(to, y.end()));
  if (to - from < 5 || to - from <= 3 * beside || beside == 0) return {y.size(), y.size()};
  return {static_cast<std::size_t>(from - y.begin()), static_cast<std::size_t>(to - y.begin())};
}

std::size_t rows_before_break(std::span<const double> force) {
  if (force.size() < 4) return force.size();
  const auto [least, peak] = std::minmax_element(force.begin(), force.end());
  if (*peak - force[0] < 0.5 * (*peak - *least)) return force.size();  // negative in compression
  const auto beyond = static_cast<std::size_t>(force.end() - peak) - 1;
  if (beyond < 3) return force.size();
  double mean = 0.0;
  for (auto each = peak + 1; each != force.end(); ++each)
    mean += *each / static_cast<double>(beyond);
  const double clear = 0.1 * (*peak - force[0]) + 4.0 * noise_of(force);
  return *peak - mean > clear ? force.size() - beyond : force.size();
}

std::size_t rows_before_fall(std::span<const double> stress, double share) {
  if (stress.empty()) return 0;
  // The largest of n values of noise lies 2 sqrt(2 ln n) deviations above the least.
  const double spread = 2.0 * std::sqrt(2.0 * std::log(static_cast<double>(stress.size())));
  const double clear = std::max(6.0, spread) * noise_of(stress);
  // What falls below a tenth of the whole rise is slack that gives way, or noise.
  const double rise = *std::max_element(stress.begin(), stress.end()) - stress[0];
  std::size_t peak = 0;
  for (std::size_t i = 0; i < stress.size(); ++i) {
    if (stress[i] > stress[peak]) peak = i;
    const double fall = stress[peak] - stress[i];
    const double risen = stress[peak] - stress[0];
    if (risen > 0.1 * rise && fall > std::max(share * risen, clear)) return peak + 1;
  }
  return stress.size();
}

}  // namespace palpate::fit
