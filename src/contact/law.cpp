// Computes the contact law from two principal curvatures in one of three ways.
#include "contact/law.h"

#include <cmath>

#include "contact/hertz.h"

namespace palpate::contact {

std::array<double, 2> ContactLaw::semi_axes(double depth) const {
  if (depth <= 0.0) return {0.0, 0.0};
  if (point.layer != nullptr) {
    const double radius = radius_share * point.layer->contact_radius(depth);
    return {radius, radius};
  }
  const double root = std::sqrt(depth);
  return {a * root, b * root};
}

std::optional<ContactLaw> contact_law(CurvatureLaw kind, const SphereLaw& sphere,
                                      const geometry::Curvature& curvature,
                                      const LayerContact* layer) {
  const auto exact = elliptic_law(sphere.radius, curvature.kappa_1, curvature.kappa_2);
  if (!exact) return std::nullopt;
  ContactLaw law;
  law.mean_curvature = 0.5 * (curvature.kappa_1 + curvature.kappa_2);
  law.axis = curvature.direction_2;
  law.nearly_conforming = nearly_conforming(sphere.radius, curvature.kappa_1, curvature.kappa_2);
  double force_radius = exact->force_radius;
  if (kind == CurvatureLaw::elliptic) {
    law.a = std::sqrt(exact->along_radius);
    law.b = law.a * exact->axis_ratio;
  } else {
    force_radius = kind == CurvatureLaw::mean
                       ? mean_radius(sphere.radius, curvature.kappa_1, curvature.kappa_2)
                       : geometric_radius(sphere.radius, curvature.kappa_1, curvature.kappa_2);
    law.a = law.b = std::sqrt(force_radius);
  }
  law.point.layer = layer;
  law.point.coefficient = hertz::force(1.0, force_radius, sphere.modulus);  // of h = 1 m
  return law;
}

}  // namespace palpate::contact
