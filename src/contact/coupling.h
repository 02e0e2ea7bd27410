// How a Hertz contact sits on a mesh: which part of the mesh's sinking the contact law must know.
#pragma once

#include <optional>
#include <vector>

#include "contact/flat_spread.h"

namespace palpate::contact {

// one_way: h = travel. series: h = travel - u, u the pressure-weighted sinking under the contact.
// consistent: h = travel - v, v the sinking that Hertz's half-space does not know. DESIGN: docs/
// theory.md (9)-(14).
enum class Coupling { one_way, series, consistent };

// For one contact radius: how the contact loads the mesh and how it reads it. The penetration is
//   h = travel - sum_i weights[i] * sinking(nodes[i]) + F * self
// with sinking = downward displacement in m and F the contact force in N.
struct Reading {
  Spread load;
  std::vector<int> nodes;
  std::vector<double> weights;
  double self = 0.0;  // m/N: the half-space's own sinking where the mesh is read
};

// A flat top with a contact centred at one point of it.
class FlatContact {
 public:
  // `plane_modulus` is E' = E / (1 - nu^2) of the mesh's own network, Pa, for `consistent`.
  FlatContact(const geometry::FlatTop& top, std::vector<Vec3> rest_nodes, const Vec3& centre,
              Coupling coupling, double plane_modulus);

  // At the contact radius a, m. Continuous in a.
  [[nodiscard]] Reading at(double contact_radius) const;

 private:
  void read_ring(double contact_radius, Reading& reading) const;

  const geometry::FlatTop* top_;
  std::vector<Vec3> rest_nodes_;
  Vec3 centre_;
  Coupling coupling_;
  double plane_modulus_;
};

// A sphere against a flat: what turns a penetration into a force.
struct SphereLaw {
  double radius = 0.0;   // m, effective
  double modulus = 0.0;  // Pa, E*
};

// The penetration h >= 0 with h + compliance * F(h) = approach, in m; F by Hertz. `compliance`
// (m/N) may be negative, as on a layer that is stiffer than the half-space in it; nothing where
// then no penetration balances.
[[nodiscard]] std::optional<double> penetration(const SphereLaw& law, double approach,
                                                double compliance);

}  // namespace palpate::contact
