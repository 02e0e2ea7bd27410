// One ring of viscoelastic surface through a step of time: pressed by the finger, or let go.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "contact/relaxation.h"

namespace palpate::contact {

// A ring sunk by w pushes back with q = w + tau w' + sum_k q_k, where each branch q_k follows
//   q_k' = b_k w' - q_k / tau_k
// and tau is Kelvin-Voigt's; in m, as forces over the ring's relaxed stiffness. Let go, q = 0, it
// rises by the modes of creep: w = sum_m y_m, each y_m fading with its T_m.
//                                                      Park and Schapery 1999
class ViscousRing {
 public:
  explicit ViscousRing(const Relaxation& relaxation);

  [[nodiscard]] std::size_t branch_count() const { return relaxation_.branches.size(); }
  [[nodiscard]] std::size_t mode_count() const { return creep_.modes.size(); }
  [[nodiscard]] bool elastic() const { return relaxation_.elastic(); }
  [[nodiscard]] double retardation_time() const { return relaxation_.retardation_time; }  // s

  // For the steps to come, s; 0 is at once. An exp for each branch and mode if it is a new one.
  void set_time_step(double time_step);

  // Over a whole step: what stays of a branch, what a steady sinking by 1 in the step adds to it,
  // what stays of a mode.
  [[nodiscard]] std::span<const double> branch_keep() const { return branch_keep_; }
  [[nodiscard]] std::span<const double> branch_gain() const { return branch_gain_; }
  [[nodiscard]] std::span<const double> mode_keep() const { return mode_keep_; }

  // Over the given part of a step, 0 to 1; `sinking` (m) is what w grows by in it. Exact for the
  // whole step; for a part to the order of dt^3.
  void press(double part, double sinking, std::span<double> branches) const;
  void rise(double part, std::span<double> modes) const;

  // The modes (m) of a ring that is let go at the sinking w (m) with the branches q_k (m) when
  // its q is 0, and the branches of one that has been free.
  void let_go(double sinking, std::span<const double> branches, std::span<double> modes) const;
  void meet(std::span<const double> modes, std::span<double> branches) const;

 private:
  Relaxation relaxation_;
  Creep creep_;
  std::vector<double> slopes_;  // sum_k b_k tau_k / (T_m - tau_k)^2 of each mode, 1/s
  double time_step_ = 0.0;
  std::vector<double> branch_keep_, branch_gain_, mode_keep_;
};

}  // namespace palpate::contact
