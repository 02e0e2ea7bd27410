// Fits by least squares; cbrt() and exp() are not called in a solver step.
#include "live/touch.h"

#include <algorithm>
#include <cmath>

#include "base/index.h"

namespace palpate::live {

void TouchLine::add(double z, double force) {
  if (!(force > 0.0)) return;
  if (count_ == 0.0) z_first_ = z;
  const double way = z - z_first_;
  const double root = std::cbrt(force);
  const double y = root * root;
  count_ += 1.0;
  z_ += way;
  zz_ += way * way;
  y_ += y;
  zy_ += way * y;
}

std::optional<double> TouchLine::surface() const {
  if (count_ < 3.0) return std::nullopt;
  const double spread = count_ * zz_ - z_ * z_;
  if (!(spread > 0.0)) return std::nullopt;
  const double slope = (count_ * zy_ - z_ * y_) / spread;
  if (!(slope < 0.0)) return std::nullopt;
  const double level = (y_ - slope * z_) / count_;
  return z_first_ - level / slope;
}

void SurfaceSearch::add(double time, double z, double force) {
  time_.push_back(time);
  z_.push_back(z);
  force_.push_back(force);
}

SurfaceSearch::Line SurfaceSearch::line(double surface) const {
  const std::size_t n = time_.size();
  std::vector<double> p(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double depth = std::max(0.0, surface - z_[i]);
    p[i] = depth * std::sqrt(depth);
  }
  std::vector<double> pressed = p;
  for (const contact::Branch& branch : relaxation_->branches) {
    double memory = 0.0;  // the part of p that has not relaxed; p is linear between readings
    for (std::size_t i = 1; i < n; ++i) {
      const double x = (time_[i] - time_[i - 1]) / branch.time;
      const double decay = std::exp(-x);
      memory = memory * decay + (p[i] - p[i - 1]) * (x > 1e-6 ? (1.0 - decay) / x : 1.0);
      pressed[i] += branch.ratio * memory;
    }
  }
  double mean_p = 0.0;
  double mean_f = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    mean_p += pressed[i] / static_cast<double>(n);
    mean_f += force_[i] / static_cast<double>(n);
  }
  double pp = 0.0;
  double pf = 0.0;
  double ff = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    pp += (pressed[i] - mean_p) * (pressed[i] - mean_p);
    pf += (pressed[i] - mean_p) * (force_[i] - mean_f);
    ff += (force_[i] - mean_f) * (force_[i] - mean_f);
  }
  if (!(pp > 0.0)) return {ff, 0.0};
  return {std::max(0.0, ff - pf * pf / pp), pf / pp};
}

std::optional<SurfaceSearch::Found> SurfaceSearch::find() const {
  if (time_.size() < 10) return std::nullopt;
  const auto [low, high] = std::minmax_element(z_.begin(), z_.end());
  constexpr int steps = 200;
  double width = (*high - *low) / steps;
  if (!(width > 0.0)) return std::nullopt;
  double best = *high;
  for (int i = 1; i <= steps; ++i) {
    const double z = *high - width * i;
    if (line(z).squares < line(best).squares) best = z;
  }
  for (int i = 0; i < 30; ++i, width *= 0.7)
    for (const double z : {best - width, best + width})
      if (line(z).squares < line(best).squares) best = z;
  const Line fit = line(best);
  if (!(fit.slope > 0.0)) return std::nullopt;
  // The squares grow by those of one standard deviation of a reading where z_0 is one of its own
  // away.
  const double variance = fit.squares / static_cast<double>(time_.size() - 3);
  const double away = (*high - *low) / 100.0;
  const double growth = 0.5 * (line(best - away).squares + line(best + away).squares) - fit.squares;
  Found found{.surface = best, .noise = std::sqrt(variance)};
  if (growth > 0.0) found.error = away * std::sqrt(variance / growth);
  return found;
}

}  // namespace palpate::live
