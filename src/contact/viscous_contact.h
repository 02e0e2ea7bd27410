// A finger on viscoelastic tissue without a mesh: the force for any loading history.
#pragma once

#include <cstddef>
#include <vector>

#include "contact/relaxation.h"
#include "contact/viscous_ring.h"
#include "contact/viscous_stack.h"

namespace palpate::contact {

// Motion of the contact's edge in a step.
enum class ContactEdge {
  apart,      // there is no contact
  growing,    // onto surface that was never touched: loading (Lee and Radok)
  resting,    // the edge did not move
  shrinking,  // unloading (Ting)
  returning,  // onto surface that it had left and that is still recovering
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

  ContactEdge edge_ = ContactEdge::apart;
  double force_ = 0.0;
};

}  // namespace palpate::contact
