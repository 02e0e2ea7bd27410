// The only file that includes Boost.Math.
#include "base/numerics.h"

#include <Spectra/SymEigsSolver.h>
#include <algorithm>

#include "base/error.h"

// Nothing is computed in long double, which differs between processors.
#define BOOST_MATH_PROMOTE_DOUBLE_POLICY false

#include <algorithm>
#include <array>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/special_functions/bessel.hpp>
#include <boost/math/special_functions/legendre.hpp>
#include <boost/math/tools/minima.hpp>
#include <boost/math/tools/roots.hpp>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <map>
#include <mutex>

namespace palpate::numerics {
namespace {

namespace tools = boost::math::tools;

constexpr int all_digits = 53;     // binary
constexpr int newton_digits = 31;  // the next step would have twice as many
constexpr std::uintmax_t most_steps = 200;

}  // namespace

Interval root(Interval within, Function<double> of) {
  const double at_low = of(within.low);
  const double at_high = of(within.high);
  if (!(at_low < 0.0 && at_high > 0.0) && !(at_low > 0.0 && at_high < 0.0)) {
    const double end = std::abs(at_low) <= std::abs(at_high) ? within.low : within.high;
    return {end, end};
  }
  std::uintmax_t steps = most_steps;
  const auto [low, high] = tools::toms748_solve(of, within.low, within.high, at_low, at_high,
                                                tools::eps_tolerance<double>(all_digits), steps);
  return {low, high};
}

double root(double start, Interval within, Function<Tangent> of) {
  std::uintmax_t steps = most_steps;
  const auto pair = [&](double x) {
    const Tangent at = of(x);
    return std::pair(at.value, at.slope);
  };
  return tools::newton_raphson_iterate(pair, start, within.low, within.high, newton_digits, steps);
}

Interval change(Interval within, double width, Function<bool> of) {
  if (!(within.low < within.high)) return within;
  const auto close = [&](double low, double high) { return high - low <= width * std::abs(high); };
  std::uintmax_t steps = 10 * most_steps;
  const auto [low, high] = tools::bisect(
      [&](double x) {
        const bool yes = x == within.low || (x != within.high && of(x));
        return yes ? 1.0 : -1.0;
      },
      within.low, within.high, close, steps);
  return {low, high};
}

double minimum(Interval within, Function<double> of) {
  const double length = within.high - within.low;
  const auto place = [&](double part) { return within.low + part * length; };
  std::uintmax_t steps = most_steps;
  return place(tools::brent_find_minima(
                   [&](double part) {
                     const double value = of(place(part));
                     return std::isfinite(value) ? value : 1e100;
                   },
                   0.0, 1.0, all_digits / 2, steps)
                   .first);
}

const GaussRule& gauss_rule(int points) {
  static std::mutex looking_up;
  static std::map<int, GaussRule> known;
  const std::lock_guard lock(looking_up);
  GaussRule& rule = known[points];
  if (!rule.nodes.empty()) return rule;
  const auto add = [&](double x) {
    const double slope = boost::math::legendre_p_prime(points, x);
    rule.nodes.push_back(x);
    rule.weights.push_back(2.0 / ((1.0 - x * x) * slope * slope));
  };
  const std::vector<double> zeros = boost::math::legendre_p_zeros<double>(points);
  for (auto zero = zeros.rbegin(); zero != zeros.rend(); ++zero)
    if (*zero > 0.0) add(-*zero);
  for (const double zero : zeros) add(zero);
  return rule;
}

double student_t_quantile(double probability, double degrees) {
  // The curves of a sweep have the same number of points: each asks for the same few values again.
  struct Known {
    double probability = 0.0, degrees = 0.0, value = 0.0;
  };
  thread_local std::array<Known, 4> known;
  thread_local std::size_t oldest = 0;
  for (const Known& one : known)
    if (one.degrees == degrees && one.probability == probability && degrees > 0.0) return one.value;
  const double value =
      boost::math::quantile(boost::math::students_t_distribution<double>(degrees), probability);
  known[oldest++ % known.size()] = {probability, degrees, value};
  return value;
}

double bessel_j(int order, double x) { return boost::math::cyl_bessel_j(order, x); }

}  // namespace palpate::numerics

namespace palpate {
namespace {

using Vector = Eigen::VectorXd;

struct Products {
  using Scalar = double;
  Eigen::Index size;
  const std::function<void(const Vector&, Vector&)>& multiply;
  mutable Vector from{}, to{};

  [[nodiscard]] Eigen::Index rows() const { return size; }
  [[nodiscard]] Eigen::Index cols() const { return size; }
  void perform_op(const double* x, double* image) const {
    from = Vector::Map(x, size);
    multiply(from, to);
    Vector::Map(image, size) = to;
  }
};

}  // namespace

EigenPair largest_eigenpair(const Vector& start, double tolerance,
                            const std::function<void(const Vector&, Vector&)>& multiply) {
  constexpr Eigen::Index kept = 20;
  constexpr Eigen::Index most_restarts = 1000;
  Products products{start.size(), multiply};
  Spectra::SymEigsSolver<Products> solver(products, 1, std::min(kept, start.size()));
  solver.init(start.data());
  if (solver.compute(Spectra::SortRule::LargestAlge, most_restarts, tolerance) < 1)
    throw MeshError("a mode of the mesh was not found; mesh the body again with a quality bound");
  return {solver.eigenvalues()[0], solver.eigenvectors(1).col(0)};
}

}  // namespace palpate
