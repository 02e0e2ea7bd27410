// Draws maps by supersampling; a pixel at the rim of a contact has its proper share.
#include "run/pressure_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "contact/hertz.h"
#include "contact/layer.h"

namespace palpate::run {
namespace {

inline constexpr int samples = 8;  // along each side of a pixel, of every map

constexpr double outside = std::numeric_limits<double>::infinity();

const geometry::Surface& skin_of(const scene::Scene& scene) {
  return scene.specimen->surface->surface();
}

// Twice the area of a triangle seen from above, m^2; 0 if it faces downwards.
double seen_from_above(const geometry::Surface& outer_surface, std::size_t triangle) {
  return std::max(0.0, geometry::twice_area(outer_surface, static_cast<int>(triangle)).z());
}

// Values of one contact at all vertices of the surface.
struct Nodes {
  std::vector<Vec3> force;   // N, on the tissue, with friction
  std::vector<double> down;  // N, vertical component of the normal force
  std::vector<double> area;  // m^2, the vertex's share, seen from above
  std::vector<double> gap;   // m

  Nodes(const geometry::Surface& outer_surface, const mechanics::SphereContact& contact)
      : force(outer_surface.vertices.size(), Vec3::Zero()),
        down(outer_surface.vertices.size(), 0.0),
        area(outer_surface.vertices.size(), 0.0),
        gap(outer_surface.vertices.size(), outside) {
    for (std::size_t k = 0; k < contact.load.vertices.size(); ++k) {
      const auto vertex = as_index(contact.load.vertices[k]);
      const Vec3 push = contact.force * contact.nodal.push[k];
      force[vertex] = push + contact.load.shares[k] * contact.drag;
      down[vertex] = -push.z();
    }
    for (std::size_t k = 0; k < contact.nodal.vertices.size(); ++k)
      gap[as_index(contact.nodal.vertices[k])] = contact.nodal.gap[k];
    for (std::size_t t = 0; t < outer_surface.triangles.size(); ++t)
      for (const int v : outer_surface.triangles[t])
        area[as_index(v)] += seen_from_above(outer_surface, t) / 6.0;
  }
};

// The samples of a map, each of which belongs to the triangle that takes it first.
class Samples {
 public:
  explicit Samples(const record::PressureMap& map)
      : map_(map), taken_(as_index(map.width * map.height * samples * samples), 0) {}

  // Calls take(pixel, weights) for every free sample that lies in the triangle, seen from above.
  template <class Take>
  void draw(const std::array<Vec3, 3>& corners, Take take) {
    const double step = map_.pitch / samples;
    const double left = map_.origin.x() - 0.5 * map_.pitch + 0.5 * step;  // the first sample
    const double bottom = map_.origin.y() - 0.5 * map_.pitch + 0.5 * step;
    const auto first = [&](double low, double from) {
      return std::max(0, static_cast<int>(std::ceil((low - from) / step - 1e-9)));
    };
    const auto last = [&](double high, double from, int count) {
      return std::min(count * samples - 1,
                      static_cast<int>(std::floor((high - from) / step + 1e-9)));
    };
    const auto [x_low, x_high] = std::minmax({corners[0].x(), corners[1].x(), corners[2].x()});
    const auto [y_low, y_high] = std::minmax({corners[0].y(), corners[1].y(), corners[2].y()});
    const Vec3 b = corners[1] - corners[0];
    const Vec3 c = corners[2] - corners[0];
    const double twice = b.x() * c.y() - b.y() * c.x();
    for (int j = first(y_low, bottom); j <= last(y_high, bottom, map_.height); ++j)
      for (int i = first(x_low, left); i <= last(x_high, left, map_.width); ++i) {
        const double x = left + i * step - corners[0].x();
        const double y = bottom + j * step - corners[0].y();
        const double in_b = (x * c.y() - y * c.x()) / twice;
        const double in_c = (b.x() * y - b.y() * x) / twice;
        if (std::min({in_b, in_c, 1.0 - in_b - in_c}) < -1e-9) continue;
        char& taken = taken_[as_index(j * map_.width * samples + i)];
        if (taken != 0) continue;
        taken = 1;
        take(as_index(j / samples * map_.width + i / samples),
             std::array<double, 3>{1.0 - in_b - in_c, in_b, in_c});
      }
  }

 private:
  const record::PressureMap& map_;
  std::vector<char> taken_;
};

void draw(const geometry::Surface& outer_surface, const mechanics::SphereContact& contact,
          record::PressureMap& map) {
  const Nodes nodes(outer_surface, contact);
  Samples drawn(map);
  std::vector<Vec3> traction_sum(map.pressure.size(), Vec3::Zero());
  std::vector<double> pressure_sum(map.pressure.size(), 0.0);
  for (std::size_t t = 0; t < outer_surface.triangles.size(); ++t) {
    if (seen_from_above(outer_surface, t) <= 0.0) continue;
    std::array<Vec3, 3> corners;
    std::array<Vec3, 3> traction;
    std::array<double, 3> pressure{};
    std::array<double, 3> gap{};
    double widest = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto v = as_index(outer_surface.triangles[t][i]);
      corners[i] = outer_surface.vertices[v];
      traction[i] = nodes.force[v] / nodes.area[v];
      pressure[i] = nodes.down[v] / nodes.area[v];
      gap[i] = nodes.gap[v];
      widest = std::max(widest, gap[i]);
    }
    if (widest == outside) continue;
    drawn.draw(corners, [&](std::size_t pixel, const std::array<double, 3>& weights) {
      float& least = map.gap[pixel];
      double here = 0.0;
      for (std::size_t k = 0; k < 3; ++k) {
        traction_sum[pixel] += weights[k] / (samples * samples) * traction[k];
        pressure_sum[pixel] += weights[k] / (samples * samples) * pressure[k];
        here += weights[k] * gap[k];
      }
      least = std::min(least, static_cast<float>(std::max(0.0, here)));
    });
  }
  for (std::size_t p = 0; p < pressure_sum.size(); ++p) {
    map.pressure[p] += static_cast<float>(pressure_sum[p]);
    map.traction_x[p] += static_cast<float>(traction_sum[p].x());
    map.traction_y[p] += static_cast<float>(traction_sum[p].y());
    map.traction_z[p] += static_cast<float>(traction_sum[p].z());
  }
}

// The largest distance of a contact's pressure from its centre, m; 0 for other couplings.
double nodal_reach(const scene::Scene& scene, const mechanics::SphereContact& contact) {
  double reach = 0.0;
  if (contact.nodal.push.empty()) return reach;
  const auto& surface = *scene.specimen->surface;
  for (const int v : surface.neighbours().rings(contact.load.vertices, 1))
    reach =
        std::max(reach, (surface.surface().vertices[as_index(v)] - contact.patch.position).norm());
  return reach;
}

// Fills a map whose size, pitch and origin are set. Nodal pressure is the force divided by a third
// of the area, seen from above, of the triangles around the node. Pressure, traction and gap are
// linear between nodes; the pressure integrates to Touch::normal_force().
void draw_nodes(const scene::Scene& scene, const mechanics::Touch& touch,
                record::PressureMap& map) {
  const auto pixels = as_index(map.width * map.height);
  map.pressure.assign(pixels, 0.0F);
  map.traction_x = map.traction_y = map.traction_z = map.pressure;
  map.gap.assign(pixels, std::numeric_limits<float>::infinity());
  for (const mechanics::SphereContact& contact : touch.contacts) draw(skin_of(scene), contact, map);
  for (std::size_t p = 0; p < pixels; ++p)
    if (map.pressure[p] > 0.0F) map.gap[p] = 0.0F;
}

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
           const std::optional<contact::LayerSurfaceDisplacement>& layer, double x, double y) {
  double least = std::numeric_limits<double>::infinity();
  double surface_displacement = 0.0;
  for (const View& view : views) {
    const double r = view.arm(x, y).norm();
    const double modulus = scene.finger.sphere_modulus;
    surface_displacement += contact::half_space_surface_displacement(
        r, view.contact->force, view.contact->patch.radius(), modulus);
    if (layer)
      surface_displacement -= view.contact->force * layer->gamma(r / scene.layer->thickness) /
                              (std::numbers::pi * modulus * scene.layer->thickness);
  }
  const double sphere = scene.finger.sphere_radius;
  for (const View& view : views) {
    const double r = view.arm(x, y).norm();
    if (r >= sphere) continue;
    const double own = r * r * (0.5 / sphere + 0.5 * view.contact->law.mean_curvature);
    least = std::min(least, own - view.contact->depth);
  }
  return std::isfinite(least) ? std::max(0.0, least + surface_displacement)
                              : std::numeric_limits<double>::infinity();
}

// How the layer sinks around a contact, as far as the map reaches.
std::optional<contact::LayerSurfaceDisplacement> surface_displacement_of_layer(
    const std::vector<View>& views, const scene::Scene& scene, const record::PressureMap& map) {
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
  return contact::LayerSurfaceDisplacement(layer, farthest / scene.layer->thickness);
}

constexpr int longest = 128;  // pixels of a map
constexpr double margin = 1.25;

record::PressureMap empty_map(const Vec3& finger) {
  record::PressureMap map;
  map.width = map.height = 1;
  map.pitch = 1e-3;
  map.pressure = {0.0F};
  map.traction_x = map.traction_y = map.traction_z = map.gap = map.pressure;
  map.origin = finger;
  return map;
}

// Sets size, pitch and origin of a map over a rectangle, at the height `z` (m).
void lay_out(const Vec3& low, const Vec3& high, double z, record::PressureMap& map) {
  const Vec3 size = high - low;
  map.pitch = std::max(size.x(), size.y()) / longest;
  map.width = std::min(longest, static_cast<int>(std::ceil(size.x() / map.pitch - 1e-9)));
  map.height = std::min(longest, static_cast<int>(std::ceil(size.y() / map.pitch - 1e-9)));
  const Vec3 middle = 0.5 * (low + high);
  map.origin = Vec3(middle.x() - 0.5 * (map.width - 1) * map.pitch,
                    middle.y() - 0.5 * (map.height - 1) * map.pitch, z);
}

}  // namespace

record::PressureMap draw_map(const scene::Scene& scene, const mechanics::Touch& touch) {
  record::PressureMap map;
  map.contact_force = touch.normal_force();
  std::vector<View> views;
  for (const mechanics::SphereContact& contact : touch.contacts)
    if (contact.patch.normal.z() > 0.1) views.emplace_back(contact);
  if (views.empty()) {
    const double force = map.contact_force;
    map = empty_map(touch.finger);
    map.contact_force = force;
    return map;
  }
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 high = -low;
  for (const View& view : views) {
    const contact::Patch& patch = view.contact->patch;
    const Vec3 reach =
        Vec3::Constant(std::max(margin * patch.a, nodal_reach(scene, *view.contact)));
    low = low.cwiseMin(patch.position - reach);
    high = high.cwiseMax(patch.position + reach);
  }
  lay_out(low, high, touch.deepest()->patch.position.z(), map);
  if (!views.front().contact->nodal.push.empty()) {
    draw_nodes(scene, touch, map);
    return map;
  }
  const std::optional<contact::LayerSurfaceDisplacement> layer =
      surface_displacement_of_layer(views, scene, map);
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

record::PressureMap draw_map(const solid::FingerPress::OuterSurface& outer_surface, double reach,
                             double force, const Vec3& finger) {
  record::PressureMap map;
  if (outer_surface.faces.empty() || !(reach > 0.0)) map = empty_map(finger);
  map.contact_force = force;
  if (outer_surface.faces.empty() || !(reach > 0.0)) return map;
  Vec3 low = Vec3::Constant(outside);
  Vec3 high = -low;
  for (const solid::Indenter& indenter : outer_surface.finger) {
    low = low.cwiseMin(indenter.pole - Vec3::Constant(margin * reach));
    high = high.cwiseMax(indenter.pole + Vec3::Constant(margin * reach));
  }
  lay_out(low, high, outer_surface.finger.front().pole.z(), map);
  const auto pixels = as_index(map.width * map.height);
  Samples drawn(map);
  std::vector<double> sums(pixels, 0.0);
  std::vector<Vec3> tractions(pixels, Vec3::Zero());
  map.gap.assign(pixels, std::numeric_limits<float>::infinity());
  // A face is seen as four triangles; the gap is that of the place on the quadratic face. Between
  // the points at which the penalty acts the faces may part from the finger by some ten-thousandths
  // of its radius.
  constexpr double closed = 3e-4;
  constexpr std::array<std::array<double, 3>, 6> nodes{
      {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 0.5, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}}};
  const auto draw_part = [&](std::size_t face, const std::array<std::size_t, 3>& part) {
    const std::array<Vec3, 6>& places = outer_surface.faces[face];
    const std::array<Vec3, 3> triangle{places[part[0]], places[part[1]], places[part[2]]};
    const Vec3 twice = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    if (twice.z() <= 0.0) return;
    drawn.draw(triangle, [&](std::size_t pixel, const std::array<double, 3>& weights) {
      std::array<double, 3> at{};
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t c = 0; c < 3; ++c) at[c] += weights[k] * nodes[part[k]][c];
      const std::array<double, 6> values = solid::face_values(at);
      Vec3 place = Vec3::Zero();
      double lift = 0.0;
      for (std::size_t k = 0; k < 6; ++k) {
        place += values[k] * places[k];
        lift += values[k] * outer_surface.lifts[face][k];
      }
      double open = outside;
      double allowed = 0.0;
      for (const solid::Indenter& indenter : outer_surface.finger) {
        const auto gap = indenter.gap(place);
        if (!gap) continue;
        const double here = indenter.share * *gap - (1.0 - indenter.share) * lift;
        if (here < open) allowed = closed / std::max(indenter.curvature[0], indenter.curvature[1]);
        open = std::min(open, here);
      }
      map.gap[pixel] = std::min(map.gap[pixel], static_cast<float>(std::max(0.0, open)));
      if (open > allowed) return;
      Vec3 traction = Vec3::Zero();
      for (std::size_t k = 0; k < 3; ++k)
        traction += weights[k] * outer_surface.tractions[face][part[k]];
      if (traction.z() >= 0.0) return;
      sums[pixel] -= traction.z();
      tractions[pixel] += traction;
    });
  };
  for (std::size_t face = 0; face < outer_surface.faces.size(); ++face)
    for (const auto& part : solid::face_parts) draw_part(face, part);
  double integral = 0.0;
  for (const double sum : sums) integral += sum * map.pitch * map.pitch;
  const double scale = integral > 0.0 ? force / integral : 0.0;
  for (std::size_t p = 0; p < pixels; ++p) {
    map.pressure.push_back(static_cast<float>(scale * sums[p]));
    map.traction_x.push_back(static_cast<float>(scale * tractions[p].x()));
    map.traction_y.push_back(static_cast<float>(scale * tractions[p].y()));
    map.traction_z.push_back(static_cast<float>(scale * tractions[p].z()));
    if (sums[p] > 0.0) map.gap[p] = 0.0F;
  }
  return map;
}

}  // namespace palpate::run
