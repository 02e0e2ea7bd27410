// Sums over the contacts of a touch, and their friction.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "contact/friction.h"
#include "mechanics/body_surface_displacement.h"
#include "mechanics/contacts.h"

namespace palpate::mechanics {
namespace {

// The error that is stated after the correction s + e: half of e, and more where e is not small.
// Measured on the bodies of docs/accuracy.md.                docs/theory.md [compliance]
constexpr double stated_share = 0.5;

// What a mesh leaves open even where e is zero: the curvature read from its surface, the quadrature
// of the loads and the interpolation over contact radii.
constexpr double stated_least = 1e-3;

// A group of spheres that represents one shears like it, under the friction of all, which is shared
// like their normal forces.
void find_shear(const scene::Scene& scene, const Touch& touch, BodySurfaceDisplacement& beyond,
                SphereContact& contact) {
  contact::Patch patch = contact.patch;
  double share = 1.0;
  if (presses_as_one(scene) && contact.force > 0.0) {
    const double wider = std::pow(static_cast<double>(scene.finger.centres.size()), 1.0 / 6.0);
    patch.a *= wider;
    patch.b *= wider;
    share = contact.force / touch.pressed();
  }
  contact.shear = beyond.shear(patch) / share;
}

}  // namespace

bool presses_as_one(const scene::Scene& scene) {
  return scene.finger.centres.size() > 1 &&
         scene.scenario.finger.calibration == finger::Calibration::force;
}

void share_layer(const scene::Scene& scene, contact::ContactLaw& law) {
  if (law.point.layer == nullptr || !presses_as_one(scene)) return;
  // The law of one sphere of radius R = n^(1/3) times that of each; a^2 = R h.
  const auto count = static_cast<double>(scene.finger.centres.size());
  law.point.share = 1.0 / count;
  law.radius_share = std::pow(count, -1.0 / 6.0);
}

void NodalContact::renew() {
  push.clear();
  peak_pressure = 0.0;
  vertices.clear();
  gap.clear();
}

void SphereContact::renew() {
  SphereContact other;
  for (auto [kept, own] : {std::pair{&other.load, &load}, std::pair{&other.wide, &wide}}) {
    kept->vertices.swap(own->vertices);
    kept->shares.swap(own->shares);
    kept->vertices.clear();
    kept->shares.clear();
  }
  std::swap(other.nodal, nodal);
  other.nodal.renew();
  *this = std::move(other);
}

double peak_pressure(const SphereContact& contact) {
  if (contact.force <= 0.0) return 0.0;
  if (!contact.nodal.push.empty()) return contact.nodal.peak_pressure;
  const double mean = contact.force / (std::numbers::pi * contact.patch.a * contact.patch.b);
  const contact::LayerContact* layer = contact.law.point.layer;
  if (layer == nullptr) return 1.5 * mean;
  return mean *
         layer->law.pressure(contact::layer_chi(contact.depth, layer->radius, layer->thickness))
             .at(0.0);
}

double mesh_error(const SphereContact& contact) {
  const double stiffness = contact.law.point.stiffness(contact.depth);
  const double share = stiffness / (1.0 + std::max(0.0, contact.compliance * stiffness));
  const double estimated = contact.surface_displacement_error * share;
  return stated_least + estimated * (stated_share + estimated) +
         contact.surface_displacement_doubt * share;
}

const SphereContact* Touch::deepest() const {
  const auto found = std::ranges::max_element(contacts, {}, &SphereContact::depth);
  return found == contacts.end() ? nullptr : &*found;
}

double Touch::normal_force() const {
  double sum = 0.0;
  for (const SphereContact& contact : contacts) sum += contact.force * contact.patch.normal.z();
  return sum;
}

double Touch::force() const { return normal_force() - drag().z(); }

Vec3 Touch::drag() const {
  Vec3 sum = Vec3::Zero();
  for (const SphereContact& contact : contacts) sum += contact.drag;
  return sum;
}

double Touch::pressed() const {
  double sum = 0.0;
  for (const SphereContact& contact : contacts) sum += contact.force;
  return sum;
}

void rub(const scene::Scene& scene, const Vec3& move, Touch& touch,
         BodySurfaceDisplacement* beyond) {
  const double friction = scene.scenario.contact.friction;
  const bool at_once = scene.scenario.contact.slip == scenario::Contact::Slip::coulomb;
  for (SphereContact& contact : touch.contacts) {
    const Vec3& normal = contact.patch.normal;
    if (at_once) {
      // mu F along the motion; eq. (4) does not define it at rest.
      const Vec3 slip = move - move.dot(normal) * normal;
      const double length = slip.norm();
      const double limit = friction * contact.force;
      contact.drag = length > 0.0 ? Vec3(limit / length * slip) : Vec3::Zero();
      continue;
    }
    if (beyond != nullptr) find_shear(scene, touch, *beyond, contact);
    contact.stretch += move;
    contact.stretch -= contact.stretch.dot(normal) * normal;
    contact.drag =
        contact::friction::drag(contact.stretch, friction * contact.force, contact.patch.radius(),
                                scene.finger.shear_compliance, contact.shear);
  }
}

}  // namespace palpate::mechanics
