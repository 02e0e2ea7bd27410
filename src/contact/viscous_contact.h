// A finger on a viscoelastic tissue, without a mesh: the force of any history of presses.
#pragma once

#include <cstddef>
#include <vector>

#include "contact/relaxation.h"
#include "contact/viscous_ring.h"
#include "contact/viscous_stack.h"

namespace palpate::contact {

// What the contact's edge did in a step.
enum class ContactEdge {
  apart,      // there is no contact
  growing,    // onto surface that was never touched: Lee and Radok's loading
  resting,    // it stays where it is
  shrinking,  // Ting's unloading
  returning,  // onto surface that it had left and that is recovering
};

// The force of a press h(t) on a tissue whose elastic, relaxed answer phi(h) is known: any function
// of the depth alone that grows from phi(0) = 0 with a rising slope, Hertz's or a layer's, if its
// contact areas enclose one another. In loading it is Lee and Radok's integral, in unloading
// Ting's; reloading after partial unloading, repeated presses, and presses into a surface that
// still recovers follow the same theory. There is no adhesion, and Poisson's ratio is constant.
//
// How: under any history the surface acts as rings that know nothing of each other. The ring of
// level c is reached where an elastic contact has the depth c; sunk by w, h - c in contact, it
// pushes back with q (per unit of its strength phi''(c)), and is free where q would pull:
//   F = integral over 0 < c < b of q(c, t) phi''(c) dc,    q(b, t) = 0 at the contact's edge b.
//                         Ting 1966, 1968; Argatov and Popov 2016; docs/theory.md (64)
// Rings are laid down where the edge is at the end of each step; between them q runs straight, and
// phi as h^(3/2).
//
// Second order in the time step while that is below the branches' times; first order for longer
// ones and for Kelvin-Voigt, whose rate is the step's mean. In loading exact where phi(h(t)) is
// linear within the steps, and for a step at once. A copy tries a step out.
class ViscousContact {
 public:
  // Apart and at rest, with the finger touching: depth 0. `rings` is how many are remembered;
  // beyond, a spacing of about 2 / rings of the depth bounds what is resolved.
  explicit ViscousContact(const Relaxation& relaxation, std::size_t rings = 4096);

  // Moves the finger in `time_step` (s, not below 0; 0 is at once, with Kelvin-Voigt's damper left
  // out) straight to `depth` (m; below 0 it is off the undeformed surface). `elastic_force` is
  // phi(depth), N; 0 for depth <= 0. Returns the force at the step's end, N, never negative.
  // A changed time step costs an exponential for each branch; otherwise + - * / and sqrt, at a
  // cost of the rings that the edge passes.
  double step(double time_step, double depth, double elastic_force);

  [[nodiscard]] double force() const { return force_; }  // N, after the last step
  // b, m: the depth at which an elastic contact has the area of this one. 0 without contact.
  [[nodiscard]] double contact_depth() const;
  // m: the depth at which a finger touches, or touches still, in the middle of the contact: the
  // impression that is left after a press. 0 on a surface at rest.
  [[nodiscard]] double surface_depth() const;
  [[nodiscard]] ContactEdge edge() const { return edge_; }

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

  // At the step's end and, `before`, at its begin. `drive` is q_k of a ring that was never free,
  // m: that of any ring in contact differs from it by something that only fades.
  double depth_ = 0.0, depth_before_ = 0.0;  // m
  double rate_ = 0.0;                        // m/s, the step's mean
  std::vector<double> drive_, drive_before_;

  FadingStack pressed_;  // rings in contact, the edge on top: q_k - drive_k, then the force of the
                         // branch k within the ring, N
  FadingStack free_;     // rings beside it, the nearest on top: their sinking by modes, m
  std::vector<double> edge_modes_;  // the edge's ring, were it free, m

  std::vector<double> branches_, outer_branches_, modes_, row_;  // room for one ring

  ContactEdge edge_ = ContactEdge::apart;
  double force_ = 0.0;
};

// The depth of a Hertz contact under a constant force, applied at once, after the time t (s); the
// force presses an elastic tissue to `relaxed_depth` (m) in the end:
//   h^(3/2) = h_inf^(3/2) J(t) E_inf                         Lee and Radok 1960
[[nodiscard]] double depth_under_constant_force(const Creep& creep, double relaxed_depth,
                                                double time);

}  // namespace palpate::contact
