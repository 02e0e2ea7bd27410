// Moves rings into and out of contact during a time step.
#include "contact/viscous_contact.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace palpate::contact {
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
    edge_ = depth <= 0.0     ? ContactEdge::apart
            : depth > depth_ ? ContactEdge::growing
            : depth < depth_ ? ContactEdge::shrinking
                             : ContactEdge::resting;
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
    if (pressed_.empty()) {
      edge_ = ContactEdge::apart;
      return;
    }
    push = push_of_top();
  } while (push < 0.0);
  edge_ = ContactEdge::shrinking;
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
  edge_ = pressed_.empty() ? ContactEdge::apart : ContactEdge::resting;
  while (!free_.empty() && place_of_free() < depth_) join_top();
  if (pressed_.empty()) return;
  const double inner_level = pressed_.level();
  const double place = inner_level + sum(edge_modes_);
  if (depth_ <= place) return;
  if (free_.empty()) {
    edge_ = ContactEdge::growing;
    std::fill(edge_modes_.begin(), edge_modes_.end(), 0.0);
    std::fill(branches_.begin(), branches_.end(), 0.0);
    lay_edge(depth_, elastic_force);
    return;
  }
  // The edge is where the free surface, linear between two rings, meets the finger.
  edge_ = ContactEdge::returning;
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
