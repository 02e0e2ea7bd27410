// One contact law, with the same depth for all spheres.
#include "mechanics/half_space_contact.h"

#include <cmath>

#include "base/text.h"
#include "base/units.h"

namespace palpate::mechanics {

std::optional<std::string> press_half_space(const scene::Scene& scene, const Vec3& top,
                                            Touch& touch) {
  const scene::SurfaceTouch& surface = scene.choice.touch;
  const geometry::Curvature& curvature = surface.curvature;
  auto law = contact::contact_law(scene.scenario.contact.law,
                                  {scene.finger.sphere_radius, scene.finger.sphere_modulus},
                                  curvature, scene.layer ? &*scene.layer : nullptr);
  if (!law) return hollow_text(curvature.kappa_2);
  const double radius = scene.finger.sphere_radius;
  const auto [depth, normal] = surface.pressed(radius, touch.travel);
  if (depth > law->point.last_depth())
    return "the layer is too thin for this depth: its law is known up to " +
           rounded_text(unit::mm.from_si(law->point.last_depth()), 3) +
           " mm; press less deep, or set `solver.model = \"coupled_springs\"`";
  share_layer(scene, *law);
  if (scene.depth_ratio) law->point.part = scene.depth_ratio->value(depth);
  const Vec3 before = touch.finger;
  touch.finger = top + (radius - touch.travel) * Vec3::UnitZ();
  const Vec3 move = touch.finger - before;
  // resize() reuses memory: a step in a live run allocates nothing.
  const bool touches = depth > 0.0;
  touch.contacts.resize(touches ? scene.finger.centres.size() : 0);
  for (std::size_t i = 0; i < touch.contacts.size(); ++i) {
    SphereContact& contact = touch.contacts[i];
    contact.sphere = static_cast<int>(i);
    contact.law = *law;
    contact.patch.position = touch.finger + scene.finger.centres[i];
    contact.patch.position.z() = top.z();
    contact.patch.normal = normal;
    contact.patch.axis = law->axis;
    if (surface.tilted()) {  // one sphere
      contact.patch.position = touch.finger - (radius - depth) * normal;
      contact.patch.axis = (law->axis - law->axis.dot(normal) * normal).normalized();
    }
    contact.one_sided = surface.one_sided;
    contact.approach = contact.depth = depth;
    contact.force = law->point.force(contact.depth);
    const auto [a, b] = law->semi_axes(contact.depth);
    contact.patch.a = a;
    contact.patch.b = b;
  }
  rub(scene, move, touch);
  return std::nullopt;
}

}  // namespace palpate::mechanics
