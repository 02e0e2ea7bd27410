// Draws triangles by supersampling; a sample belongs to the first triangle that contains it.
#include "run/nodal_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::run {
namespace {

constexpr double outside = std::numeric_limits<double>::infinity();

const geometry::Surface& skin_of(const scene::Scene& scene) {
  return scene.specimen->surface->surface();
}

// Twice the area of a triangle seen from above, m^2; 0 if it faces downwards.
double seen_from_above(const geometry::Surface& skin, std::size_t triangle) {
  return std::max(0.0, geometry::twice_area(skin, static_cast<int>(triangle)).z());
}

// Values of one contact at all vertices of the skin.
struct Nodes {
  std::vector<Vec3> force;   // N, on the tissue, with friction
  std::vector<double> down;  // N, vertical component of the normal force
  std::vector<double> area;  // m^2, the vertex's share, seen from above
  std::vector<double> gap;   // m

  Nodes(const geometry::Surface& skin, const mechanics::SphereContact& contact)
      : force(skin.vertices.size(), Vec3::Zero()),
        down(skin.vertices.size(), 0.0),
        area(skin.vertices.size(), 0.0),
        gap(skin.vertices.size(), outside) {
    for (std::size_t k = 0; k < contact.load.vertices.size(); ++k) {
      const auto vertex = as_index(contact.load.vertices[k]);
      const Vec3 push = contact.force * contact.nodal.push[k];
      force[vertex] = push + contact.load.shares[k] * contact.drag;
      down[vertex] = -push.z();
    }
    for (std::size_t k = 0; k < contact.nodal.vertices.size(); ++k)
      gap[as_index(contact.nodal.vertices[k])] = contact.nodal.gap[k];
    for (std::size_t t = 0; t < skin.triangles.size(); ++t)
      for (const int v : skin.triangles[t]) area[as_index(v)] += seen_from_above(skin, t) / 6.0;
  }
};

// Calls take(column, row, weights) for every sample of the map that lies in the triangle.
template <class Take>
void raster(const std::array<Vec3, 3>& corners, const record::PressureMap& map, Take take) {
  const double step = map.pitch / samples;
  const double left = map.origin.x() - 0.5 * map.pitch + 0.5 * step;  // the first sample
  const double bottom = map.origin.y() - 0.5 * map.pitch + 0.5 * step;
  const auto first = [&](double low, double from) {
    return std::max(0, static_cast<int>(std::ceil((low - from) / step - 1e-9)));
  };
  const auto last = [&](double high, double from, int count) {
    return std::min(count * samples - 1, static_cast<int>(std::floor((high - from) / step + 1e-9)));
  };
  const auto [x_low, x_high] = std::minmax({corners[0].x(), corners[1].x(), corners[2].x()});
  const auto [y_low, y_high] = std::minmax({corners[0].y(), corners[1].y(), corners[2].y()});
  const Vec3 b = corners[1] - corners[0];
  const Vec3 c = corners[2] - corners[0];
  const double twice = b.x() * c.y() - b.y() * c.x();
  for (int j = first(y_low, bottom); j <= last(y_high, bottom, map.height); ++j)
    for (int i = first(x_low, left); i <= last(x_high, left, map.width); ++i) {
      const double x = left + i * step - corners[0].x();
      const double y = bottom + j * step - corners[0].y();
      const double in_b = (x * c.y() - y * c.x()) / twice;
      const double in_c = (b.x() * y - b.y() * x) / twice;
      if (std::min({in_b, in_c, 1.0 - in_b - in_c}) >= -1e-9)
        take(i, j, std::array<double, 3>{1.0 - in_b - in_c, in_b, in_c});
    }
}

void draw(const geometry::Surface& skin, const mechanics::SphereContact& contact,
          record::PressureMap& map) {
  const Nodes nodes(skin, contact);
  const int across = map.width * samples;
  std::vector<char> taken(as_index(across * map.height * samples), 0);
  std::vector<Vec3> traction_sum(map.pressure.size(), Vec3::Zero());
  std::vector<double> pressure_sum(map.pressure.size(), 0.0);
  for (std::size_t t = 0; t < skin.triangles.size(); ++t) {
    if (seen_from_above(skin, t) <= 0.0) continue;
    std::array<Vec3, 3> corners;
    std::array<Vec3, 3> traction;
    std::array<double, 3> pressure{};
    std::array<double, 3> gap{};
    double widest = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto v = as_index(skin.triangles[t][i]);
      corners[i] = skin.vertices[v];
      traction[i] = nodes.force[v] / nodes.area[v];
      pressure[i] = nodes.down[v] / nodes.area[v];
      gap[i] = nodes.gap[v];
      widest = std::max(widest, gap[i]);
    }
    if (widest == outside) continue;
    raster(corners, map, [&](int i, int j, const std::array<double, 3>& weights) {
      char& mark = taken[as_index(j * across + i)];
      if (mark != 0) return;
      mark = 1;
      const auto pixel = as_index(j / samples * map.width + i / samples);
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

}  // namespace

double nodal_reach(const scene::Scene& scene, const mechanics::SphereContact& contact) {
  double reach = 0.0;
  if (contact.nodal.push.empty()) return reach;
  const auto& surface = *scene.specimen->surface;
  for (const int v : surface.neighbours().rings(contact.load.vertices, 1))
    reach =
        std::max(reach, (surface.surface().vertices[as_index(v)] - contact.patch.position).norm());
  return reach;
}

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

}  // namespace palpate::run
