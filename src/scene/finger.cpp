// Makes the finger of a case: spheres, moduli, weight.
#include <numbers>

#include "contact/hertz.h"
#include "geometry/fingertip.h"
#include "scene/scene.h"

namespace palpate::scene {
namespace {

constexpr double gravity = 9.80665;  // m/s^2, standard

// (2 - nu) / G of one body, 1/Pa.                                      docs/theory.md [cattaneo]
double shear_term(const contact::Elastic& body) {
  return (2.0 - body.poisson_ratio) * 2.0 * (1.0 + body.poisson_ratio) / body.young_modulus;
}

}  // namespace

Finger make_finger(const scenario::Resolved& scenario) {
  const scenario::Resolved::Finger& asked = scenario.finger;
  const contact::Elastic tissue{scenario.tissue.young_modulus, scenario.tissue.poisson_ratio};
  const double lambda_1 = asked.elastic ? asked.elastic->compliance() : 0.0;
  const double lambda_2 = tissue.compliance();
  const double modulus = contact::hertz::effective_modulus(lambda_1, lambda_2);

  Finger finger;
  const double volume = 4.0 / 3.0 * std::numbers::pi * asked.radius * asked.radius * asked.radius;
  if (asked.spheres == 1) {
    finger.sphere_radius = asked.radius;
    finger.centres = {Vec3::Zero()};
  } else {
    const finger::Layer layer =
        finger::pack(geometry::fingertip(volume), asked.density, asked.spheres);
    finger.sphere_radius = layer.radius;
    finger.centres = layer.centres;
  }
  const double factor = finger::modulus_factor(asked.calibration, asked.spheres);
  finger.sphere_modulus = modulus * factor;
  finger.force_factor = factor / finger::modulus_factor(finger::Calibration::force, asked.spheres);
  finger.whole = {asked.radius, modulus};
  finger.compliance_share = lambda_1 / (lambda_1 + lambda_2);
  finger.shear_compliance = shear_term(tissue) + (asked.elastic ? shear_term(*asked.elastic) : 0.0);
  // The calibration scales the tangential stiffness of a sphere like its normal force.
  finger.shear_compliance /= factor;
  if (asked.weight == scenario::PlainFinger::Weight::apart)
    finger.weight = asked.density * volume * gravity;
  return finger;
}

}  // namespace palpate::scene
