// Force is proportional to E: the contact point is searched first, with offset and tilt linear,
// then all unknowns by Ceres.
#include "fit/contact_model.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "base/dense.h"
#include "base/error.h"
#include "base/index.h"
#include "base/numerics.h"
#include "base/text.h"
#include "contact/depth_ratio.h"
#include "fit/ceres_fit.h"
#include "fit/residuals.h"

namespace palpate::fit {
namespace {

constexpr std::size_t most_rows = 4000;  // above, the search uses means of neighbours
constexpr std::size_t means = 2000;

PressRows averaged(const PressRows& rows) {
  const std::size_t n = rows.depth.size();
  if (n <= most_rows) return rows;
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(
      order, [&](std::size_t a, std::size_t b) { return rows.depth[a] < rows.depth[b]; });
  std::vector<double> depth, force;
  for (const std::size_t i : order) {
    depth.push_back(rows.depth[i]);
    force.push_back(rows.force[i]);
  }
  return {block_means(depth, means), block_means(force, means), rows.low, rows.high};
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

std::string with_baseline(Baseline baseline) {
  static constexpr std::array words{"no baseline", "a force offset", "a force offset and a tilt"};
  return std::string(", with ") + words[as_index(baseline)];
}

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
  best->before =
      as_index(std::ranges::count_if(rows.depth, [&](double h) { return h <= best->contact; }));
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

namespace {

// The contact law for E* = 1 Pa, and the largest depth for which it is known (m).
struct Law {
  UnitLaw unit;
  double deepest = std::numeric_limits<double>::infinity();
  std::string text;
};

Law law_of(const ContactTest& test) {
  if (!test.thickness) {
    const Tip tip{test.tip, test.radius, test.half_angle};
    return {[tip](double depth) { return tip_force(tip, depth); },
            std::numeric_limits<double>::infinity(), law_text(test.tip)};
  }
  const contact::Layer layer{.poisson_ratio = test.poisson_ratio, .base = test.base};
  const contact::LayerContact contact{test.radius, 1.0, *test.thickness, contact::LayerLaw(layer)};
  const double deepest = contact.last_depth();
  return {[contact](double depth) {
            return depth > 0.0 ? TipForce{contact.force(depth), contact.stiffness(depth)}
                               : TipForce{0.0, 0.0};
          },
          deepest,
          "Hertz 1881 times the exact factor of a layer of " +
              rounded_text(unit::mm.from_si(*test.thickness)) + " mm"};
}

// A finished fit with the sizes that its warnings depend on.
struct ContactResult {
  const ContactTest& test;
  Baseline baseline;
  double deepest = 0.0;    // m, below the contact point
  std::size_t before = 0;  // rows before the contact point
  std::size_t beyond = 0;  // rows beyond it
  double drift = 0.0;      // rise of the tilt over all rows, as a share of the contact force
};

// The force of a sphere on neo-Hookean tissue at the deepest row, or as deep as it is known,
// against the law fitted, minus 1; 0 where it is not known.                      docs/theory.md
// [deep]
struct Change {
  double depth = 0.0, change = 0.0;
};
Change change_by_strain(const ContactResult& result) {
  const ContactTest& test = result.test;
  const bool round = test.tip == Tip::Kind::paraboloid || test.tip == Tip::Kind::sphere;
  if (!round) return {};
  const auto ratio = contact::depth_ratio(
      {.radius = test.radius,
       .thickness = test.thickness.value_or(std::numeric_limits<double>::infinity()),
       .poisson_ratio = test.poisson_ratio,
       .base = test.base});
  if (!ratio) return {};
  const double depth = std::min(result.deepest, ratio->last_depth());
  const double linear =  // of the paraboloid, to which the ratio refers
      test.tip == Tip::Kind::sphere ? 1.0 + error_of_hertz(depth, test.radius) : 1.0;
  return {depth, ratio->value(depth) * linear - 1.0};
}

std::string rows_text(std::size_t count) {
  return (count == 0 ? "no" : std::to_string(count)) + (count < 2 ? " row lies" : " rows lie");
}

// Adds sentences to fit.warnings: few rows in contact, no rows before contact, a tilt as large as
// the contact force, a tip deeper than its radius, the error of Hertz's law at the deepest row.
void warn_of_contact(Fit& fit, const ContactResult& result) {
  const ContactTest& test = result.test;
  const auto warn = [&](const std::string& sentence) { fit.warnings.push_back(sentence); };
  if (result.beyond < 10)
    warn("only " + rows_text(result.beyond) +
         " beyond the contact point, so that modulus and contact point depend on each other; "
         "record more points, or press deeper");
  const bool automatic = test.baseline == ContactTest::BaselineChoice::automatic;
  if (automatic && result.before < 3)
    warn(rows_text(result.before) +
         (result.baseline == Baseline::none
              ? " before contact, so that a force offset cannot be told; the force is taken as "
                "measured from zero"
              : " before contact, and the force offset follows from the bend of the curve alone; "
                "record rows before contact, or give `--baseline none` if the force is zeroed"));
  if (result.baseline == Baseline::tilt && result.drift > 0.5)
    warn("the baseline rises by " + percent_text(result.drift) +
         " of the contact force over the curve; give `--baseline offset` or a part of the curve by "
         "`--to`");
  const bool round = test.tip == Tip::Kind::paraboloid || test.tip == Tip::Kind::sphere;
  if (round && result.deepest > test.radius) {
    warn("the tip is " + rounded_text(result.deepest / test.radius, 3) +
         " radii deep, and beyond one radius its shape is no sphere; give the part of the curve up "
         "to a smaller depth by `--to`");
  } else if (test.tip == Tip::Kind::paraboloid) {
    const double error = error_of_hertz(result.deepest, test.radius);
    if (error > 0.02)
      warn("at the largest depth Hertz's law of a paraboloid is " + percent_text(error) +
           " stiffer than the exact law of a sphere" +
           (test.thickness ? "; give a smaller depth by `--to`"
                           : "; give `--tip sphere`, or a smaller depth by `--to`"));
  }
  if (const auto [depth, change] = change_by_strain(result); std::abs(change) > 0.02)
    fit.notes.push_back(
        "the law is that of small strains: in neo-Hookean tissue the force at " +
        (depth < result.deepest ? "a depth of " + rounded_text(unit::mm.from_si(depth)) + " mm"
                                : std::string("the largest depth")) +
        " is " + percent_text(std::abs(change)) + (change < 0.0 ? " lower" : " higher") +
        (depth < result.deepest ? " already, and how much beyond is not known"
                                : ", which `palpate identify` takes into account"));
  warn_of_residuals(fit);
}

class ContactFit {
 public:
  ContactFit(std::span<const double> depth, std::span<const double> force, const ContactTest& test)
      : test_(test), law_(law_of(test)) {
    fit_.name = test.thickness ? "layer" : "hertz";
    fit_.law = law_.text;
    take(depth, force);
  }

  Fit all() {
    const bool part = test_.from || test_.to || test_.baseline_from || test_.baseline_to;
    const ContactChoice choice = part ? chosen_part() : chosen();
    refuse_what_shows_no_contact(choice);
    fit_.n = static_cast<int>(rows_.depth.size());
    leave_out(fit_, outside_, "outside the limits of depth");
    fit_.range_low = unit::mm.from_si(rows_.low);
    fit_.range_high = unit::mm.from_si(rows_.high);
    finish(choice);
    return std::move(fit_);
  }

 private:
  void take(std::span<const double> depth, std::span<const double> force) {
    std::vector<double> h, f;
    for (std::size_t i = 0; i < depth.size(); ++i) {
      if (!std::isfinite(depth[i]) || !std::isfinite(force[i])) continue;
      h.push_back(depth[i]);
      f.push_back(force[i]);
    }
    leave_out(fit_, depth.size() - h.size(), "a number is missing or not finite");
    refuse_few(h.size());
    take_one_way(h, f);
    const auto [low, high] = std::ranges::minmax_element(h);
    if (*low == *high)
      throw InputError({}, "all points have the same depth; give a curve over depth");
    scale_ = scale_to_one(f);
    all_ = {h, f, *low, *high};
    rows_ = all_;
  }

  void refuse_few(std::size_t usable) const { need_points(fit_.name, 4, usable); }

  void take_one_way(std::vector<double>& h, std::vector<double>& f) {
    const OneWay part = one_way(h, test_.way);
    const auto keep = [&](std::size_t from, std::size_t to, const char* why) {
      leave_out(fit_, h.size() - (to - from), why);
      for (std::vector<double>* each : {&h, &f})
        *each = {each->begin() + static_cast<std::ptrdiff_t>(from),
                 each->begin() + static_cast<std::ptrdiff_t>(to)};
    };
    if (part.loadings > 1)
      fit_.notes.push_back("the first of " + std::to_string(part.loadings) +
                           " loadings is taken; `--rows` chooses the rows of another");
    keep(part.from, part.to,
         test_.way == Way::retract ? "the way to the deepest row"
         : part.loadings > 1       ? "the way back, and other loadings"
                             : "the way back from the deepest row; `--segment retract` fits it");
    if (test_.way == Way::approach) {
      if (const Limit limit = limit_of(f); limit.to == f.size())
        keep(0, limit.from, "the force stays at its largest value, as at the limit of a sensor");
      const std::size_t whole = rows_before_break(f);
      fit_.gave_way = whole < f.size();
      keep(0, whole, "beyond the largest force, from which it falls by over 10 %");
    }
    refuse_few(h.size());
  }

  [[nodiscard]] SearchLimits limits() const { return {law_.deepest, true, test_.contact_point}; }

  [[nodiscard]] ContactChoice chosen() const {
    std::optional<ContactChoice> choice;
    using Asked = ContactTest::BaselineChoice;
    if (test_.baseline == Asked::automatic) {
      choice = choose_contact(law_.unit, rows_, limits());
    } else {
      const Baseline baseline = test_.baseline == Asked::none     ? Baseline::none
                                : test_.baseline == Asked::offset ? Baseline::offset
                                                                  : Baseline::tilt;
      if (const auto guess = search_contact(law_.unit, rows_, baseline, limits()))
        choice = ContactChoice{baseline, *guess};
    }
    if (choice) return *choice;
    if (rows_.range() > law_.deepest)
      throw InputError({}, "the curve is deeper than " +
                               rounded_text(unit::mm.from_si(law_.deepest)) +
                               " mm, up to which the law of so thin a layer is valid; give the "
                               "part of the curve up to that depth, by `--to`");
    throw InputError({}, "no contact point fits the curve; give a curve of force over depth");
  }

  // Keeps the rows of the baseline and those between `from` and `to`; false if nothing changes.
  bool narrow(double contact) {
    const double most = all_.high - contact;
    const auto length = [&](const std::optional<DepthLimit>& limit, double otherwise) {
      if (!limit) return otherwise;
      return limit->share ? limit->value * most : limit->value;
    };
    const double from = length(test_.from, 0.0);
    const double to = length(test_.to, most) * (1.0 + 1e-12);
    const double free_from = test_.baseline_from.value_or(-std::numeric_limits<double>::infinity());
    const double free_to = test_.baseline_to.value_or(std::numeric_limits<double>::infinity());
    PressRows kept = those([&](double h) {
      if (h <= contact) return h >= free_from && h <= free_to;
      return h - contact >= from && h - contact <= to;
    });
    const bool same = kept.depth == rows_.depth;
    rows_ = std::move(kept);
    return !same;
  }

  template <class Wanted>
  [[nodiscard]] PressRows those(const Wanted& wanted) const {
    PressRows kept;
    for (std::size_t i = 0; i < all_.depth.size(); ++i) {
      if (!wanted(all_.depth[i])) continue;
      kept.depth.push_back(all_.depth[i]);
      kept.force.push_back(all_.force[i]);
    }
    refuse_few(kept.depth.size());
    const auto [low, high] = std::ranges::minmax_element(kept.depth);
    if (*low == *high)
      throw InputError({}, "no depth is left between the limits of depth; widen them");
    kept.low = *low;
    kept.high = *high;
    return kept;
  }

  // The limits are counted from the contact point, which depends on the rows between them. The
  // fixed point is searched from all rows and from the first of them, since the contact point of a
  // curve that stiffens is too deep at first; the largest R^2 decides.
  ContactChoice chosen_part() {
    std::optional<ContactChoice> best;
    PressRows best_rows;
    double least = std::numeric_limits<double>::infinity();
    for (const double part : {1.0, 0.8, 0.6, 0.4}) {
      const double end = all_.low + part * all_.range();
      rows_ = those([&](double h) { return h <= end; });
      try {
        ContactChoice choice = chosen();
        for (int i = 0; i < 20 && narrow(choice.guess.contact); ++i) choice = chosen();
        const double lost = choice.guess.squares / total_squares();
        if (choice.guess.factor > 0.0 && lost < least) {
          least = lost;
          best = choice;
          best_rows = rows_;
        }
      } catch (const InputError&) {  // the first rows may show no contact
        if (part == 1.0) throw;
      }
    }
    if (!best)
      throw InputError({},
                       "no contact point fits the rows between the limits of depth; widen them");
    rows_ = std::move(best_rows);
    outside_ = all_.depth.size() - rows_.depth.size();
    return *best;
  }

  [[nodiscard]] double total_squares() const {
    double mean = 0.0;
    for (const double f : rows_.force) mean += f / static_cast<double>(rows_.force.size());
    double total = 0.0;
    for (const double f : rows_.force) total += (f - mean) * (f - mean);
    return std::max(total, 1e-300);
  }

  // How well the law describes the curve with the signs of depth and force turned: SSE; infinite
  // without a positive modulus.
  [[nodiscard]] double squares_with(double depth_sign, double force_sign) const {
    PressRows turned;
    for (const double h : rows_.depth) turned.depth.push_back(depth_sign * h);
    for (const double f : rows_.force) turned.force.push_back(force_sign * f);
    turned.low = depth_sign > 0.0 ? rows_.low : -rows_.high;
    turned.high = depth_sign > 0.0 ? rows_.high : -rows_.low;
    double least = std::numeric_limits<double>::infinity();
    for (const Baseline baseline : {Baseline::none, Baseline::offset, Baseline::tilt}) {
      const auto guess = search_contact(law_.unit, turned, baseline, {law_.deepest});
      if (!guess || !(guess->factor > 0.0)) continue;
      // A convex curve is a steep line minus contact at its other end: such a tilt is no baseline.
      const double pressed = guess->factor * law_.unit(turned.high - guess->contact).force;
      if (std::abs(guess->tilt) <= pressed) least = std::min(least, guess->squares);
    }
    return least;
  }

  // Advises to turn the sign only where a contact fits the turned curve better than a straight line
  // by a factor of three in the sum of squares.
  void refuse_what_shows_no_contact(const ContactChoice& choice) const {
    const ContactGuess& guess = choice.guess;
    const auto line = search_contact(law_.unit, rows_, Baseline::tilt, {law_.deepest});
    const double straight = line ? line->straight : 0.0;
    const bool grows = guess.factor > 0.0;
    const double negative = squares_with(1.0, -1.0);
    const double height = squares_with(-1.0, 1.0);
    const double both = squares_with(-1.0, -1.0);
    const double best = std::min({negative, height, both});
    const double here = grows ? guess.squares : std::numeric_limits<double>::infinity();
    if (best < 0.1 * here && best < straight / 3.0) {
      if (best == negative)
        throw InputError({},
                         "the load falls with depth; give `--compression negative` if the load "
                         "cell reports compression as negative, or another `--x`");
      throw InputError({}, std::string("the load ") + (best == height ? "grows" : "falls") +
                               " as the depth falls, as it does over a height; give `--compression "
                               "auto`, which turns the signs, or another `--x`");
    }
    if (!grows)
      throw InputError({},
                       "the load does not grow with depth anywhere, with any sign, so that the "
                       "curve shows no contact; name other columns by `--x` and `--y`");
    const auto n = static_cast<double>(rows_.depth.size());
    if (choice.baseline != Baseline::none && guess.straight > 0.0 &&
        n * std::log(guess.straight / std::max(guess.squares, 1e-300)) < 2.0 * std::log(n) + 6.0)
      throw InputError({},
                       "the curve shows no contact: a straight line describes it as well; record "
                       "more points in contact, or choose a part of the curve");
    const std::size_t beyond = rows_.depth.size() - guess.before;
    if (beyond < 3)
      throw InputError({}, "only " + std::to_string(beyond) +
                               " points lie beyond the contact point, which determine no modulus; "
                               "record more points in contact");
  }

  // Unknowns: E* divided by its guess, the contact point divided by the range unless it is known,
  // offset and tilt.
  void finish(const ContactChoice& choice) {
    const ContactGuess& guess = choice.guess;
    const double range = rows_.range();
    const std::size_t lead = test_.contact_point ? 1 : 2;
    const std::size_t count = lead + as_index(choice.baseline);
    const CurveAt curve = [&](std::span<const double> p, std::span<double> values,
                              std::span<double> slopes) {
      const double contact = lead == 1 ? guess.contact : p[1] * range;
      for (std::size_t i = 0; i < values.size(); ++i) {
        const TipForce unit = law_.unit(rows_.depth[i] - contact);
        const double along = (rows_.depth[i] - rows_.low) / range;
        values[i] = p[0] * guess.factor * unit.force;
        if (count > lead) values[i] += p[lead];
        if (count > lead + 1) values[i] += p[lead + 1] * along;
        if (slopes.empty()) continue;
        double* row = &slopes[i * count];
        row[0] = guess.factor * unit.force;
        if (lead > 1) row[1] = -p[0] * guess.factor * unit.stiffness * range;
        if (count > lead) row[lead] = 1.0;
        if (count > lead + 1) row[lead + 1] = along;
      }
      return true;
    };
    // Numbers near 0 begin at 0, so that the search does not scale by them.
    const auto start = [](double value) { return std::abs(value) < 1e-3 ? 0.0 : value; };
    std::vector<double> unknowns{1.0, guess.contact / range, start(guess.offset),
                                 start(guess.tilt)};
    const auto fitted = [&](auto& all) {
      if (lead == 1) all.erase(all.begin() + 1);
      all.resize(count);
    };
    fitted(unknowns);
    const Minimum minimum = minimise(rows_.force, curve, unknowns, {});

    // E = E* (1 - nu^2) for a rigid tip            Chen 2007 eq. (2); docs/theory.md [modulus]
    const double young = guess.factor * scale_ * (1.0 - test_.poisson_ratio * test_.poisson_ratio);
    std::vector<double> scale{unit::kPa.from_si(young), unit::mm.from_si(range), scale_,
                              scale_ / unit::mm.from_si(range)};
    fitted(scale);
    fit_.parameters = {{.name = "E", .unit = "kPa"},
                       {.name = "h_0", .unit = "mm"},
                       {.name = "F_0", .unit = "N"},
                       {.name = "tilt", .unit = "N/mm"}};
    fitted(fit_.parameters);
    settle(fit_, minimum, {rows_.force, scale_, scale, test_.residuals});
    if (fit_.termination == Termination::failed) return;
    describe(choice, minimum);
  }

  void describe(const ContactChoice& choice, const Minimum& minimum) {
    const double contact =
        test_.contact_point ? *test_.contact_point : minimum.parameters[1] * rows_.range();
    ContactResult result{test_, choice.baseline};
    result.deepest = rows_.high - contact;
    result.before =
        as_index(std::ranges::count_if(rows_.depth, [&](double h) { return h <= contact; }));
    result.beyond = rows_.depth.size() - result.before;
    const double pressed =
        minimum.parameters[0] * choice.guess.factor * law_.unit(result.deepest).force;
    result.drift =
        choice.baseline == Baseline::tilt ? std::abs(minimum.parameters.back() / pressed) : 0.0;
    fit_.law += with_baseline(choice.baseline);
    fit_.notes.push_back(
        std::to_string(result.before) + (result.before == 1 ? " point lies" : " points lie") +
        " before contact and " + std::to_string(result.beyond) + " beyond, up to a depth of " +
        rounded_text(unit::mm.from_si(result.deepest)) + " mm below the contact point");
    static constexpr std::array<const char*, 3> short_words{"none", "offset", "tilt"};
    for (const auto& [other, factor] : choice.others) {
      const double change = factor / choice.guess.factor - 1.0;
      if (std::abs(change) > 0.02)
        fit_.notes.push_back("`--baseline " + std::string(short_words[as_index(other)]) +
                             "` would change E by " + (change > 0.0 ? "+" : "-") +
                             percent_text(std::abs(change)));
    }
    if (choice.baseline != Baseline::none) {
      const double length = contact - rows_.low;
      fit_.notes.push_back("the baseline follows from " + std::to_string(result.before) +
                           " rows over " + rounded_text(unit::mm.from_si(length)) +
                           " mm before contact");
    }
    warn_of_contact(fit_, result);
  }

  const ContactTest& test_;
  Law law_;
  Fit fit_;
  PressRows all_;       // of the chosen way; forces divided by scale_
  PressRows rows_;      // those between `from` and `to`
  double scale_ = 0.0;  // N, largest magnitude
  std::size_t outside_ = 0;
};

}  // namespace

Fit fit_contact(std::span<const double> depth, std::span<const double> force,
                const ContactTest& test) {
  assert(depth.size() == force.size());
  Fit fit = ContactFit(depth, force, test).all();
  if (!(test.bending > 0.0)) return fit;
  // Once the curve is fitted the depth has back what the tilt took off it, and the force loses what
  // it adds over the bending.
  std::vector<double> straight_depth(depth.size()), straight_force(force.size());
  for (int k = 0; k < 2 && fit.parameters.back().name == "tilt"; ++k) {
    const double share = test.bending * fit.parameters.back().estimate / unit::mm.to_si(1.0);
    for (std::size_t i = 0; i < depth.size(); ++i) {
      straight_depth[i] = depth[i] + share * (depth[i] + test.bending * force[i] - depth[0]);
      straight_force[i] = force[i] / (1.0 + share);
    }
    fit = ContactFit(straight_depth, straight_force, test).all();
    fit.notes.emplace_back("the tilt of the baseline is taken as light, which bends nothing");
  }
  return fit;
}

}  // namespace palpate::fit
