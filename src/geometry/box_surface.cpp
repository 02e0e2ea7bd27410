// Builds the six sides of a box; points on common edges and corners are numbered only once.
#include "geometry/box_surface.h"

#include <map>

namespace palpate::geometry {

Surface box_surface(const Vec3& size, const std::array<int, 3>& cells) {
  Surface surface;
  std::map<std::array<int, 3>, int> numbers;  // of the structured mesh points in use
  const auto number = [&](const std::array<int, 3>& at) {
    const auto [entry, fresh] = numbers.try_emplace(at, static_cast<int>(surface.vertices.size()));
    if (fresh)
      surface.vertices.emplace_back(size.x() * (static_cast<double>(at[0]) / cells[0]),
                                    size.y() * (static_cast<double>(at[1]) / cells[1]),
                                    size.z() * (static_cast<double>(at[2]) / cells[2]));
    return entry->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const bool far : {false, true}) {
      // (u, v, axis) is right-handed: u, then v is counter-clockwise seen from the far side.
      const std::size_t u = (axis + 1) % 3;
      const std::size_t v = (axis + 2) % 3;
      for (int i = 0; i < cells[u]; ++i)
        for (int j = 0; j < cells[v]; ++j) {
          std::array<int, 4> ring{};  // the square's corners, counter-clockwise from outside
          for (std::size_t c = 0; c < 4; ++c) {
            std::array<int, 3> at{};
            at[axis] = far ? cells[axis] : 0;
            at[u] = i + (c == 1 || c == 2 ? 1 : 0);
            at[v] = j + (c >= 2 ? 1 : 0);
            ring[far ? c : 3 - c] = number(at);
          }
          const std::size_t start = as_index(i + j) % 2;
          const auto corner = [&](std::size_t c) { return ring[(start + c) % 4]; };
          surface.triangles.push_back({corner(0), corner(1), corner(2)});
          surface.triangles.push_back({corner(0), corner(2), corner(3)});
        }
    }
  return surface;
}

}  // namespace palpate::geometry
