// The front by sorting by cost and keeping each choice with a smaller error than all before it.
#include "chart/pareto.h"

#include <algorithm>
#include <cmath>

namespace palpate::chart {
namespace {

bool counts(const Tradeoff& one) {
  return std::isfinite(one.cost) && std::isfinite(one.error) && one.cost > 0.0 && one.error > 0.0;
}

}  // namespace

std::vector<std::size_t> pareto_front(std::span<const Tradeoff> all) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (counts(all[i])) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return all[a].cost != all[b].cost ? all[a].cost < all[b].cost : all[a].error < all[b].error;
  });
  std::vector<std::size_t> front;
  for (const std::size_t i : order)
    if (front.empty() || all[i].error < all[front.back()].error) front.push_back(i);
  return front;
}

std::optional<std::size_t> knee(std::span<const Tradeoff> front) {
  if (front.size() < 3) return std::nullopt;
  const Tradeoff& first = front.front();
  const Tradeoff& last = front.back();
  const double width = std::log(last.cost / first.cost);
  const double height = std::log(first.error / last.error);
  // Rounding errors of the logarithms: choices on the chord are no knee.
  constexpr double rounding = 1e-9;
  std::optional<std::size_t> best;
  double farthest = rounding;
  for (std::size_t i = 1; i + 1 < front.size(); ++i) {
    // The chord runs from (0, 1) to (1, 0): x + y = 1.
    const double x = std::log(front[i].cost / first.cost) / width;
    const double y = std::log(front[i].error / last.error) / height;
    const double below = 1.0 - x - y;
    if (below <= farthest) continue;
    farthest = below;
    best = i;
  }
  return best;
}

}  // namespace palpate::chart
