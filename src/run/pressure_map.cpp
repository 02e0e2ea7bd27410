// Draws maps by supersampling; a pixel at the rim of a contact has its proper share.
#include "run/pressure_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "contact/half_space.h"
#include "contact/layer_sinking.h"
#include "run/nodal_map.h"

namespace palpate::run {
namespace {

// A contact's patch seen from above.
struct View {
  const mechanics::SphereContact* contact;
  Vec3 across;
  double mean;                                    // Pa, over the ellipse
  std::optional<contact::PressureProfile> shape;  // on a layer; empty: Hertz's

  explicit View(const mechanics::SphereContact& one)
      : contact(&one),
        across(one.patch.normal.cross(one.patch.axis)),
        mean(one.force / (std::numbers::pi * one.patch.a * one.patch.b)) {
    const contact::LayerContact* layer = one.law.point.layer;
    if (layer != nullptr)
      shape = layer->law.pressure(contact::layer_chi(one.depth, layer->radius, layer->thickness));
  }

  // Vector from the patch's centre to the vertical through (x, y), in the tangent plane, m.
  [[nodiscard]] Vec3 arm(double x, double y) const {
    const contact::Patch& patch = contact->patch;
    Vec3 away(x - patch.position.x(), y - patch.position.y(), 0.0);
    away.z() = -(away.x() * patch.normal.x() + away.y() * patch.normal.y()) / patch.normal.z();
    return away;
  }
  // 1 at the patch's centre, 0 at its rim, a quadratic function.
  [[nodiscard]] double inside(double x, double y) const {
    const Vec3 away = arm(x, y);
    const double u = away.dot(contact->patch.axis) / contact->patch.a;
    const double v = away.dot(across) / contact->patch.b;
    return 1.0 - u * u - v * v;
  }
  [[nodiscard]] double pressure(double x, double y) const {
    const double z = inside(x, y);
    if (z <= 0.0) return 0.0;
    return mean * (shape ? shape->at(std::sqrt(1.0 - z)) : 1.5 * std::sqrt(z));
  }
  // The mean over a pixel around (x, y), Pa: 0 far outside the rim, by two Gauss points a side far
  // inside, where they are right to 1e-6, and by supersampling in between.
  [[nodiscard]] double mean_pressure(double x, double y, double pitch) const {
    double least = std::numeric_limits<double>::infinity();
    double most = -least;
    for (const double i : {-0.5, 0.5})
      for (const double j : {-0.5, 0.5}) {
        const double corner = inside(x + j * pitch, y + i * pitch);
        least = std::min(least, corner);
        most = std::max(most, corner);
      }
    const contact::Patch& patch = contact->patch;
    const double side = pitch / patch.normal.z() / std::min(patch.a, patch.b);
    // In the square it is higher than at its corners by at most this.
    if (most + 0.5 * side * side < 0.0) return 0.0;
    const bool smooth = least > 10.0 * side;
    const int count = smooth ? 2 : samples;
    const double reach = smooth ? std::sqrt(1.0 / 3.0) : 1.0 - 1.0 / samples;  // of half a pixel
    double sum = 0.0;
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j)
        sum += pressure(x + 0.5 * pitch * reach * (2.0 * j / (count - 1) - 1.0),
                        y + 0.5 * pitch * reach * (2.0 * i / (count - 1) - 1.0));
    return sum / (count * count);
  }
};

// The vertical gap between finger and tissue, m: the parabolic height of the spheres above the
// curved tissue, minus the depth, plus the displacement of the half-space or layer; 0 in contact.
double gap(const std::vector<View>& views, const scene::Scene& scene,
           const std::optional<contact::LayerSinking>& layer, double x, double y) {
  double least = std::numeric_limits<double>::infinity();
  double sinking = 0.0;
  for (const View& view : views) {
    const double r = view.arm(x, y).norm();
    const double modulus = scene.finger.sphere_modulus;
    sinking +=
        contact::half_space_sinking(r, view.contact->force, view.contact->patch.radius(), modulus);
    if (layer)
      sinking -= view.contact->force * layer->gamma(r / scene.layer->thickness) /
                 (std::numbers::pi * modulus * scene.layer->thickness);
  }
  const double sphere = scene.finger.sphere_radius;
  for (const View& view : views) {
    const double r = view.arm(x, y).norm();
    if (r >= sphere) continue;
    const double own = r * r * (0.5 / sphere + 0.5 * view.contact->law.mean_curvature);
    least = std::min(least, own - view.contact->depth);
  }
  return std::isfinite(least) ? std::max(0.0, least + sinking)
                              : std::numeric_limits<double>::infinity();
}

// How the layer sinks around a contact, as far as the map reaches.
std::optional<contact::LayerSinking> sinking_of_layer(const std::vector<View>& views,
                                                      const scene::Scene& scene,
                                                      const record::PressureMap& map) {
  if (!scene.layer) return {};
  double farthest = 0.0;  // m; at a corner
  for (const View& view : views)
    for (const int row : {0, map.height - 1})
      for (const int column : {0, map.width - 1}) {
        const double x = map.origin.x() + column * map.pitch;
        const double y = map.origin.y() + row * map.pitch;
        farthest = std::max(farthest, view.arm(x, y).norm());
      }
  const contact::Layer layer =
      scene::layers_of(scene.scenario, 1.0 - scene.finger.compliance_share);
  return contact::LayerSinking(layer, farthest / scene.layer->thickness);
}

}  // namespace

record::PressureMap draw_map(const scene::Scene& scene, const mechanics::Touch& touch) {
  record::PressureMap map;
  map.contact_force = touch.normal_force();
  std::vector<View> views;
  for (const mechanics::SphereContact& contact : touch.contacts)
    if (contact.patch.normal.z() > 0.1) views.emplace_back(contact);
  if (views.empty()) {
    map.width = map.height = 1;
    map.pitch = 1e-3;
    map.pressure = {0.0F};
    map.traction_x = map.traction_y = map.traction_z = map.gap = map.pressure;
    map.origin = touch.finger;
    return map;
  }
  constexpr int longest = 128;  // pixels
  constexpr double margin = 1.25;
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = -low;
  for (const View& view : views) {
    const contact::Patch& patch = view.contact->patch;
    const Vec3 reach =
        Vec3::Constant(std::max(margin * patch.a, nodal_reach(scene, *view.contact)));
    low = low.cwiseMin(patch.position - reach);
    high = high.cwiseMax(patch.position + reach);
  }
  const Vec3 size = high - low;
  map.pitch = std::max(size.x(), size.y()) / longest;
  map.width = std::min(longest, static_cast<int>(std::ceil(size.x() / map.pitch - 1e-9)));
  map.height = std::min(longest, static_cast<int>(std::ceil(size.y() / map.pitch - 1e-9)));
  const Vec3 middle = 0.5 * (low + high);
  map.origin =
      Vec3(middle.x() - 0.5 * (map.width - 1) * map.pitch,
           middle.y() - 0.5 * (map.height - 1) * map.pitch, touch.deepest()->patch.position.z());
  if (!views.front().contact->nodal.push.empty()) {
    draw_nodes(scene, touch, map);
    return map;
  }
  const std::optional<contact::LayerSinking> layer = sinking_of_layer(views, scene, map);
  for (int row = 0; row < map.height; ++row) {
    for (int column = 0; column < map.width; ++column) {
      const double x = map.origin.x() + column * map.pitch;
      const double y = map.origin.y() + row * map.pitch;
      double pressure = 0.0;
      Vec3 traction = Vec3::Zero();
      for (const View& view : views) {
        const double sum = view.mean_pressure(x, y, map.pitch);
        pressure += sum;
        const mechanics::SphereContact& contact = *view.contact;
        // Per area seen from above, so that its integral is the force on a slope too.
        traction +=
            sum / contact.patch.normal.z() * (contact.drag / contact.force - contact.patch.normal);
      }
      map.pressure.push_back(static_cast<float>(pressure));
      map.traction_x.push_back(static_cast<float>(traction.x()));
      map.traction_y.push_back(static_cast<float>(traction.y()));
      map.traction_z.push_back(static_cast<float>(traction.z()));
      map.gap.push_back(pressure > 0.0 ? 0.0F : static_cast<float>(gap(views, scene, layer, x, y)));
    }
  }
  return map;
}

}  // namespace palpate::run
