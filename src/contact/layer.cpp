// Solves the integral equation of a layer by Nystrom's method, and tabulates the force law over chi
// by Chebyshev polynomials.
#include "contact/layer.h"

#include <Eigen/Core>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "base/dense.h"
#include "base/index.h"
#include "base/numerics.h"
#include "contact/hertz.h"

namespace palpate::contact {
namespace {

using Row = Eigen::Vector4d;  // coefficients of the four waves

// u_x = U(z) sin kx, u_z = W(z) cos kx, z downwards; stresses divided by 2 G k of the top layer.
struct Face {
  Row along, down, pull, shear;  // U, W, sigma_zz, sigma_xz
};

// The waves (U, W) = (e, e) and ((kz - K) e, kz e), e = exp(-kz), K = 3 - 4 nu, and their mirror
// images at the layer's middle. `kz` and `kd` are the wave number times depth and thickness. They
// satisfy G (lap u + grad div u / (1 - 2 nu)) = 0, also at nu = 1/2.  docs/theory.md [layer_stack]
Face face(double kz, double kd, double stiffness, double nu) {
  const double big_k = 3.0 - 4.0 * nu;
  const double e = std::exp(-kz);
  const double m = std::exp(kz - kd);
  const double back = kd - kz;
  Face at;
  at.along << e, (kz - big_k) * e, m, (back - big_k) * m;
  at.down << e, kz * e, -m, -back * m;
  at.pull << -e, (1.0 - 2.0 * nu - kz) * e, -m, (1.0 - 2.0 * nu - back) * m;
  at.shear << -e, (2.0 - 2.0 * nu - kz) * e, m, -(2.0 - 2.0 * nu - back) * m;
  at.pull *= stiffness;
  at.shear *= stiffness;
  return at;
}

}  // namespace

double stack_surface_displacement(double u, const Layer& layer) {
  assert(u > 0.0);
  const auto layers = static_cast<Eigen::Index>(layer.below.size()) + 1;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(4 * layers, 4 * layers);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(4 * layers);
  const auto piece = [&](Eigen::Index i) {
    return i == 0 ? Sublayer{layer.top(), 1.0, layer.poisson_ratio} : layer.below[as_index(i) - 1];
  };
  // The load is a pressure wave of amplitude 2 G k on the surface.
  const Sublayer first = piece(0);
  const Face surface = face(0.0, u * first.thickness, 1.0, first.poisson_ratio);
  matrix.block<1, 4>(0, 0) = surface.pull.transpose();
  matrix.block<1, 4>(1, 0) = surface.shear.transpose();
  right[0] = -1.0;
  for (Eigen::Index i = 0; i < layers; ++i) {
    const Sublayer own = piece(i);
    const double kd = u * own.thickness;
    const Face bottom = face(kd, kd, own.stiffness, own.poisson_ratio);
    const Eigen::Index row = 2 + 4 * i;
    if (i + 1 == layers) {
      matrix.block<1, 4>(row, 4 * i) = bottom.down.transpose();
      matrix.block<1, 4>(row + 1, 4 * i) =
          (layer.base == LayerBase::bonded ? bottom.along : bottom.shear).transpose();
      break;
    }
    const Sublayer next = piece(i + 1);
    const Face top = face(0.0, u * next.thickness, next.stiffness, next.poisson_ratio);
    const Row* const upper[] = {&bottom.along, &bottom.down, &bottom.pull, &bottom.shear};
    const Row* const lower[] = {&top.along, &top.down, &top.pull, &top.shear};
    for (Eigen::Index k = 0; k < 4; ++k) {
      matrix.block<1, 4>(row + k, 4 * i) = upper[k]->transpose();
      matrix.block<1, 4>(row + k, 4 * i + 4) = -lower[k]->transpose();
    }
  }
  const Eigen::VectorXd waves = dense::least_squares(matrix, right);
  // A half-space is displaced by 2 (1 - nu) under this load.
  return surface.down.dot(waves.head<4>()) / (2.0 * (1.0 - first.poisson_ratio));
}

namespace {

using Eigen::ArrayXd;
using Eigen::MatrixXd;
using Eigen::VectorXd;
constexpr double pi = std::numbers::pi;

// M(u) < (4 u^2 + 4 u + 2) exp(-2u) is below 1e-14 from here on; u per thickness of the top layer.
constexpr double last_wave = 20.0;

// M(u) = 1 - L(u); L is the displacement of a layer under a pressure wave of wave number u / H,
// divided by that of a half-space. With K = 3 - 4 nu,
//   bonded        L = (2K sinh 2u - 4u) / (2K cosh 2u + 1 + K^2 + 4u^2)
//   frictionless  L = (cosh 2u - 1) / (sinh 2u + 2u)
// written with q = exp(-2u), so that nothing overflows and M keeps its digits as L goes to 1.
//                                                              docs/theory.md [layer_waves]
double missing_surface_displacement(double u, const Layer& layer) {
  if (!layer.below.empty()) return 1.0 - stack_surface_displacement(u, layer);
  const double q = std::exp(-2.0 * u);
  if (layer.base == LayerBase::frictionless)
    return q * (2.0 * u - std::expm1(-2.0 * u)) / (0.5 * (1.0 - q * q) + 2.0 * u * q);
  const double k = 3.0 - 4.0 * layer.poisson_ratio;
  const double c = 1.0 + k * k + 4.0 * u * u;
  return q * (2.0 * k * q + c + 4.0 * u) / (k * (1.0 + q * q) + c * q);
}

// The rule on [0, end].
void gauss_legendre(std::span<double> nodes, std::span<double> weights, double end) {
  const numerics::GaussRule& rule = numerics::gauss_rule(static_cast<int>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i] = 0.5 * end * (1.0 + rule.nodes[i]);
    weights[i] = 0.5 * end * rule.weights[i];
  }
}

// The Chebyshev coefficients of int_0^1 w(z (1 - tau^2)) dtau from the values w(z) of a polynomial
// at Chebyshev nodes: a linear map, one row per coefficient.
using ProfileMap = std::array<std::array<double, PressureProfile::terms>, PressureProfile::terms>;
ProfileMap mean_along_chord() {
  constexpr std::size_t terms = PressureProfile::terms;
  ProfileMap map{};
  std::array<double, terms> tau{}, weights{};
  gauss_legendre(tau, weights, 1.0);  // exact, because the degree in tau is 2 terms - 2
  const ChebyshevFit fit(terms);
  for (std::size_t of = 0; of < terms; ++of) {
    std::array<double, terms> unit{}, series{}, means{}, coefficients{};
    unit[of] = 1.0;
    fit(unit, series);
    for (std::size_t i = 0; i < terms; ++i)
      for (std::size_t j = 0; j < terms; ++j)
        means[i] += weights[j] *
                    chebyshev_value(series, chebyshev_node(i, terms) * (1.0 - tau[j] * tau[j]));
    fit(means, coefficients);
    for (std::size_t k = 0; k < terms; ++k) map[k][of] = coefficients[k];
  }
  return map;
}

}  // namespace

double PressureProfile::at(double radius_ratio) const {
  const double z = 1.0 - radius_ratio * radius_ratio;
  return z > 0.0 ? std::sqrt(z) * chebyshev_value(coefficients, z) : 0.0;
}

double Layer::top() const {
  double rest = 1.0;
  for (const Sublayer& one : below) rest -= one.thickness;
  return rest;
}

double LayerSolution::force_factor() const { return force / (depth * std::sqrt(depth)); }

double LayerSolution::radius_factor() const { return 1.0 / std::sqrt(depth); }

LayerResolution layer_resolution(double greatest_ratio, double top) {
  // Q's poles are about H / a away from the interval; its cosines have (20 / pi) a / H periods. M
  // changes from wave numbers of 1 on, and the points of a rule up to 20 / top are densest at 0.
  return {.points = 16 + static_cast<int>(std::ceil(4.0 * greatest_ratio)),
          .waves = std::max(50 + static_cast<int>(std::ceil(10.0 * greatest_ratio)),
                            static_cast<int>(std::ceil(40.0 / std::sqrt(top))))};
}

LayerEquation::LayerEquation(const Layer& layer, const LayerResolution& resolution)
    : share_(layer.share) {
  assert(layer.poisson_ratio > -1.0 && layer.poisson_ratio <= 0.5);
  assert(layer.share >= 0.0 && layer.share <= 1.0);
  assert(resolution.points > 0 && resolution.waves > 0);
  points_.nodes.resize(as_index(resolution.points));
  points_.weights.resize(points_.nodes.size());
  gauss_legendre(points_.nodes, points_.weights, 1.0);
  Layer whole = layer;
  whole.share = 1.0;
  for (const LayerWave& wave : layer_waves(whole, resolution.waves)) {
    waves_.nodes.push_back(wave.number);
    waves_.weights.push_back(2.0 / pi * wave.missing);
  }
}

LayerSystem LayerEquation::system(double ratio, Wanted wanted) const {
  assert(ratio >= 0.0);
  const auto n = static_cast<Eigen::Index>(points_.nodes.size());
  const auto m = static_cast<Eigen::Index>(waves_.nodes.size());
  const VectorXd s = VectorXd::Map(points_.nodes.data(), n);
  const VectorXd root = VectorXd::Map(points_.weights.data(), n).cwiseSqrt();
  // Q(s,t) = 2/pi a/H int_0^inf M(u) cos(u s a/H) cos(u t a/H) du
  //        = sum_k q_k cos(x_k s) cos(x_k t),   x_k = u_k a/H
  const VectorXd x = ratio * VectorXd::Map(waves_.nodes.data(), m);
  const VectorXd q = ratio * VectorXd::Map(waves_.weights.data(), m);
  const MatrixXd cosines = (x * s.transpose()).array().cos();
  LayerSystem system;
  system.ratio_ = ratio;
  // With sqrt(w) g as the unknown the matrix is symmetric.
  MatrixXd matrix = MatrixXd::Zero(n, n);
  const auto add_waves = [&](const VectorXd& amounts, double sign) {
    const MatrixXd waved = amounts.cwiseSqrt().asDiagonal() * cosines * root.asDiagonal();
    matrix += sign * dense::inner_product(waved, waved);
  };
  add_waves(q.cwiseMax(0.0), 1.0);
  if (q.minCoeff() < 0.0) add_waves((-q).cwiseMax(0.0), -1.0);  // over softer layers, where M < 0

  // Between the quadrature points
  //   g_i(s) = 1 or s^2, + sum_k q_k cos(x_k s) v_ki,   v_ki = int_0^1 cos(x_k t) g_i(t) dt
  //   -g_i'(s) / (2s) = 0 or -1, + 1/2 sum_k q_k x_k v_ki sin(x_k s) / s
  // of which the sums are needed at the edge s = 1, and the second ones for the pressure.
  const std::size_t places = wanted == Wanted::pressure ? PressureProfile::terms : 0;
  MatrixXd sums(static_cast<Eigen::Index>(2 + places), m);
  sums.row(0) = q.array() * x.array().cos();
  const VectorXd tilt = 0.5 * q.cwiseProduct(x);
  const auto slope = [&](double at) {
    return (tilt.array() * (at * x.array()).sin() / at).matrix();
  };
  sums.row(1) = slope(1.0);
  for (std::size_t i = 0; i < places; ++i)
    sums.row(static_cast<Eigen::Index>(2 + i)) = slope(std::sqrt(1.0 - chebyshev_node(i, places)));
  const dense::Tridiagonal tridiagonal = dense::tridiagonal(matrix);
  const MatrixXd turned = root.asDiagonal() * tridiagonal.q;  // sqrt(w) U
  system.diagonal_.resize(as_index(n));
  system.beside_.resize(as_index(n - 1));
  system.right_.resize(as_index(2 * n));
  system.sums_.resize(as_index(sums.rows() * n));
  VectorXd::Map(system.diagonal_.data(), n) = tridiagonal.diagonal;
  VectorXd::Map(system.beside_.data(), n - 1) = tridiagonal.beside;
  MatrixXd ones_and_squares(n, 2);
  ones_and_squares << VectorXd::Ones(n), s.cwiseAbs2();
  MatrixXd::Map(system.right_.data(), n, 2) = dense::inner_product(turned, ones_and_squares);
  MatrixXd::Map(system.sums_.data(), sums.rows(), n) =
      dense::product(dense::product(sums, cosines), turned);
  return system;
}

LayerSolution LayerSystem::solve(double share) const {
  const auto n = static_cast<Eigen::Index>(diagonal_.size());
  const auto rows = static_cast<Eigen::Index>(sums_.size()) / n;
  // Positive definite because 1 - share M > 0. The solutions g_1 and g_2 for the right-hand sides 1
  // and s^2 give g = D g_1 - g_2; columns of U^T g / sqrt(w) by elimination.
  const auto right = MatrixXd::Map(right_.data(), n, 2);
  MatrixXd g = right;
  VectorXd pivots(n);
  pivots(0) = 1.0 - share * diagonal_[0];
  for (Eigen::Index i = 1; i < n; ++i) {
    const double beside = -share * beside_[as_index(i - 1)];
    const double factor = beside / pivots(i - 1);
    pivots(i) = 1.0 - share * diagonal_[as_index(i)] - factor * beside;
    g.row(i) -= factor * g.row(i - 1);
  }
  g.row(n - 1) /= pivots(n - 1);
  for (Eigen::Index i = n - 2; i >= 0; --i)
    g.row(i) = (g.row(i) + share * beside_[as_index(i)] * g.row(i + 1)) / pivots(i);
  const Eigen::MatrixX2d sums = share * dense::product(MatrixXd::Map(sums_.data(), rows, n), g);
  const double integral_1 = right.col(0).dot(g.col(0));  // int_0^1 g_1 ds
  const double integral_2 = right.col(0).dot(g.col(1));

  // g(1) = D g_1(1) - g_2(1) = 0 determines D.
  const double punch_edge = 1.0 + sums(0, 0);
  LayerSolution solution;
  solution.ratio = ratio_;
  solution.depth = (1.0 + sums(0, 1)) / punch_edge;
  solution.punch = integral_1;
  // F = 2 E* a^3/R int_0^1 g ds
  const double mean = solution.depth * integral_1 - integral_2;
  solution.force = 1.5 * mean;
  solution.chi = ratio_ * std::sqrt(solution.depth);

  const auto slope = [&](Eigen::Index row) {  // -g'(s) / (2s)
    return 1.0 + solution.depth * sums(row, 0) - sums(row, 1);
  };
  // The contact grows by da as if a flat punch of its size were pressed deeper by dh. With G(x) =
  // a^2/R g(x/a) this is dG = dh g_1, and G stays 0 at the edge: dh/da = -G'(a) / g_1(1).
  solution.chi_slope = slope(1) / (punch_edge * std::sqrt(solution.depth));
  if (rows == 2) return solution;

  // p(r) = -E*/pi int_r^a G'(x) / sqrt(x^2 - r^2) dx is smooth except for a factor sqrt(z): with
  // x^2/a^2 = 1 - z (1 - tau^2), z = 1 - r^2/a^2, and w(1 - s^2) = -g'(s) / (2s)
  // p(r) = 2 E* a/(pi R) sqrt(z) int_0^1 w(z (1 - tau^2)) dtau,  F/(pi a^2) = 2 E* a/(pi R) `mean`
  static const ProfileMap profile = mean_along_chord();
  for (std::size_t k = 0; k < PressureProfile::terms; ++k) {
    double sum = 0.0;
    for (std::size_t i = 0; i < PressureProfile::terms; ++i)
      sum += profile[k][i] * slope(static_cast<Eigen::Index>(2 + i));
    solution.pressure.coefficients[k] = sum / mean;
  }
  return solution;
}

LayerSolution LayerEquation::solve(double ratio, Wanted wanted) const {
  return system(ratio, wanted).solve(share_);
}

double LayerEquation::force_factor(double chi) const {
  // The force grows with the depth as that of a flat punch of the contact's size: in units of
  // 4/3 E* H^3/R, L = chi^3 F/F_Hertz has dL = 3/2 (a/H) kappa d(chi^2). The error of this straight
  // line is about 3/2 (change / chi)^2, while chi and a/H differ by the effect of the thickness.
  if (chi == 0.0) return 1.0;
  // With the kernel's value at the centre everywhere, D = 1 - 2/3 Q(0,0), which is right to the
  // second order of a/H. chi grows almost linearly with the ratio (slope 1 on thick layers, 1/2 on
  // thin ones), so that Newton's method needs one or two more solutions.
  double centre = 0.0;  // Q(0,0) H/a
  for (const double weight : waves_.weights) centre += share_ * weight;
  double start = chi;
  for (int pass = 0; pass < 3; ++pass)
    start = chi / std::sqrt(1.0 - 2.0 / 3.0 * std::clamp(centre * start, 0.0, 0.9));
  LayerSolution near = solve(start, Wanted::force);
  for (int pass = 0; pass < 20; ++pass) {
    const double change = (chi - near.chi) / near.chi_slope;
    const double effect = std::abs(near.force_factor() - 1.0);
    if (1.5 * change * change <= 1e-10 * effect * chi * chi) break;
    const double next = near.ratio + change;
    near = solve(next > 0.0 ? next : 0.25 * near.ratio, Wanted::force);
  }
  const double load = near.chi * near.chi * near.chi * near.force_factor();
  return (load + 1.5 * near.ratio * near.punch * (chi * chi - near.chi * near.chi)) /
         (chi * chi * chi);
}

std::vector<LayerWave> layer_waves(const Layer& layer, int count) {
  // The time of a rule grows with the square of its points.
  constexpr int most_points = 4000;
  const int pieces = (count + most_points - 1) / most_points;
  std::vector<double> numbers(as_index(count / pieces));
  std::vector<double> weights(numbers.size());
  const double width = last_wave / layer.top() / pieces;
  gauss_legendre(numbers, weights, width);
  std::vector<LayerWave> waves;
  for (int piece = 0; piece < pieces; ++piece)
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      const double number = numbers[k] + piece * width;
      waves.push_back(
          {number, layer.share * weights[k] * missing_surface_displacement(number, layer)});
    }
  return waves;
}

ChebyshevSum chebyshev_sum(std::span<const double> coefficients, double z) {
  // Clenshaw's recurrence b_k = 2y b_(k+1) - b_(k+2) + c_k in y = 2z - 1, and its derivative.
  const double y = 2.0 * z - 1.0;
  double b = 0.0, b_before = 0.0, db = 0.0, db_before = 0.0;
  for (std::size_t k = coefficients.size() - 1; k > 0; --k) {
    const double b_next = 2.0 * y * b - b_before + coefficients[k];
    const double db_next = 2.0 * y * db - db_before + 2.0 * b;
    b_before = b;
    db_before = db;
    b = b_next;
    db = db_next;
  }
  return {.value = y * b - b_before + coefficients[0], .slope = 2.0 * (y * db - db_before + b)};
}

double chebyshev_value(std::span<const double> coefficients, double z) {
  const double y = 2.0 * z - 1.0;
  double b = 0.0, b_before = 0.0;
  for (std::size_t k = coefficients.size() - 1; k > 0; --k) {
    const double b_next = 2.0 * y * b - b_before + coefficients[k];
    b_before = b;
    b = b_next;
  }
  return y * b - b_before + coefficients[0];
}

double chebyshev_node(std::size_t i, std::size_t n) {
  return 0.5 + 0.5 * std::cos(pi * (static_cast<double>(i) + 0.5) / static_cast<double>(n));
}

ChebyshevFit::ChebyshevFit(std::size_t n) : cosines_(4 * n) {
  for (std::size_t m = 0; m < cosines_.size(); ++m)
    cosines_[m] = std::cos(pi * static_cast<double>(m) / static_cast<double>(2 * n));
}

void ChebyshevFit::operator()(std::span<const double> values,
                              std::span<double> coefficients) const {
  const std::size_t n = cosines_.size() / 4;
  assert(values.size() == n && coefficients.size() == n);
  for (std::size_t k = 0; k < n; ++k) {
    double sum = 0.0;
    std::size_t m = k;  // cos(pi k (i + 1/2) / n) is the one at k (2i + 1), from turn to turn
    for (std::size_t i = 0; i < n; ++i) {
      sum += values[i] * cosines_[m];
      m += 2 * k;
      if (m >= 4 * n) m -= 4 * n;
    }
    coefficients[k] = (k == 0 ? 1.0 : 2.0) / static_cast<double>(n) * sum;
  }
}

namespace {

constexpr double last_rho = 12.0;
constexpr int waves_for_bessel =
    400;  // the integrand has (20 / pi) rho periods, 80 at the last rho

}  // namespace

LayerSurfaceDisplacement::LayerSurfaceDisplacement(const Layer& layer, double farthest) {
  const auto tabulate = [&](double last, int pieces, int count) {
    const auto waves = layer_waves(layer, count);
    Table table{last, pieces, {}};
    // One piece more than is needed, because of rounding.
    const double most = std::min(farthest * pieces / last + 2.0, static_cast<double>(pieces));
    for (int i = 0; i <= most; ++i) {
      const double rho = last * i / pieces;
      Knot knot{0.0, 0.0};
      for (const auto& wave : waves) {
        knot.value += wave.missing * numerics::bessel_j(0, wave.number * rho);
        knot.slope -= wave.missing * wave.number * numerics::bessel_j(1, wave.number * rho);
      }
      table.knots.push_back(knot);
    }
    tables_.push_back(std::move(table));
  };
  // Near the force the shortest length is the top layer's thickness, far away it is the distance.
  const double top = layer.top();
  tabulate(last_rho * top, 480, waves_for_bessel);
  if (!layer.below.empty() && farthest >= last_rho * top)
    tabulate(last_rho, 64, static_cast<int>(waves_for_bessel / top));
}

double LayerSurfaceDisplacement::gamma(double rho) const {
  const auto table =
      std::ranges::find_if(tables_, [&](const Table& one) { return rho < one.last_rho; });
  if (table == tables_.end()) return 1.0 / rho;
  const double width = table->last_rho / table->pieces;
  const double at = rho / width;
  const int piece = std::min(static_cast<int>(at), table->pieces - 1);
  assert(as_index(piece) + 1 < table->knots.size());
  const Knot& left = table->knots[as_index(piece)];
  const Knot& right = table->knots[as_index(piece) + 1];
  const double t = at - piece;
  const double s = 1.0 - t;
  return s * s * ((1.0 + 2.0 * t) * left.value + t * width * left.slope) +
         t * t * ((1.0 + 2.0 * s) * right.value - s * width * right.slope);
}

namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace

double layer_chi(double depth, double radius, double thickness) {
  return hertz::contact_radius(depth, radius) / thickness;
}

// The factors, continued to negative chi, have their nearest singularities off the real axis, where
// a is about +-i top layer thicknesses. In t = x / (top + x), x = chi or a/H, these are farther
// from the interval: 24 terms are as accurate as 32 terms in chi. t is scaled so that `last` is
// at 1.
double LayerLaw::Scale::place(double x) const { return (top + last) / last * x / (top + x); }
double LayerLaw::Scale::slope(double x) const {
  return (top + last) / last * top / ((top + x) * (top + x));
}
double LayerLaw::Scale::value(double place) const {
  return top * place / ((top + last) / last - place);
}

double last_layer_chi(const Layer& layer) { return std::min(3.0, 12.0 * layer.top()); }

LayerTable::LayerTable(const Layer& layer)
    : top_(layer.top()), last_chi_(last_layer_chi(layer)), terms_(layer.below.empty() ? 24 : 40) {
  // Where a stiff top layer bends on a soft one the factors fall to a hundredth and less.
  constexpr double enough = 1e-5;
  constexpr std::size_t most_terms = 640;
  fill(layer);
  while (!layer.below.empty() && terms_ < most_terms && error(layer) > enough) {
    terms_ *= 2;
    fill(layer);
  }
}

// D > 1/4 even in very thin layers, so that a/H = chi / sqrt(D) stays below 2 last_chi.
void LayerTable::fill(const Layer& layer) {
  ratios_.clear();
  systems_.clear();
  const LayerLaw::Scale scale{top_, 2.0 * last_chi_};
  const std::size_t nodes = terms_ + 4;  // the interval is longer
  // The ratios decrease; after every halving a coarser resolution is sufficient.
  std::optional<LayerEquation> equation;
  double greatest = 0.0;
  for (std::size_t i = 0; i < nodes; ++i) {
    const double ratio = scale.value(chebyshev_node(i, nodes));
    if (!equation || ratio < 0.5 * greatest) {
      greatest = ratio;
      equation.emplace(layer, layer_resolution(greatest / top_, top_));
    }
    ratios_.push_back(ratio);
    systems_.push_back(equation->system(ratio, LayerEquation::Wanted::pressure));
  }
}

// Of the force under a rigid finger, a fraction of it, at some places between those of the table.
double LayerTable::error(const Layer& layer) const {
  constexpr std::size_t places = 13;
  Layer whole = layer;
  whole.share = 1.0;
  const LayerLaw law(*this, whole.share);
  const LayerLaw::Scale scale{top_, 2.0 * last_chi_};
  double most = 0.0;
  for (std::size_t i = 0; i < places; ++i) {
    const double ratio = scale.value(chebyshev_node(i, places));
    const LayerSolution exact = LayerEquation(whole, layer_resolution(ratio / top_, top_))
                                    .solve(ratio, LayerEquation::Wanted::force);
    if (exact.chi > last_chi_) continue;
    most = std::max(most, std::abs(law.force_factor(exact.chi) / exact.force_factor() - 1.0));
  }
  return most;
}

LayerLaw::LayerLaw(const Layer& layer) : LayerLaw(LayerTable(layer), layer.share) {}

// First the depth, the force and the pressure over a/H, then the factors over chi.
LayerLaw::LayerLaw(const LayerTable& table, double share) : scale_{table.top_, table.last_chi_} {
  constexpr std::size_t profile = PressureProfile::terms;
  const std::size_t nodes = table.ratios_.size();
  Series depth(nodes), force(nodes);
  std::array<Series, profile> pressure;
  pressure.fill(Series(nodes));
  for (std::size_t i = 0; i < nodes; ++i) {
    const LayerSolution solution = table.systems_[i].solve(share);
    depth[i] = (solution.depth - 1.0) / solution.ratio;
    force[i] = (solution.force - 1.0) / solution.ratio;
    for (std::size_t k = 0; k < profile; ++k)
      pressure[k][i] = (solution.pressure.coefficients[k] - (k == 0 ? 1.5 : 0.0)) / solution.ratio;
  }
  const auto fitted = [](const ChebyshevFit& fit, const Series& values) {
    Series series(values.size());
    fit(values, series);
    return series;
  };
  const ChebyshevFit over_ratio(nodes), over_chi(table.terms_);
  depth = fitted(over_ratio, depth);
  force = fitted(over_ratio, force);
  for (Series& one : pressure) one = fitted(over_ratio, one);

  const Scale of_ratio{scale_.top, 2.0 * scale_.last};
  Series force_factor(table.terms_), radius_factor(table.terms_);
  std::array<Series, profile> pressures;
  pressures.fill(Series(table.terms_));
  for (std::size_t i = 0; i < table.terms_; ++i) {
    const double chi = scale_.value(chebyshev_node(i, table.terms_));
    // chi = a/H sqrt(D), as in LayerEquation::force_factor().
    const double ratio = numerics::root(chi, {0.0, of_ratio.last}, [&](double trial) {
      const ChebyshevSum sum = chebyshev_sum(depth, of_ratio.place(trial));
      const double root = std::sqrt(1.0 + trial * sum.value);
      return numerics::Tangent{
          trial * root - chi,
          root + 0.5 * trial / root * (sum.value + trial * sum.slope * of_ratio.slope(trial))};
    });
    const double at = of_ratio.place(ratio);
    const double deep = 1.0 + ratio * chebyshev_value(depth, at);  // D
    const double load = 1.0 + ratio * chebyshev_value(force, at);
    force_factor[i] = (load / (deep * std::sqrt(deep)) - 1.0) / chi;
    radius_factor[i] = (1.0 / std::sqrt(deep) - 1.0) / chi;
    for (std::size_t k = 0; k < profile; ++k)
      pressures[k][i] = ratio / chi * chebyshev_value(pressure[k], at);
  }
  force_ = fitted(over_chi, force_factor);
  radius_ = fitted(over_chi, radius_factor);
  for (std::size_t k = 0; k < profile; ++k) pressure_[k] = fitted(over_chi, pressures[k]);
}

LayerLaw::Factor LayerLaw::factor(double chi) const {
  if (!known(chi)) return {.value = unknown, .slope = unknown};
  const ChebyshevSum sum = chebyshev_sum(force_, scale_.place(chi));
  return {.value = 1.0 + chi * sum.value, .slope = sum.value + chi * sum.slope * scale_.slope(chi)};
}

double LayerLaw::force_factor(double chi) const { return factor(chi).value; }

double LayerLaw::stiffness_factor(double chi) const {
  // F ~ h^(3/2) f(chi) and chi ~ h^(1/2): dF/dh = 2 E* sqrt(R h) (f + chi/3 df/dchi)
  const Factor f = factor(chi);
  return f.value + chi / 3.0 * f.slope;
}

double LayerLaw::radius_factor(double chi) const {
  return known(chi) ? 1.0 + chi * chebyshev_value(radius_, scale_.place(chi)) : unknown;
}

PressureProfile LayerLaw::pressure(double chi) const {
  PressureProfile profile;
  if (!known(chi)) {
    profile.coefficients.fill(unknown);
    return profile;
  }
  for (std::size_t k = 0; k < pressure_.size(); ++k)
    profile.coefficients[k] = chi * chebyshev_value(pressure_[k], scale_.place(chi));
  profile.coefficients[0] += 1.5;
  return profile;
}

double LayerContact::last_depth() const {
  const double radius_there = law.last_chi() * thickness;
  return radius_there * radius_there / radius;
}

double LayerContact::force(double depth) const {
  return hertz::force(depth, radius, modulus) *
         law.force_factor(layer_chi(depth, radius, thickness));
}

double LayerContact::stiffness(double depth) const {
  return hertz::stiffness(depth, radius, modulus) *
         law.stiffness_factor(layer_chi(depth, radius, thickness));
}

double LayerContact::contact_radius(double depth) const {
  return hertz::contact_radius(depth, radius) *
         law.radius_factor(layer_chi(depth, radius, thickness));
}

}  // namespace palpate::contact
