// Converts relaxation to creep and back (the poles of one are the zeros between poles of the
// other), and moves rings into and out of contact during a time step.
#include "contact/viscous_contact.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

namespace palpate::contact {
namespace {

// a / (x - p)
struct Pole {
  double place = 0.0;   // p
  double weight = 0.0;  // a, above 0
};

// Solutions of  sum_k a_k / (x - p_k) = 1: one x after each of the ascending poles.
struct Roots {
  std::vector<double> places;  // x_m
  std::vector<double> gaps;    // x_m - p_k at [m n + k], each accurate to rounding
};

// The sum at p_origin + offset.
double sum_at(const std::vector<Pole>& poles, double origin, double offset) {
  double sum = 0.0;
  for (const Pole& pole : poles) sum += pole.weight / ((origin - pole.place) + offset);
  return sum;
}

// The last root is at most `last_width` after its pole.
Roots roots_of(const std::vector<Pole>& poles, double last_width) {
  Roots roots;
  for (std::size_t m = 0; m < poles.size(); ++m) {
    // After each pole the sum decreases from infinity. A root close to one end of its interval is
    // computed as the distance from that end, which keeps its digits.
    double origin = poles[m].place;
    const double width = m + 1 < poles.size() ? poles[m + 1].place - origin : last_width;
    double before = 0.0;  // an offset where the sum is above 1
    double behind = 0.5 * width;
    if (sum_at(poles, origin, behind) > 1.0) {
      before = -behind;
      behind = 0.0;
      origin += width;
    }
    for (;;) {
      const double middle = 0.5 * (before + behind);
      if (middle == before || middle == behind) break;
      (sum_at(poles, origin, middle) > 1.0 ? before : behind) = middle;
    }
    // The end itself is not a root.
    const double offset = behind == 0.0 ? before : behind;
    roots.places.push_back(origin + offset);
    for (const Pole& pole : poles) roots.gaps.push_back((origin - pole.place) + offset);
  }
  return roots;
}

// sum_k a_k / (x_m - p_k)^2
double slope_at(const std::vector<Pole>& poles, const Roots& roots, std::size_t m) {
  double sum = 0.0;
  for (std::size_t k = 0; k < poles.size(); ++k) {
    const double gap = roots.gaps[m * poles.size() + k];
    sum += poles[k].weight / gap / gap;
  }
  return sum;
}

// The branches of  1 / (1 - sum_m j_m s T_m / (1 + s T_m)),  sum j_m < 1, T_m ascending. Its poles
// s = -1/tau satisfy  sum_m j_m T_m / (T_m - tau) = 1; the residues are
// b = 1 / (tau sum_m j_m T_m / (T_m - tau)^2).
std::vector<Branch> branches_of(const std::vector<Branch>& modes) {
  std::vector<Pole> poles;  // in x = -tau
  for (std::size_t m = modes.size(); m-- > 0;)
    poles.push_back({.place = -modes[m].time, .weight = modes[m].ratio * modes[m].time});
  const Roots roots = roots_of(poles, poles.empty() ? 0.0 : -poles.back().place);
  std::vector<Branch> branches;
  for (std::size_t k = poles.size(); k-- > 0;) {
    const double tau = -roots.places[k];
    branches.push_back({.time = tau, .ratio = 1.0 / (tau * slope_at(poles, roots, k))});
  }
  return branches;
}

}  // namespace

double Relaxation::modulus_ratio(double time) const {
  double ratio = 1.0;
  for (const Branch& branch : branches) ratio += branch.ratio * std::exp(-time / branch.time);
  return ratio;
}

double Relaxation::ramp_response(double rate, double ramp_time, double time) const {
  const double grown = std::min(time, ramp_time);
  double strain = rate * grown;
  constexpr double rounding = 1e-12;  // the end belongs to the ramp
  if (time <= (1.0 + rounding) * ramp_time) strain += rate * retardation_time;
  for (const Branch& branch : branches)
    strain += branch.ratio * rate * branch.time * std::exp(-(time - grown) / branch.time) *
              -std::expm1(-grown / branch.time);
  return strain;
}

double Creep::compliance_ratio(double time) const {
  // (1 - sum j) + sum j (1 - exp(-t/T)): the instantaneous and the delayed part
  double at_once = 1.0, later = 0.0;
  for (const Branch& mode : modes) {
    at_once -= mode.ratio;
    later -= mode.ratio * std::expm1(-time / mode.time);
  }
  return at_once + later;
}

double Creep::recovery_ratio(double load_time, double time) const {
  // J(load_time + t) - J(t) = sum j (1 - exp(-load_time/T)) exp(-t/T), without cancellation
  double left = 0.0;
  for (const Branch& mode : modes)
    left -= mode.ratio * std::expm1(-load_time / mode.time) * std::exp(-time / mode.time);
  return left;
}

Relaxation sorted(const Relaxation& relaxation) {
  assert(relaxation.branches.empty() || relaxation.retardation_time == 0.0);
  assert(relaxation.retardation_time >= 0.0);
  Relaxation result{.branches = {}, .retardation_time = relaxation.retardation_time};
  std::vector<Branch> given = relaxation.branches;
  std::ranges::sort(given, {}, &Branch::time);
  for (const Branch& branch : given) {
    assert(branch.time > 0.0 && branch.ratio >= 0.0);
    if (branch.ratio == 0.0) continue;
    if (!result.branches.empty() && result.branches.back().time == branch.time)
      result.branches.back().ratio += branch.ratio;
    else
      result.branches.push_back(branch);
  }
  return result;
}

Creep creep(const Relaxation& relaxation) {
  if (relaxation.retardation_time > 0.0)
    return {.modes = {{.time = relaxation.retardation_time, .ratio = 1.0}}, .gaps = {}};
  // 1 / (1 + sum_k b_k s tau_k / (1 + s tau_k)) has its poles s = -1/T where
  //   sum_k b_k tau_k / (T - tau_k) = 1,   j = 1 / (T sum_k b_k tau_k / (T - tau_k)^2)
  std::vector<Pole> poles;
  for (const Branch& branch : sorted(relaxation).branches)
    poles.push_back({.place = branch.time, .weight = branch.ratio * branch.time});
  // After the last pole the sum is at most bound / (x - p_last), so the root is within `bound`.
  double bound = 0.0;
  for (const Pole& pole : poles) bound += pole.weight;
  Roots roots = roots_of(poles, 2.0 * bound);
  Creep result;
  for (std::size_t m = 0; m < poles.size(); ++m) {
    const double T = roots.places[m];
    result.modes.push_back({.time = T, .ratio = 1.0 / (T * slope_at(poles, roots, m))});
  }
  result.gaps = std::move(roots.gaps);
  return result;
}

Relaxation behind_finger(const Relaxation& tissue, double finger_share) {
  assert(finger_share >= 0.0 && finger_share <= 1.0);
  if (finger_share == 0.0) return sorted(tissue);
  if (finger_share == 1.0) return {};
  // In series, compliances add, and the finger does not creep: J* = lambda_1 + lambda_2 J / J_inf
  // has the tissue's times; each ratio is multiplied by lambda_2 / (lambda_1 + lambda_2).
  Creep together = creep(tissue);
  for (Branch& mode : together.modes) mode.ratio *= 1.0 - finger_share;
  return {.branches = branches_of(together.modes), .retardation_time = 0.0};
}

namespace {

// exp(-x) and (1 - exp(-x)) / x, accurate to x^3/6 and x^2/6 and decreasing from 1 to 0 as well.
double fade(double x) { return 1.0 / (1.0 + x + 0.5 * x * x); }
double mean_fade(double x) { return (1.0 + 0.5 * x) * fade(x); }

// Both at part * x, corrected so that they are exact for the whole step; the remaining error is of
// the next order. This avoids an exponential for every ring that enters or leaves within a step.
double fade_over(double part, double x, double whole) {
  return fade(part * x) + part * part * part * (whole - fade(x));
}
double mean_fade_over(double part, double x, double whole) {
  return mean_fade(part * x) + part * part * (whole - mean_fade(x));
}

}  // namespace

ViscousRing::ViscousRing(const Relaxation& relaxation)
    : relaxation_(sorted(relaxation)),
      creep_(creep(relaxation_)),
      branch_keep_(relaxation_.branches.size(), 1.0),
      mode_keep_(creep_.modes.size(), 1.0) {
  for (const Branch& branch : relaxation_.branches) branch_gain_.push_back(branch.ratio);
  // j_m = 1 / (T_m sum_k b_k tau_k / (T_m - tau_k)^2)
  for (const Branch& mode : creep_.modes) slopes_.push_back(1.0 / (mode.time * mode.ratio));
}

void ViscousRing::set_time_step(double time_step) {
  assert(time_step >= 0.0);
  if (time_step == time_step_) return;
  time_step_ = time_step;
  for (std::size_t k = 0; k < branch_keep_.size(); ++k) {
    const auto [tau, b] = relaxation_.branches[k];
    branch_keep_[k] = std::exp(-time_step / tau);
    // b tau/dt (1 - exp(-dt/tau))
    branch_gain_[k] = time_step > 0.0 ? -b * tau / time_step * std::expm1(-time_step / tau) : b;
  }
  for (std::size_t m = 0; m < mode_keep_.size(); ++m)
    mode_keep_[m] = std::exp(-time_step / creep_.modes[m].time);
}

void ViscousRing::press(double part, double surface_displacement,
                        std::span<double> branches) const {
  for (std::size_t k = 0; k < branches.size(); ++k) {
    const auto [tau, b] = relaxation_.branches[k];
    const double x = time_step_ / tau;
    branches[k] = fade_over(part, x, branch_keep_[k]) * branches[k] +
                  b * mean_fade_over(part, x, branch_gain_[k] / b) * surface_displacement;
  }
}

void ViscousRing::rise(double part, std::span<double> modes) const {
  for (std::size_t m = 0; m < modes.size(); ++m)
    modes[m] *= fade_over(part, time_step_ / creep_.modes[m].time, mode_keep_[m]);
}

void ViscousRing::let_go(double surface_displacement, std::span<const double> branches,
                         std::span<double> modes) const {
  // y_m = -sum_k q_k / (T_m - tau_k) / sum_k b_k tau_k / (T_m - tau_k)^2. For a ring that was only
  // pushed, no mode is negative; if interpolation in a long step makes one negative, it is set to 0
  // and the others are scaled to the sum w. Kelvin-Voigt has one mode, w.
  const std::size_t n = branches.size();
  double sum = 0.0;
  for (std::size_t m = 0; m < modes.size(); ++m) {
    double mode = 0.0;
    for (std::size_t k = 0; k < n; ++k) mode -= branches[k] / creep_.gaps[m * n + k];
    modes[m] = n > 0 ? std::max(mode / slopes_[m], 0.0) : 1.0;
    sum += modes[m];
  }
  const double scale = sum > 0.0 ? std::max(surface_displacement, 0.0) / sum : 0.0;
  for (double& mode : modes) mode *= scale;
}

void ViscousRing::meet(std::span<const double> modes, std::span<double> branches) const {
  // q_k = -sum_m b_k tau_k / (T_m - tau_k) y_m
  const std::size_t n = branches.size();
  for (std::size_t k = 0; k < n; ++k) {
    branches[k] = 0.0;
    for (std::size_t m = 0; m < modes.size(); ++m) branches[k] -= modes[m] / creep_.gaps[m * n + k];
    branches[k] *= relaxation_.branches[k].ratio * relaxation_.branches[k].time;
  }
}

FadingStack::FadingStack(std::size_t rates, std::size_t values, std::size_t capacity)
    : rates_(rates),
      stride_(rates * values),
      capacity_(capacity),
      heads_(capacity),
      values_(capacity * stride_),
      links_(capacity * rates),
      age_(rates, 1.0),
      age_before_(rates, 1.0) {
  assert(capacity >= 8);
}

void FadingStack::fade(std::span<const double> keep) {
  age_before_ = age_;
  for (std::size_t k = 0; k < rates_; ++k) age_[k] *= keep[k];
}

double FadingStack::value(std::size_t j) const {
  return age_[j % rates_] * values_[(size_ - 1) * stride_ + j];
}

double FadingStack::value_before(std::size_t j) const {
  return age_before_[j % rates_] * values_[(size_ - 1) * stride_ + j];
}

void FadingStack::push(double level, double elastic_force, std::span<const double> values) {
  if (size_ == capacity_) thin();
  heads_[size_] = {level, elastic_force};
  for (std::size_t j = 0; j < stride_; ++j) values_[size_ * stride_ + j] = values[j];
  for (std::size_t k = 0; k < rates_; ++k) {
    links_[size_ * rates_ + k] = age_[k];
    age_[k] = age_before_[k] = 1.0;
  }
  ++size_;
}

void FadingStack::pop() {
  --size_;
  for (std::size_t k = 0; k < rates_; ++k) {
    age_[k] *= links_[size_ * rates_ + k];
    age_before_[k] *= links_[size_ * rates_ + k];
  }
}

void FadingStack::thin() {
  // Removes rings closer than about 2/capacity of the height. At most half of them and the two ends
  // stay, so that this happens at most once in about capacity / 2 pushes.
  const double height = std::abs(heads_[size_ - 1].level - heads_[0].level);
  const double spacing = 2.0 * height / static_cast<double>(capacity_ - 4);
  std::size_t kept = 1;
  for (std::size_t i = 1; i < size_; ++i) {
    for (std::size_t k = 0; k < rates_; ++k) links_[kept * rates_ + k] = links_[i * rates_ + k];
    const bool last = i + 1 == size_;
    if (!last && std::abs(heads_[i].level - heads_[kept - 1].level) < spacing) {
      for (std::size_t k = 0; k < rates_; ++k)
        links_[(i + 1) * rates_ + k] *= links_[i * rates_ + k];
      continue;
    }
    heads_[kept] = heads_[i];
    for (std::size_t j = 0; j < stride_; ++j)
      values_[kept * stride_ + j] = values_[i * stride_ + j];
    ++kept;
  }
  size_ = kept;
}

namespace {

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

double three_halves(double h) { return h * std::sqrt(h); }

// phi at `level`, linear in h^(3/2) between two rings: exact for Hertz and elliptic contacts.
double between(double level, double lower, double lower_force, double upper, double upper_force) {
  const double start = three_halves(lower);
  const double width = three_halves(upper) - start;
  if (!(width > 0.0)) return upper_force;
  return lower_force + (upper_force - lower_force) * ((three_halves(level) - start) / width);
}

// The fraction of a step after which a quantity that goes linearly from `start` to `end` is 0.
double moment_of_zero(double start, double end) {
  return std::clamp(start / (start - end), 0.0, 1.0);
}

}  // namespace

ViscousContact::ViscousContact(const Relaxation& relaxation, std::size_t rings)
    : law_(relaxation),
      drive_(law_.branch_count()),
      drive_before_(law_.branch_count()),
      pressed_(law_.branch_count(), 2, rings),
      free_(law_.mode_count(), 1, rings),
      edge_modes_(law_.mode_count()),
      branches_(law_.branch_count()),
      outer_branches_(law_.branch_count()),
      modes_(law_.mode_count()),
      row_(2 * law_.branch_count()) {
  free_.push(0.0, 0.0, modes_);  // the middle of the future contact
}

double ViscousContact::step(double time_step, double depth, double elastic_force) {
  if (law_.elastic()) {
    depth_ = depth;
    return force_ = depth > 0.0 ? elastic_force : 0.0;
  }
  pass_time(time_step, depth);
  // While a press is held, the edge does not move, except for rounding.
  constexpr double rounding = 1e-14;
  if (!pressed_.empty() && push_of_top() < -rounding * pressed_.level())
    shrink();
  else
    grow(elastic_force);
  return force_ = force_at_end();
}

void ViscousContact::pass_time(double time_step, double depth) {
  law_.set_time_step(time_step);
  depth_before_ = depth_;
  depth_ = depth;
  const double travel = depth_ - depth_before_;
  rate_ = time_step > 0.0 ? travel / time_step : 0.0;
  drive_before_ = drive_;
  // q_k <- exp(-dt/tau_k) q_k + b_k tau_k/dt (1 - exp(-dt/tau_k)) (h_1 - h_0)
  for (std::size_t k = 0; k < drive_.size(); ++k)
    drive_[k] = law_.branch_keep()[k] * drive_[k] + law_.branch_gain()[k] * travel;
  pressed_.fade(law_.branch_keep());
  free_.fade(law_.mode_keep());
  for (std::size_t m = 0; m < edge_modes_.size(); ++m) edge_modes_[m] *= law_.mode_keep()[m];
}

// q = (h - c) + tau h' + sum_k q_k of the top ring in contact, m.
double ViscousContact::push_of_top() const {
  double push = (depth_ - pressed_.level()) + law_.retardation_time() * rate_;
  for (std::size_t k = 0; k < drive_.size(); ++k) push += drive_[k] + pressed_.value(k);
  return push;
}

// The depth at which a finger would meet the nearest free ring, m.
double ViscousContact::place_of_free() const {
  double place = free_.level();
  for (std::size_t m = 0; m < modes_.size(); ++m) place += free_.value(m);
  return place;
}

void ViscousContact::shrink() {
  double outer_push = 0.0, outer_level = 0.0, outer_force = 0.0;
  double push = push_of_top();
  do {
    outer_push = push;
    outer_level = pressed_.level();
    outer_force = pressed_.elastic_force();
    for (std::size_t k = 0; k < drive_.size(); ++k)
      outer_branches_[k] = drive_[k] + pressed_.value(k);
    release_top();
    if (pressed_.empty()) return;
    push = push_of_top();
  } while (push < 0.0);
  // The edge is where q = 0 between the outermost pressed ring and the ring last released.
  const double part = push / (push - outer_push);
  const double inner_level = pressed_.level();
  const double level = std::lerp(inner_level, outer_level, part);
  for (std::size_t k = 0; k < drive_.size(); ++k) {
    const double inner = drive_[k] + pressed_.value(k);
    branches_[k] = std::lerp(inner, outer_branches_[k], part);
  }
  law_.let_go(depth_ - level, branches_, edge_modes_);
  if (level > inner_level)
    lay_edge(level,
             between(level, inner_level, pressed_.elastic_force(), outer_level, outer_force));
}

void ViscousContact::grow(double elastic_force) {
  while (!free_.empty() && place_of_free() < depth_) join_top();
  if (pressed_.empty()) return;
  const double inner_level = pressed_.level();
  const double place = inner_level + sum(edge_modes_);
  if (depth_ <= place) return;
  if (free_.empty()) {
    std::ranges::fill(edge_modes_, 0.0);
    std::ranges::fill(branches_, 0.0);
    lay_edge(depth_, elastic_force);
    return;
  }
  // The edge is where the free surface, linear between two rings, meets the finger.
  const double part = (depth_ - place) / (place_of_free() - place);
  const double level = std::lerp(inner_level, free_.level(), part);
  for (std::size_t m = 0; m < edge_modes_.size(); ++m)
    edge_modes_[m] = std::lerp(edge_modes_[m], free_.value(m), part);
  law_.meet(edge_modes_, branches_);
  if (level > inner_level)
    lay_edge(level, between(level, inner_level, pressed_.elastic_force(), free_.level(),
                            free_.elastic_force()));
}

// Releases the top ring at the moment of the step when its q became zero.
void ViscousContact::release_top() {
  const double level = pressed_.level();
  double start = (depth_before_ - level) + law_.retardation_time() * rate_;
  for (std::size_t k = 0; k < drive_.size(); ++k)
    start += drive_before_[k] + pressed_.value_before(k);
  const double moment = start > 0.0 ? moment_of_zero(start, push_of_top()) : 0.0;
  for (std::size_t k = 0; k < drive_.size(); ++k) {
    const double first = drive_before_[k] + pressed_.value_before(k);
    const double last = drive_[k] + pressed_.value(k);
    branches_[k] = std::lerp(first, last, moment);
  }
  const double depth = std::lerp(depth_before_, depth_, moment);
  law_.let_go(depth - level, branches_, modes_);
  law_.rise(1.0 - moment, modes_);
  // The ring must not rise above the finger, which could happen in a step much longer than tau.
  modes_[0] += std::max(depth_ - level - sum(modes_), 0.0);
  free_.push(level, pressed_.elastic_force(), modes_);
  pressed_.pop();
}

// Adds the nearest free ring to the contact at the moment of the step when the finger met it.
void ViscousContact::join_top() {
  double before = free_.level();
  for (std::size_t m = 0; m < modes_.size(); ++m) {
    modes_[m] = free_.value_before(m);
    edge_modes_[m] = free_.value(m);
    before += modes_[m];
  }
  const double gap = before - depth_before_;
  const double moment = gap > 0.0 ? moment_of_zero(gap, place_of_free() - depth_) : 0.0;
  law_.rise(moment, modes_);
  law_.meet(modes_, branches_);
  const double rest = 1.0 - moment;
  law_.press(rest, rest * (depth_ - depth_before_), branches_);
  const double level = free_.level();
  const double elastic_force = free_.elastic_force();
  free_.pop();
  lay_edge(level, elastic_force);
}

// Pushes a ring with the branches `branches_` onto the pressed rings. Between two rings q_k is
// linear, and F_k grows by  -dq_k/dc (phi_1 - phi_0).
void ViscousContact::lay_edge(double level, double elastic_force) {
  const std::size_t n = drive_.size();
  for (std::size_t k = 0; k < n; ++k) {
    row_[k] = branches_[k] - drive_[k];
    row_[n + k] = 0.0;
    if (pressed_.empty()) continue;
    const double width = level - pressed_.level();
    const double fall = pressed_.value(k) - row_[k];
    row_[n + k] = pressed_.value(n + k);
    if (width > 0.0) row_[n + k] += fall * (elastic_force - pressed_.elastic_force()) / width;
  }
  pressed_.push(level, elastic_force, row_);
}

double ViscousContact::force_at_end() const {
  if (pressed_.empty()) return 0.0;
  const std::size_t n = drive_.size();
  double force = pressed_.elastic_force();
  for (std::size_t k = 0; k < n; ++k) force += pressed_.value(n + k);
  // The edge of a Kelvin-Voigt contact carries force, q(b) phi'(b), with phi linear in h^(3/2).
  const double push = push_of_top();
  if (push > 0.0 && pressed_.size() > 1) {
    const double level = pressed_.level();
    const double width = three_halves(level) - three_halves(pressed_.level_below());
    if (width > 0.0)
      force += push * 1.5 * std::sqrt(level) *
               (pressed_.elastic_force() - pressed_.elastic_force_below()) / width;
  }
  return std::max(force, 0.0);
}

double ViscousContact::contact_depth() const {
  if (law_.elastic()) return std::max(depth_, 0.0);
  return pressed_.empty() ? 0.0 : pressed_.level();
}

double ViscousContact::surface_depth() const {
  if (law_.elastic()) return std::max(depth_, 0.0);
  return pressed_.empty() ? place_of_free() : depth_;
}

}  // namespace palpate::contact
