// Solves one scalar equation per contact, in turn until no depth changes.
#include "contact/balance.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/numerics.h"

namespace palpate::contact {

double PointLaw::force(double depth) const {
  if (depth <= 0.0) return 0.0;
  if (layer != nullptr) return share * part * layer->force(depth);
  return part * coefficient * depth * std::sqrt(depth);
}

double PointLaw::stiffness(double depth) const {
  if (depth <= 0.0) return 0.0;
  if (layer != nullptr) return share * part * layer->stiffness(depth);
  return 1.5 * part * coefficient * std::sqrt(depth);
}

double PointLaw::last_depth() const {
  return layer != nullptr ? layer->last_depth() : std::numeric_limits<double>::infinity();
}

namespace {

// Solves h + C F(h) = approach with C < 0. The left side is below the approach at h = approach, and
// it is concave, because F' grows. Newton's tangents lie above it, so that each step stays below
// the solution; if the left side stops growing first, there is no solution.
std::optional<double> softened(const PointLaw& law, double approach, double compliance) {
  constexpr int most_steps = 200;  // near a horizontal tangent each step only halves the error
  double h = approach;
  for (int i = 0; i < most_steps; ++i) {
    if (h > law.last_depth()) return std::nullopt;
    const double slope = 1.0 + compliance * law.stiffness(h);
    if (!(slope > 0.0)) return std::nullopt;
    const double step = (approach - h - compliance * law.force(h)) / slope;
    if (step <= 1e-15 * h) return h;
    h += step;
  }
  return h;
}

}  // namespace

std::optional<double> penetration(const PointLaw& law, double approach, double compliance) {
  if (approach <= 0.0) return 0.0;
  if (compliance < 0.0) return softened(law, approach, compliance);
  const double most = std::min(approach, law.last_depth());
  if (most + compliance * law.force(most) < approach) return std::nullopt;
  return numerics::root(most, {0.0, most}, [&](double h) {
    return numerics::Tangent{h + compliance * law.force(h) - approach,
                             1.0 + compliance * law.stiffness(h)};
  });
}

bool balance(std::span<const PointLaw> laws, std::span<const double> approaches,
             const Eigen::Ref<const Eigen::MatrixXd>& compliance, std::span<double> depths) {
  constexpr int most_sweeps = 1000;
  const std::size_t count = laws.size();
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    double moved = 0.0;
    double deepest = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      double approach = approaches[i];
      for (std::size_t j = 0; j < count; ++j)
        if (j != i)
          approach -= compliance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) *
                      laws[j].force(depths[j]);
      const auto own = static_cast<Eigen::Index>(i);
      const auto depth = penetration(laws[i], approach, compliance(own, own));
      if (!depth) return false;
      moved = std::max(moved, std::abs(*depth - depths[i]));
      deepest = std::max(deepest, *depth);
      depths[i] = *depth;
    }
    if (count == 1 || moved <= 1e-15 * deepest) return true;
  }
  return false;
}

namespace {

// Computes the forces that close the gaps of the pressed points; all others are zero.
bool close_gaps(const Eigen::MatrixXd& compliance, const Eigen::VectorXd& gap,
                const std::vector<char>& pressed, Eigen::VectorXd& force) {
  std::vector<Eigen::Index> at;
  for (std::size_t i = 0; i < pressed.size(); ++i)
    if (pressed[i] != 0) at.push_back(static_cast<Eigen::Index>(i));
  force.setZero(gap.size());
  if (at.empty()) return true;
  const Eigen::LLT<Eigen::MatrixXd> factors(compliance(at, at));
  if (factors.info() != Eigen::Success) return false;
  const Eigen::VectorXd overlap = -gap(at);
  const Eigen::VectorXd closing = factors.solve(overlap);
  force(at) = closing;
  return true;
}

}  // namespace

bool press_apart(const Eigen::MatrixXd& compliance, const Eigen::VectorXd& gap,
                 std::vector<char>& pressed, Eigen::VectorXd& force) {
  constexpr int most_blocks = 10;  // block steps in a row without progress
  // Rounding error of a closed gap, relative to the depths.
  const double closed = 1e-12 * gap.cwiseAbs().maxCoeff();
  std::size_t fewest = pressed.size() + 1;
  int blocks = most_blocks;
  while (true) {
    if (!close_gaps(compliance, gap, pressed, force)) return false;
    const Eigen::VectorXd left = gap + compliance * force;
    std::vector<std::size_t> wrong;
    for (std::size_t i = 0; i < pressed.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      if (pressed[i] != 0 ? force[at] < 0.0 : left[at] < -closed) wrong.push_back(i);
    }
    if (wrong.empty()) return true;
    if (wrong.size() < fewest) {
      fewest = wrong.size();
      blocks = most_blocks;
    } else if (blocks > 0) {
      --blocks;
    } else {
      wrong = {wrong.back()};
    }
    for (const std::size_t i : wrong) pressed[i] = pressed[i] != 0 ? 0 : 1;
  }
}

}  // namespace palpate::contact
