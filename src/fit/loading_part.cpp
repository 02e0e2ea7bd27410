// Turning points by hysteresis, and the running maximum of the stress.
#include "fit/loading_part.h"

#include <algorithm>
#include <cmath>

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
  const auto low = std::min_element(depth.begin(), depth.end());
  const auto high = std::max_element(depth.begin(), depth.end());  // the first of several
  const double back = *high - 0.1 * (*high - *low);
  const auto away = [&](double each) { return each < back; };
  const bool turns = std::any_of(high, depth.end(), away) && std::any_of(depth.begin(), high, away);
  const auto deepest = static_cast<std::size_t>(high - depth.begin());
  if (!turns || way == Way::all) return {0, depth.size()};
  return way == Way::approach ? OneWay{0, deepest + 1} : OneWay{deepest, depth.size()};
}

std::size_t rows_before_fall(std::span<const double> stress, double share) {
  if (stress.empty()) return 0;
  const double noise = noise_of(stress);
  // What falls below a tenth of the whole rise is slack that gives way, or noise.
  const double rise = *std::max_element(stress.begin(), stress.end()) - stress[0];
  std::size_t peak = 0;
  for (std::size_t i = 0; i < stress.size(); ++i) {
    if (stress[i] > stress[peak]) peak = i;
    const double fall = stress[peak] - stress[i];
    const double risen = stress[peak] - stress[0];
    if (risen > 0.1 * rise && fall > std::max(share * risen, 6.0 * noise)) return peak + 1;
  }
  return stress.size();
}

}  // namespace palpate::fit
