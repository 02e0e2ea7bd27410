// The three couplings on a flat top, and the scalar equation that closes them.
#include "contact/coupling.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "contact/hertz.h"

namespace palpate::contact {
namespace {

double distance(const Vec3& a, const Vec3& b) {
  const double x = a.x() - b.x();
  const double y = a.y() - b.y();
  return std::sqrt(x * x + y * y);
}

// How much a node is believed: most at one spacing beyond the patch, half at a half and at one
// and a half, next to nothing far off. Smooth, so that no node enters or leaves with a jump, and
// never zero, so that a coarse mesh reads the nearest nodes it has.
double ring_weight(double beyond_patch, double spacing) {
  const double x = (beyond_patch - spacing) / (0.5 * spacing);
  const double quarter = 1.0 + 0.1892071150027210667 * x * x;  // (1/2)^(1/4) at x = 1
  return 1.0 / (quarter * quarter * quarter * quarter);
}

// A node that carries load itself sinks as the mesh likes: it is read less, the more it carries.
double unloaded(double share) {
  constexpr double full = 0.01;  // of the force; from here on the node is not read at all
  const double left = std::max(0.0, 1.0 - share / full);
  return left * left;
}

}  // namespace

FlatContact::FlatContact(const geometry::FlatTop& top, std::vector<Vec3> rest_nodes,
                         const Vec3& centre, Coupling coupling, double plane_modulus)
    : top_(&top),
      rest_nodes_(std::move(rest_nodes)),
      centre_(centre),
      coupling_(coupling),
      plane_modulus_(plane_modulus) {}

Reading FlatContact::at(double contact_radius) const {
  Reading reading;
  reading.load = spread_over_flat(*top_, centre_, contact_radius);
  if (coupling_ == Coupling::series) {
    reading.nodes = reading.load.nodes;
    reading.weights = reading.load.shares;
  } else if (coupling_ == Coupling::consistent) {
    read_ring(contact_radius, reading);
  }
  return reading;
}

// Least squares of c0 + c1 r^2 through (mesh sinking - half-space sinking) on the ring; the value
// at the centre, c0, is linear in the sinkings: c0 = sum_i weights[i] sinking_i.
void FlatContact::read_ring(double contact_radius, Reading& reading) const {
  const double spacing = top_->mean_spacing();
  const auto at = [this](int node) -> const Vec3& {
    return rest_nodes_[static_cast<std::size_t>(node)];
  };
  struct Candidate {
    int node;
    double r2, weight;
  };
  std::vector<Candidate> ring;
  double best = 0.0;
  std::size_t next = 0;  // both node lists ascend
  for (const int node : top_->nodes()) {
    while (next < reading.load.nodes.size() && reading.load.nodes[next] < node) ++next;
    const bool loaded = next < reading.load.nodes.size() && reading.load.nodes[next] == node;
    const double r = distance(at(node), centre_);
    const double weight = ring_weight(r - contact_radius, spacing) *
                          unloaded(loaded ? reading.load.shares[next] : 0.0);
    if (weight <= 0.0) continue;
    ring.push_back({node, r * r, weight});
    best = std::max(best, weight);
  }
  // Far nodes are dropped below a fiftieth of the best weight, which is taken off all the others
  // so that dropping makes no jump.
  double s0 = 0.0;
  double s1 = 0.0;
  double s2 = 0.0;
  std::vector<Candidate> kept;
  for (Candidate candidate : ring) {
    candidate.weight = candidate.weight / best - 0.02;
    if (candidate.weight <= 0.0) continue;
    s0 += candidate.weight;
    s1 += candidate.weight * candidate.r2;
    s2 += candidate.weight * candidate.r2 * candidate.r2;
    kept.push_back(candidate);
  }
  // Where all nodes stand at one distance the slope cannot be told: a small ridge keeps it at 0.
  const double mean_r2 = s1 / s0;
  const double ridge = 1e-3 * s0 * mean_r2 * mean_r2;
  const double determinant = s0 * (s2 + ridge) - s1 * s1;
  for (const Candidate& candidate : kept) {
    const double weight = candidate.weight * ((s2 + ridge) - s1 * candidate.r2) / determinant;
    // u_hs(x) = sum_j F w_j / (pi E' |x - x_j|)            docs/theory.md (11)
    double half_space = 0.0;
    for (std::size_t j = 0; j < reading.load.nodes.size(); ++j) {
      const double r = distance(at(candidate.node), at(reading.load.nodes[j]));
      // A node reads its own small share as if it were spread over a disk of half a spacing.
      half_space += reading.load.shares[j] / std::max(r, 0.25 * spacing);
    }
    reading.nodes.push_back(candidate.node);
    reading.weights.push_back(weight);
    reading.self += weight * half_space / (std::numbers::pi * plane_modulus_);
  }
}

std::optional<double> penetration(const SphereLaw& law, double approach, double compliance) {
  if (approach <= 0.0) return 0.0;
  const auto excess = [&](double h) {
    return h + compliance * hertz::force(h, law.radius, law.modulus) - approach;
  };
  double low = 0.0;
  double high = approach;
  if (compliance < 0.0) {
    // h + C F(h) grows until its slope 1 + C dF/dh is zero, at sqrt(R h) = -1 / (2 C E*).
    const double radius = -0.5 / (compliance * law.modulus);
    high = radius * radius / law.radius;
    if (excess(high) < 0.0) return std::nullopt;
  }
  // Newton within a bracket: the function rises all the way, so it cannot miss.
  double h = std::min(approach, high);
  for (int i = 0; i < 100; ++i) {
    const double value = excess(h);
    if (value == 0.0) return h;
    (value > 0.0 ? high : low) = h;
    const double slope = 1.0 + compliance * hertz::stiffness(h, law.radius, law.modulus);
    double next = h - value / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - h) <= 1e-15 * h) return next;
    h = next;
  }
  return h;
}

}  // namespace palpate::contact
