// One static contact at the deepest travel.
#include "run/mesh_error.h"

#include "mechanics/pressed_mesh.h"
#include "scene/first_touch.h"

namespace palpate::run {

std::optional<double> mesh_error(const scene::Scene& scene) {
  if (!scene.specimen || scene.scenario.uniform() ||
      scene.scenario.contact.coupling != contact::Coupling::consistent)
    return std::nullopt;
  mechanics::PressedMesh mesh(scene);
  mechanics::Touch touch;
  touch.finger = scene::first_touch(scene).finger;
  const double deepest = scene::deepest_travel(scene.scenario, scene.law());
  if (mesh.try_out(touch.finger - deepest * Vec3::UnitZ(), touch)) return std::nullopt;
  const mechanics::SphereContact* contact = touch.deepest();
  if (contact == nullptr) return std::nullopt;
  return mechanics::mesh_error(*contact);
}

}  // namespace palpate::run
