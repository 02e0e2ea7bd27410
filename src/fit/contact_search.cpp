// Variable projection: offset, tilt and modulus are linear for a given contact point.
#include "fit/contact_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "base/dense.h"
#include "base/index.h"
#include "base/numerics.h"

namespace palpate::fit {
namespace {

constexpr std::size_t most_rows = 4000;  // above, the search uses means of neighbours
constexpr std::size_t means = 2000;

PressRows averaged(const PressRows& rows) {
  const std::size_t n = rows.depth.size();
  if (n <= most_rows) return rows;
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rows.depth[a] < rows.depth[b]; });
  PressRows mean;
  mean.low = rows.low;
  mean.high = rows.high;
  for (std::size_t k = 0; k < means; ++k) {
    const std::size_t from = n * k / means;
    const std::size_t to = n * (k + 1) / means;
    double depth = 0.0;
    double force = 0.0;
    for (std::size_t i = from; i < to; ++i) {
      depth += rows.depth[order[i]];
      force += rows.force[order[i]];
    }
    mean.depth.push_back(depth / static_cast<double>(to - from));
    mean.force.push_back(force / static_cast<double>(to - from));
  }
  return mean;
}

std::size_t linear_terms(Baseline baseline) {
  return baseline == Baseline::none ? 1 : baseline == Baseline::offset ? 2 : 3;
}

class Search {
 public:
  Search(const UnitLaw& law, const PressRows& rows, Baseline baseline)
      : law_(law), rows_(rows), terms_(static_cast<Eigen::Index>(linear_terms(baseline))) {
    matrix_.resize(static_cast<Eigen::Index>(rows.depth.size()), terms_);
    target_ = Eigen::Map<const Eigen::VectorXd>(rows.force.data(), matrix_.rows());
    for (Eigen::Index i = 0; i < matrix_.rows(); ++i) {
      if (terms_ > 1) matrix_(i, 1) = 1.0;
      if (terms_ > 2) matrix_(i, 2) = (rows.depth[as_index(i)] - rows.low) / rows.range();
    }
    straight_ = target_.squaredNorm();
    if (terms_ > 1) {
      const Eigen::MatrixXd line = matrix_.rightCols(terms_ - 1);
      straight_ = (target_ - line * dense::least_squares(line, target_)).squaredNorm();
    }
  }

  std::optional<ContactGuess> at(double contact) {
    ContactGuess guess;
    guess.contact = contact;
    guess.straight = straight_;
    double largest = 0.0;
    for (Eigen::Index i = 0; i < matrix_.rows(); ++i) {
      const double depth = rows_.depth[as_index(i)] - contact;
      if (!(depth > 0.0)) ++guess.before;
      matrix_(i, 0) = depth > 0.0 ? law_(depth).force : 0.0;
      largest = std::max(largest, matrix_(i, 0));
    }
    if (!(largest > 0.0) || !matrix_.col(0).allFinite()) return std::nullopt;
    matrix_.col(0) /= largest;
    const Eigen::MatrixXd normal = matrix_.transpose() * matrix_;
    const auto factors = dense::symmetric_factors(normal, 1e-13);
    if (!factors) return std::nullopt;
    const Eigen::VectorXd sums = matrix_.transpose() * target_;
    const Eigen::VectorXd linear = factors->inverse * sums;
    guess.squares = (matrix_ * linear - target_).squaredNorm();
    guess.factor = linear[0] / largest;
    if (terms_ > 1) guess.offset = linear[1];
    if (terms_ > 2) guess.tilt = linear[2];
    return guess;
  }

 private:
  const UnitLaw& law_;
  const PressRows& rows_;
  Eigen::Index terms_;
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd target_;
  double straight_ = 0.0;
};

}  // namespace

std::optional<ContactGuess> search_contact(const UnitLaw& law, const PressRows& rows,
                                           Baseline baseline, const SearchLimits& limits) {
  constexpr int steps = 400;
  const PressRows few = averaged(rows);
  Search search(law, few, baseline);
  const double range = rows.range();
  const bool before = baseline == Baseline::none || !limits.within_rows;
  const double first = before ? rows.low - range : rows.low;
  const double step = (rows.high - first) / steps;
  std::optional<ContactGuess> best;
  const auto keep = [&](double contact) {
    if (rows.high - contact > limits.deepest) return std::numeric_limits<double>::infinity();
    const auto found = search.at(contact);
    if (!found) return std::numeric_limits<double>::infinity();
    if (!best || found->squares < best->squares) best = found;
    return found->squares;
  };
  if (limits.fixed) {
    (void)keep(*limits.fixed);
  } else {
    for (int i = 0; i < steps; ++i) (void)keep(first + i * step);
    if (best)
      (void)numerics::minimum({best->contact - step, std::min(best->contact + step, rows.high)},
                              keep);
  }
  if (!best) return std::nullopt;
  best->before = as_index(std::count_if(rows.depth.begin(), rows.depth.end(),
                                        [&](double h) { return h <= best->contact; }));
  const double share =
      static_cast<double>(rows.depth.size()) / static_cast<double>(few.depth.size());
  best->squares *= share;
  best->straight *= share;
  return best;
}

namespace {

// The straight line through the rows before a contact point: its slope and that slope's error.
struct Line {
  double slope = 0.0, error = 0.0;
};
Line line_before(const PressRows& rows, double contact) {
  double n = 0.0, sx = 0.0, sxx = 0.0, sy = 0.0, sxy = 0.0, syy = 0.0;
  for (std::size_t i = 0; i < rows.depth.size(); ++i) {
    if (rows.depth[i] > contact) continue;
    const double x = (rows.depth[i] - rows.low) / rows.range();
    n += 1.0;
    sx += x;
    sxx += x * x;
    sy += rows.force[i];
    sxy += x * rows.force[i];
    syy += rows.force[i] * rows.force[i];
  }
  const double spread = sxx - sx * sx / n;
  if (n < 3.0 || !(spread > 0.0)) return {};
  const double slope = (sxy - sx * sy / n) / spread;
  const double squares = std::max(syy - sy * sy / n - slope * slope * spread, 0.0);
  return {slope, std::sqrt(squares / (n - 2.0) / spread)};
}

// Whether the rows before contact determine this baseline by themselves: a tilt ten rows over a
// fifth of the depth in contact, whose own slope agrees with it; an offset three rows that do not
// rise, since rows that rise are in contact.
bool determines(const PressRows& rows, const ContactGuess& guess, Baseline baseline) {
  if (baseline == Baseline::none) return true;
  constexpr double clear = 3.0;      // standard errors
  constexpr double rounding = 1e-9;  // of the largest force
  const Line line = line_before(rows, guess.contact);
  if (baseline == Baseline::offset)
    return guess.before >= 3 && line.slope <= clear * line.error + rounding;
  const double length = guess.contact - rows.low;
  return guess.before >= 10 && length >= 0.2 * (rows.high - guess.contact) &&
         std::abs(line.slope - guess.tilt) <= clear * line.error + rounding;
}

}  // namespace

std::optional<ContactChoice> choose_contact(const UnitLaw& law, const PressRows& rows,
                                            const SearchLimits& limits) {
  constexpr std::size_t for_offset = 3;
  constexpr std::size_t for_tilt = 10;
  const auto n = static_cast<double>(std::min(rows.depth.size(), means));
  double size = 0.0;
  for (const double force : rows.force) size += force * force;
  const auto score = [&](const ContactGuess& guess, Baseline baseline) {
    const double squares = std::max(guess.squares, 1e-24 * size);  // rounding
    return n * std::log(squares) + static_cast<double>(linear_terms(baseline) + 1) * std::log(n);
  };
  const auto rows_for = [&](Baseline baseline) {
    return baseline == Baseline::none ? std::size_t{0}
                                      : (baseline == Baseline::offset ? for_offset : for_tilt);
  };
  std::array<std::optional<ContactGuess>, 3> guesses;
  std::optional<ContactChoice> best;
  double least = std::numeric_limits<double>::infinity();
  for (const Baseline baseline : {Baseline::none, Baseline::offset, Baseline::tilt}) {
    std::optional<ContactGuess>& guess = guesses[as_index(baseline)];
    guess = search_contact(law, rows, baseline, limits);
    if (!guess || guess->before < rows_for(baseline) || rows.depth.size() < guess->before + 2)
      guess.reset();
    if (!guess || (baseline != Baseline::none && !(guess->factor > 0.0))) continue;
    if (const double value = score(*guess, baseline); value < least) {
      least = value;
      best = ContactChoice{baseline, *guess};
    }
  }
  if (!best) return std::nullopt;
  const std::size_t before = best->guess.before;
  for (const Baseline richer : {Baseline::tilt, Baseline::offset, Baseline::none}) {
    const auto& guess = guesses[as_index(richer)];
    // Rows that lie before contact by this baseline alone do not tell it: a line through the first
    // rows in contact is one as well.
    if (before < rows_for(richer)) continue;
    if (!guess || !(guess->factor > 0.0) || !determines(rows, *guess, richer)) continue;
    best = ContactChoice{richer, *guess};
    break;
  }
  for (const Baseline other : {Baseline::offset, Baseline::tilt}) {
    if (other == best->baseline) continue;
    const auto guess = search_contact(law, rows, other, {limits.deepest, false, limits.fixed});
    if (guess && guess->factor > 0.0) best->others.emplace_back(other, guess->factor);
  }
  return best;
}

// Power laws, and Sneddon's sphere by Newton's method for the contact radius.

namespace {

// t with t artanh(t) = d. The left side is convex, so that Newton's steps from the right do not
// pass the root: t <= sqrt(d) because artanh(t) >= t, and t <= tanh(d / tanh(d)) because
// artanh(t) >= d.
double relative_radius(double d) {
  return numerics::root(d < 0.5 ? std::sqrt(d) : std::tanh(d / std::tanh(d)), {0.0, 1.0},
                        [&](double t) {
                          const double inverse = std::atanh(t);
                          return numerics::Tangent{t * inverse - d, inverse + t / (1.0 - t * t)};
                        });
}

// (1 + t^2) artanh(t) - t. For small t the terms cancel, and the series
// sum 4k / (4k^2 - 1) t^(2k+1), k = 1, 2, ..., is used.
double sphere_factor(double t) {
  if (t > 0.3) return (1.0 + t * t) * std::atanh(t) - t;
  double power = t * t * t;
  double sum = 0.0;
  for (int k = 1; k < 20; ++k) {
    sum += 4.0 * k / (4.0 * k * k - 1.0) * power;
    power *= t * t;
  }
  return sum;
}

struct Row {
  Tip::Kind kind;
  std::string_view word;
  const char* law;
};

constexpr std::array<Row, 6> tips{{
    {Tip::Kind::paraboloid, "paraboloid",
     "F = 4/3 E/(1-nu^2) sqrt(R) (h-h_0)^(3/2), Hertz 1881, Sneddon 1965"},
    {Tip::Kind::sphere, "sphere",
     "F = E/(1-nu^2) ((a^2+R^2) artanh(a/R) - a R), h-h_0 = a artanh(a/R), Sneddon 1965"},
    {Tip::Kind::cone, "cone", "F = 2/pi E/(1-nu^2) tan(alpha) (h-h_0)^2, Sneddon 1965"},
    {Tip::Kind::pyramid_3, "pyramid3", "F = 0.8887 E/(1-nu^2) tan(alpha) (h-h_0)^2, Bilodeau 1992"},
    {Tip::Kind::pyramid_4, "pyramid4", "F = 0.7453 E/(1-nu^2) tan(alpha) (h-h_0)^2, Bilodeau 1992"},
    {Tip::Kind::flat_punch, "punch", "F = 2 E/(1-nu^2) R (h-h_0), Sneddon 1965"},
}};

}  // namespace

TipForce tip_force(const Tip& tip, double depth) {
  if (!(depth > 0.0)) return {0.0, 0.0};
  const double radius = tip.radius;
  const auto square = [&](double factor) {
    const double slope = factor * std::tan(tip.half_angle);
    return TipForce{slope * depth * depth, 2.0 * slope * depth};
  };
  switch (tip.kind) {
    case Tip::Kind::paraboloid: {
      const double root = std::sqrt(radius * depth);
      return {4.0 / 3.0 * root * depth, 2.0 * root};
    }
    case Tip::Kind::sphere: {
      const double t = relative_radius(depth / radius);
      return {radius * radius * sphere_factor(t), 2.0 * radius * t};
    }
    case Tip::Kind::cone: return square(2.0 / std::numbers::pi);
    case Tip::Kind::pyramid_3: return square(0.8887);
    case Tip::Kind::pyramid_4: return square(0.7453);
    case Tip::Kind::flat_punch: return {2.0 * radius * depth, 2.0 * radius};
  }
  return {0.0, 0.0};
}

double error_of_hertz(double depth, double radius) {
  const Tip paraboloid{Tip::Kind::paraboloid, radius, 0.0};
  const Tip sphere{Tip::Kind::sphere, radius, 0.0};
  return tip_force(paraboloid, depth).force / tip_force(sphere, depth).force - 1.0;
}

std::string_view word(Tip::Kind kind) { return tips[as_index(kind)].word; }

std::optional<Tip::Kind> find_tip(std::string_view word) {
  for (const Row& row : tips)
    if (row.word == word) return row.kind;
  return std::nullopt;
}

std::string law_text(Tip::Kind kind) { return tips[as_index(kind)].law; }

}  // namespace palpate::fit
