// One ring of viscoelastic surface during a time step: pressed by the finger, or free.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "contact/relaxation.h"

namespace palpate::contact {

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

  // Advances branches or modes over the given part of a step, 0 to 1; `sinking` (m) is the
  // increment of w in that part. Exact for a whole step; for a part the error is of the order dt^3.
  void press(double part, double sinking, std::span<double> branches) const;
  void rise(double part, std::span<double> modes) const;

  // let_go() computes the modes (m) of a ring released at the displacement w (m) with the branches
  // q_k (m) when q is 0; meet() computes the branches (m) of a free ring when it meets the finger.
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
