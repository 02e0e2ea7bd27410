// Fits by least squares; cbrt() and exp() are not called in a solver step.
#include "live/touch.h"

#include <Eigen/Core>
#include <algorithm>

#include "base/index.h"

namespace palpate::live {

void Readings::add(double force) {
  constexpr double most = 100.0;
  count = std::min(count + 1.0, most);
  const double change = force - mean_;
  mean_ += change / count;
  variance_ = std::max(0.0, variance_ + (change * (force - mean_) - variance_) / count);
}

void StraightLine::add(double x, double y) {
  if (count_ == 0.0) first_ = x;
  const double way = x - first_;
  count_ += 1.0;
  x_ += way;
  xx_ += way * way;
  y_ += y;
  xy_ += way * y;
}

std::optional<StraightLine::Found> StraightLine::found() const {
  const double spread = count_ * xx_ - x_ * x_;
  const double slope = (count_ * xy_ - x_ * y_) / spread;
  if (count_ < 3.0 || !(spread > 0.0) || slope == 0.0) return std::nullopt;
  return Found{slope, first_ + (x_ - y_ / slope) / count_};
}

double linear_in_depth(double force) { return std::cbrt(force * force); }

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
  using Values = Eigen::Map<const Eigen::ArrayXd>;
  const Values p_of(pressed.data(), static_cast<Eigen::Index>(n));
  const Values f_of(force_.data(), static_cast<Eigen::Index>(n));
  const Eigen::VectorXd about_p = p_of - p_of.mean();
  const Eigen::VectorXd about_f = f_of - f_of.mean();
  const double pp = about_p.squaredNorm();
  const double pf = about_p.dot(about_f);
  const double ff = about_f.squaredNorm();
  if (!(pp > 0.0)) return {ff, 0.0};
  return {std::max(0.0, ff - pf * pf / pp), pf / pp};
}

std::optional<SurfaceSearch::Found> SurfaceSearch::find() const {
  if (time_.size() < 10) return std::nullopt;
  const auto [low, high] = std::ranges::minmax_element(z_);
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
