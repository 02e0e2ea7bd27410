// Surfaces written for tests.
#pragma once

#include <sstream>

#include "base/text.h"
#include "geometry/surface.h"
#include "temporary_folder.h"

namespace palpate::test {

// As OFF, in mm.
inline void write_off(const fs::path& path, const geometry::Surface& surface) {
  std::ostringstream text;
  text << "OFF\n" << surface.vertices.size() << " " << surface.triangles.size() << " 0\n";
  for (const Vec3& v : surface.vertices)
    text << number_text(1e3 * v.x()) << " " << number_text(1e3 * v.y()) << " "
         << number_text(1e3 * v.z()) << "\n";
  for (const auto& [a, b, c] : surface.triangles) text << "3 " << a << " " << b << " " << c << "\n";
  write_file(path, text.str());
}

}  // namespace palpate::test
