// Relaxation functions of tissue, the corresponding creep, and the effect of an elastic finger; and
// a finger on viscoelastic tissue without a mesh: the force for any loading history.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace palpate::contact {

// One exponential term of a spectrum.
struct Branch {
  double time = 0.0;   // s, above 0
  double ratio = 0.0;  // relative to the relaxed modulus or compliance
};

// E(t) / E_inf of a tissue with constant Poisson's ratio: elastic (no branches, no retardation
// time), with Maxwell branches (one makes a standard linear solid),
//   E(t) = E_inf (1 + sum_k b_k exp(-t / tau_k)),                   docs/theory.md [relaxation]
// or Kelvin-Voigt, E(t) = E_inf (1 + tau delta(t)). Not both; times above 0, ratios at least 0.
struct Relaxation {
  std::vector<Branch> branches;   // tau_k and b_k, in any order
  double retardation_time = 0.0;  // s: tau = eta / E_inf of Kelvin-Voigt, otherwise 0

  [[nodiscard]] bool elastic() const { return branches.empty() && retardation_time == 0.0; }
  // E(t) / E_inf for t >= 0 (s); 1 for Kelvin-Voigt, without the impulse at t = 0.
  [[nodiscard]] double modulus_ratio(double time) const;
  // Stress over E_inf at `time` (s) after the start of a strain that grows at `rate` (1/s) for
  // `ramp_time` (s), at whose end it still grows, and then stays. docs/theory.md [compression]
  [[nodiscard]] double ramp_response(double rate, double ramp_time, double time) const;
};

// J(t) E_inf = 1 - sum_m j_m exp(-t / T_m): strain under constant stress over its final value.
struct Creep {
  std::vector<Branch> modes;  // T_m and j_m, times ascending
  // T_m - tau_k at [m n + k], computed without cancellation, for n branches with ascending tau_k;
  // empty for Kelvin-Voigt, which has no branch.
  std::vector<double> gaps;  // s

  // J(t) E_inf for t >= 0, s.
  [[nodiscard]] double compliance_ratio(double time) const;
  // The same at `time` (s) after the end of a stress that lasted for `load_time` (s).
  [[nodiscard]] double recovery_ratio(double load_time, double time) const;
};

// The creep function of a relaxation function: as many modes as branches, T_m between tau_m and
// tau_(m+1). For one branch T = tau E_0 / E_inf. For set-up only.         Park and Schapery 1999
[[nodiscard]] Creep creep(const Relaxation& relaxation);

// Sorts the branches by time, merges those of equal time and removes those with ratio 0.
[[nodiscard]] Relaxation sorted(const Relaxation& relaxation);

// The relaxation of the effective modulus E*(t) of an elastic finger in series with a relaxing
// tissue, divided by the relaxed value 1 / (lambda_1 + lambda_2). `finger_share` in [0, 1] is
// lambda_1 / (lambda_1 + lambda_2), the finger's fraction of the relaxed compliance: 0 gives
// `sorted(tissue)`, 1 an elastic contact. Kelvin-Voigt tissue becomes a standard linear solid.
// Valid if a pressure deforms both bodies alike: for two half-spaces, not for a layer.
[[nodiscard]] Relaxation behind_finger(const Relaxation& tissue, double finger_share);

// One ring of viscoelastic surface during a time step: pressed by the finger, or free.
// A ring displaced by w pushes back with q = w + tau w' + sum_k q_k. Each branch q_k follows
//   q_k' = b_k w' - q_k / tau_k
// and tau is that of Kelvin-Voigt. All are in m: forces divided by the ring's relaxed stiffness. A
// free ring, q = 0, recovers by the modes of creep, w = sum_m y_m; y_m decays with the time T_m.
//                                                       Park and Schapery 1999
class ViscousRing {
 public:
  explicit ViscousRing(const Relaxation& relaxation);

  [[nodiscard]] std::size_t branch_count() const { return relaxation_.branches.size(); }
  [[nodiscard]] std::size_t mode_count() const { return creep_.modes.size(); }
  [[nodiscard]] bool elastic() const { return relaxation_.elastic(); }
  [[nodiscard]] double retardation_time() const { return relaxation_.retardation_time; }  // s

  // Sets the length of the following steps, s; 0 is instantaneous. A new one costs exponentials.
  void set_time_step(double time_step);

  // Over a whole step: the factor by which a branch decays, the increment of a branch per
  // displacement at constant speed, and the factor by which a mode decays.
  [[nodiscard]] std::span<const double> branch_keep() const { return branch_keep_; }
  [[nodiscard]] std::span<const double> branch_gain() const { return branch_gain_; }
  [[nodiscard]] std::span<const double> mode_keep() const { return mode_keep_; }

  // Advances branches or modes over the given part of a step, 0 to 1; `surface_displacement` (m) is
  // the increment of w in that part. Exact for a whole step; for a part the error is of the order
  // dt^3.
  void press(double part, double surface_displacement, std::span<double> branches) const;
  void rise(double part, std::span<double> modes) const;

  // let_go() computes the modes (m) of a ring released at the displacement w (m) with the branches
  // q_k (m) when q is 0; meet() computes the branches (m) of a free ring when it meets the finger.
  void let_go(double surface_displacement, std::span<const double> branches,
              std::span<double> modes) const;
  void meet(std::span<const double> modes, std::span<double> branches) const;

 private:
  Relaxation relaxation_;
  Creep creep_;
  std::vector<double> slopes_;  // sum_k b_k tau_k / (T_m - tau_k)^2 of each mode, 1/s
  double time_step_ = 0.0;
  std::vector<double> branch_keep_, branch_gain_, mode_keep_;
};

// The stored rings of a viscoelastic contact, and the decay of their values.
// A stack of rings. A ring has a level (m), the elastic force at that level (N), and values that
// have decayed since it was pushed: value j with rate j % rates. The cost of a time step does not
// depend on the number of rings, because only the age of the top ring is stored and, for each ring,
// how much older the one below it is. Memory is allocated at construction only. When the stack is
// full, rings are removed where they are closest; levels are monotonic from the bottom to the top.
class FadingStack {
 public:
  // `rates` exponential rates with `values` >= 0 values each, and room for `capacity` >= 8 rings.
  FadingStack(std::size_t rates, std::size_t values, std::size_t capacity);

  [[nodiscard]] bool empty() const { return size_ == 0; }
  [[nodiscard]] std::size_t size() const { return size_; }

  // A time step in which rate k decays by the factor keep[k]; value_before() refers to its start.
  void fade(std::span<const double> keep);

  // The top ring.
  [[nodiscard]] double level() const { return heads_[size_ - 1].level; }
  [[nodiscard]] double elastic_force() const { return heads_[size_ - 1].elastic_force; }
  [[nodiscard]] double value(std::size_t j) const;
  [[nodiscard]] double value_before(std::size_t j) const;
  // The ring below the top ring; the stack must have two.
  [[nodiscard]] double level_below() const { return heads_[size_ - 2].level; }
  [[nodiscard]] double elastic_force_below() const { return heads_[size_ - 2].elastic_force; }

  void push(double level, double elastic_force, std::span<const double> values);
  void pop();

 private:
  struct Head {
    double level = 0.0;          // m
    double elastic_force = 0.0;  // N
  };

  void thin();

  std::size_t rates_, stride_, capacity_;
  std::size_t size_ = 0;
  std::vector<Head> heads_;
  std::vector<double> values_;  // [ring][value], when they were pushed
  std::vector<double> links_;   // [ring][rate]: decay of the ring below until this one was pushed
  std::vector<double> age_;     // [rate]: decay of the top ring until now
  std::vector<double> age_before_;  // [rate]: until the start of the step
};

// The force of a press h(t) on tissue with the relaxed elastic force phi(h). phi may be any
// function of the depth with phi(0) = 0 and an increasing slope, such as Hertz's or a layer's, if
// each contact area contains those of smaller depths. Loading follows Lee and Radok's integral,
// unloading Ting's; reloading, repeated presses and presses into a surface that is still recovering
// follow the same theory. There is no adhesion, and Poisson's ratio is constant.
//
// Method: for any history the surface acts as independent rings. An elastic contact reaches the
// ring of level c at the depth c. Displaced by w (h - c in contact), the ring pushes back with q
// per unit of its stiffness phi''(c); it is free where q would become tensile:
//   F = integral over 0 < c < b of q(c, t) phi''(c) dc,    q(b, t) = 0 at the contact's edge b.
//                     Ting 1966, 1968; Argatov and Popov 2016; docs/theory.md [viscous]
// At the end of each step a ring is stored at the contact's edge; between rings q is linear in c
// and phi in h^(3/2). The error is of second order in the time step while it is below the branches'
// times; for longer steps, and for Kelvin-Voigt, whose rate is the mean of the step, of first
// order. In loading the method is exact if phi(h(t)) is linear within the steps, and for an
// instantaneous step. To try a step out, copy the object.
class ViscousContact {
 public:
  // Starts out of contact and at rest, with the finger at depth 0. `rings` is the capacity for
  // stored rings; beyond it, features closer than about 2 / rings of the depth are lost.
  explicit ViscousContact(const Relaxation& relaxation, std::size_t rings = 4096);

  // Moves the finger at constant speed in `time_step` (s, >= 0; 0 is instantaneous, without
  // Kelvin-Voigt's damper) to `depth` (m; negative above the undeformed surface). `elastic_force`
  // is phi(depth), N; 0 for depth <= 0. Returns the force at the end of the step, N, never
  // negative. A new time step costs exponentials for each branch and mode; otherwise only + - * /
  // and sqrt are used, and the cost is that of the rings which the edge passes.
  double step(double time_step, double depth, double elastic_force);

  [[nodiscard]] double force() const { return force_; }  // N, after the last step
  // b, m: the depth at which an elastic contact has the same area; 0 without contact.
  [[nodiscard]] double contact_depth() const;
  // m: the depth of the surface in the middle of the contact: that of the finger, or the impression
  // that is left after a press; 0 on a surface at rest.
  [[nodiscard]] double surface_depth() const;

 private:
  void pass_time(double time_step, double depth);
  void shrink();
  void grow(double elastic_force);
  void release_top();
  void join_top();
  void lay_edge(double level, double elastic_force);
  [[nodiscard]] double push_of_top() const;
  [[nodiscard]] double place_of_free() const;
  [[nodiscard]] double force_at_end() const;

  ViscousRing law_;

  // Values at the end of the step and (`before`) at its start. `drive` (m) is q_k of a ring that
  // has never been free; in any other ring in contact, q_k differs from it by a decaying term.
  double depth_ = 0.0, depth_before_ = 0.0;  // m
  double rate_ = 0.0;                        // m/s, mean of the step
  std::vector<double> drive_, drive_before_;

  FadingStack pressed_;  // rings in contact, the edge on top: q_k - drive_k (m), then the force of
                         // branch k inside the ring (N)
  FadingStack free_;     // free rings outside, the nearest on top: creep modes, m
  std::vector<double> edge_modes_;  // creep modes of the edge's ring, if it were free, m

  std::vector<double> branches_, outer_branches_, modes_, row_;  // buffers for one ring

  double force_ = 0.0;
};

}  // namespace palpate::contact
