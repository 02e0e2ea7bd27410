// Converts relaxation to creep and back: the poles of one are the zeros between poles of the other.
#include "contact/relaxation.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
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
  if (time < ramp_time) strain += rate * retardation_time;
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
  std::sort(given.begin(), given.end(),
            [](const Branch& a, const Branch& b) { return a.time < b.time; });
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

}  // namespace palpate::contact
