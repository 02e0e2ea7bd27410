// Blocks are halved where the curve bends within them.
#include "identify/averaged.h"

#include <algorithm>
#include <cmath>

#include "fit/step_origin.h"

namespace palpate::identify {
namespace {

class Blocks {
 public:
  Blocks(const std::vector<double>& x, const std::vector<double>& y) : x_(x), y_(y) {
    const auto [low, high] = std::minmax_element(y.begin(), y.end());
    least_ = 1e-4 * (*high - *low);
    noise_ = fit::noise_of(y);
    constexpr std::size_t count = 1500;
    for (std::size_t k = 0; k < count; ++k) add(y.size() * k / count, y.size() * (k + 1) / count);
  }

  AveragedRows found;

 private:
  void add(std::size_t from, std::size_t to) {
    const std::size_t size = to - from;
    if (size >= 2 && bends(from, to)) {
      add(from, from + size / 2);
      add(from + size / 2, to);
      return;
    }
    found.x.push_back(mean(x_, from, to));
    found.y.push_back(mean(y_, from, to));
    found.count.push_back(static_cast<double>(size));
  }

  [[nodiscard]] bool bends(std::size_t from, std::size_t to) const {
    const std::size_t size = to - from;
    if (size < 4) return std::abs(y_[to - 1] - y_[from]) > std::max(least_, 6.0 * noise_);
    const std::size_t a = from + size / 4;
    const std::size_t b = to - size / 4;
    const double outer = 0.5 * (mean(y_, from, a) + mean(y_, b, to));
    const double error = noise_ * std::sqrt(4.0 / static_cast<double>(size));
    return std::abs(mean(y_, a, b) - outer) > std::max(least_, 4.0 * error);
  }

  static double mean(const std::vector<double>& values, std::size_t from, std::size_t to) {
    double sum = 0.0;
    for (std::size_t i = from; i < to; ++i) sum += values[i];
    return sum / static_cast<double>(to - from);
  }

  const std::vector<double>& x_;
  const std::vector<double>& y_;
  double least_ = 0.0;
  double noise_ = 0.0;
};

}  // namespace

AveragedRows averaged(const std::vector<double>& x, const std::vector<double>& y) {
  return std::move(Blocks(x, y).found);
}

}  // namespace palpate::identify
