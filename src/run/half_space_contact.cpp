// One law, the same depth for all.
#include "run/half_space_contact.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"

namespace palpate::run {

std::optional<std::string> press_half_space(const scene::Scene& scene, const Vec3& top,
                                            Touch& touch) {
  const auto shape = *scene::top_curvature(scene.scenario.tissue.shape);
  geometry::Curvature curvature;
  curvature.kappa_1 = shape.kappa_1;
  curvature.kappa_2 = shape.kappa_2;
  curvature.direction_1 = shape.direction_1;
  curvature.direction_2 = Vec3::UnitZ().cross(shape.direction_1);
  const auto law =
      contact::contact_law(scene.scenario.contact.law,
                           {scene.finger.sphere_radius, scene.finger.sphere_modulus}, curvature);
  if (!law)
    return "the tissue is hollow and conforms to the finger (curvature " +
           rounded_text(curvature.kappa_2) + " 1/m): Hertz does not hold there";
  const double radius = scene.finger.sphere_radius;
  const Vec3 before = touch.finger;
  touch.finger = top + (radius - touch.travel) * Vec3::UnitZ();
  const Vec3 move = touch.finger - before;
  std::vector<SphereContact> contacts;
  for (std::size_t i = 0; touch.travel > 0.0 && i < scene.finger.centres.size(); ++i) {
    SphereContact contact;
    if (i < touch.contacts.size()) contact.stretch = touch.contacts[i].stretch;
    contact.sphere = static_cast<int>(i);
    contact.law = *law;
    contact.patch.position = touch.finger + scene.finger.centres[i];
    contact.patch.position.z() = top.z();
    contact.patch.axis = law->axis;
    contact.approach = contact.depth = touch.travel;
    contact.force = law->point.force(contact.depth);
    contact.patch.a = law->a * std::sqrt(contact.depth);
    contact.patch.b = law->b * std::sqrt(contact.depth);
    contacts.push_back(contact);
  }
  touch.contacts = std::move(contacts);
  rub(scene, move, touch);
  return std::nullopt;
}

}  // namespace palpate::run
