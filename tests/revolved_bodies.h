// The bodies of tests/cases/bodies.csv as surface files: discs and domes, with and without a ball.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <sstream>

#include "base/text.h"
#include "record/csv.h"
#include "temporary_folder.h"

namespace palpate::test {

using Profile = std::vector<std::array<double, 2>>;  // radius and height from the apex on, mm

inline void add_line(Profile& profile, std::array<double, 2> from, std::array<double, 2> to,
                     double spacing) {
  const double length = std::hypot(to[0] - from[0], to[1] - from[1]);
  const int parts = std::max(1, static_cast<int>(std::ceil(length / spacing - 1e-9)));
  for (int i = 0; i < parts; ++i) {
    const double t = static_cast<double>(i) / parts;
    profile.push_back({from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])});
  }
}

inline void add_base(Profile& profile, double radius, double spacing) {
  add_line(profile, {radius, 0.0}, {0.0, 0.0}, spacing);
  profile.push_back({0.0, 0.0});
}

inline Profile disc(double radius, double height, double spacing) {
  Profile profile;
  add_line(profile, {0.0, height}, {radius, height}, spacing);
  add_line(profile, {radius, height}, {radius, 0.0}, spacing);
  add_base(profile, radius, spacing);
  return profile;
}

inline Profile dome(double radius, double height, double spacing) {
  Profile profile;
  const int parts = static_cast<int>(std::ceil(0.45 * std::numbers::pi * radius / spacing));
  for (int i = 0; i < parts; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / parts;
    profile.push_back({radius * std::sin(angle), height * std::cos(angle)});
  }
  add_base(profile, radius, spacing);
  return profile;
}

// The surface of a profile that turns about the z axis, as OFF; returns its number of vertices.
inline int write_surface(const Profile& profile, double spacing, const fs::path& path) {
  struct Ring {
    int first = 0, count = 1;
    double offset = 0.0;
    [[nodiscard]] double angle(int i) const {
      return 2.0 * std::numbers::pi * (i + offset) / count;
    }
    [[nodiscard]] int at(int i) const { return first + i % count; }
  };
  std::ostringstream vertices;
  std::ostringstream faces;
  std::vector<Ring> rings;
  int vertex_count = 0;
  for (const auto& [radius, height] : profile) {
    Ring ring{vertex_count, 1, 0.5 * static_cast<double>((rings.size() + 1) % 2)};
    if (radius > 1e-9)
      ring.count =
          std::max(6, static_cast<int>(std::lround(2.0 * std::numbers::pi * radius / spacing)));
    for (int i = 0; i < ring.count; ++i)
      vertices << number_text(radius * std::cos(ring.angle(i))) << " "
               << number_text(radius * std::sin(ring.angle(i))) << " " << number_text(height)
               << "\n";
    vertex_count += ring.count;
    rings.push_back(ring);
  }
  int face_count = 0;
  const auto face = [&](int a, int b, int c) {
    faces << "3 " << a << " " << b << " " << c << "\n";
    ++face_count;
  };
  for (std::size_t k = 0; k + 1 < rings.size(); ++k) {
    const Ring& above = rings[k];
    const Ring& below = rings[k + 1];
    const int left = above.count > 1 ? above.count : 0;
    const int right = below.count > 1 ? below.count : 0;
    for (int i = 0, j = 0; i < left || j < right;) {
      if (j >= right || (i < left && above.angle(i + 1) <= below.angle(j + 1))) {
        face(above.at(i), below.at(j), above.at(i + 1));
        ++i;
      } else {
        face(above.at(i), below.at(j), below.at(j + 1));
        ++j;
      }
    }
  }
  write_file(path, "OFF\n" + std::to_string(vertex_count) + " " + std::to_string(face_count) +
                       " 0\n" + vertices.str() + faces.str());
  return vertex_count;
}

struct Body {
  std::string id;  // of the cases
  std::function<Profile(double)> profile;
  double volume;  // mm^3
  double young_modulus, poisson_ratio;
  double deepest;  // mm: h/R and h/thickness of a tenth
  double most;     // of the band
  std::string region = {};
};

inline void PrintTo(const Body& body, std::ostream* out) { *out << body.id; }

struct Band {
  double travel, low, high;  // mm, mN
};

// From the lower reading of linear elasticity to the higher of the upper and the neo-Hookean one.
inline std::vector<Band> bands(const std::string& id) {
  const record::Table table =
      record::read_csv(std::string(PALPATE_SOURCE_DIR) + "/tests/cases/bodies.csv");
  const auto column = [&](const char* name) { return static_cast<std::size_t>(table.find(name)); };
  std::vector<Band> found;
  for (const auto& row : table.rows) {
    if (std::get<std::string>(row[column("case")]) != id) continue;
    const auto number = [&](const char* name) {
      const double* value = std::get_if<double>(&row[column(name)]);
      return value != nullptr ? *value : 0.0;
    };
    found.push_back({number("travel_mm"), number("force_low_mN"),
                     std::max(number("force_high_mN"), number("force_neo_hookean_mN"))});
  }
  return found;
}

inline double of_disc(double radius, double height) {
  return std::numbers::pi * radius * radius * height;
}

inline std::string ball(const char* young_modulus) {
  return std::string(
             "[[region]]\nkind = \"sphere\"\ncentre = [\"0 mm\", \"0 mm\", \"30 mm\"]\nradius "
             "= \"5 mm\"\nmaterial = \"skin\"\nyoung_modulus = \"") +
         young_modulus + "\"\n";
}

inline std::vector<Body> all_bodies() {
  std::vector<Body> all;
  for (const double nu : {0.33, 0.45}) {
    const std::string end = nu < 0.4 ? "-nu0.33" : "-nu0.45";
    const auto flat = [&](const char* name, double height, double deepest) {
      all.push_back({name + end, [=](double h) { return disc(30.0, height, h); },
                     of_disc(30.0, height), 72.4, nu, deepest, 0.03});
    };
    flat("disc30-5", 5.0, 0.5);
    flat("disc30-10", 10.0, 1.0);
    flat("disc30-20", 20.0, 1.0);
    all.push_back({"dome20-10" + end, [](double h) { return dome(20.0, 10.0, h); },
                   2.0 / 3.0 * of_disc(20.0, 10.0), 72.4, nu, 1.0, 0.03});
    all.push_back({"dome40-25" + end, [](double h) { return dome(40.0, 25.0, h); },
                   2.0 / 3.0 * of_disc(40.0, 25.0), 72.4, nu, 1.0, 0.03});
    for (const bool stiff : {false, true})
      all.push_back({(stiff ? "lump-x20" : "lump-x1") + end,
                     [](double h) { return disc(45.135, 40.0, h); }, of_disc(45.135, 40.0), 20.0,
                     nu, 1.0, 0.05, ball(stiff ? "400 kPa" : "20 kPa")});
  }
  return all;
}

// A press on the body's surface file, whose edges suit a mesh of `nodes` nodes; `mesh` is a line of
// the table `tissue`, or empty for the default mesh.
inline std::string body_press(const Body& body, const fs::path& file, int nodes,
                              const std::string& model, const std::string& mesh) {
  const double spacing = 1.15 * std::cbrt(body.volume / nodes);
  (void)write_surface(body.profile(spacing), spacing, file);
  // A region of independent springs has the ratio of the tissue.
  const std::string region =
      body.region.empty() || model == "mass_spring"
          ? body.region
          : body.region + "poisson_ratio = " + number_text(body.poisson_ratio) + "\n";
  return "[tissue]\nmaterial = \"skin\"\nyoung_modulus = \"" + number_text(body.young_modulus) +
         " kPa\"\npoisson_ratio = " + number_text(body.poisson_ratio) + "\nshape = { file = \"" +
         file.string() + "\", unit = \"mm\" }\n" + mesh + region +
         "[finger]\nmaterial = \"rigid\"\nx = \"0 mm\"\ny = \"0 mm\"\n[solver]\nmodel = \"" +
         model +
         "\"\nintegrator = \"quasi_static\"\n[output]\ninterval = \"250 ms\"\npressure_maps = "
         "false\n[[step]]\nkind = \"indent\"\nto = \"" +
         number_text(body.deepest) + " mm\"\nrate = \"2 mm/s\"\n";
}

// How far a force (mN) is outside the band, as a fraction; negative below it.
inline double outside(double force, const Band& band) {
  return force < band.low    ? force / band.low - 1.0
         : force > band.high ? force / band.high - 1.0
                             : 0.0;
}

}  // namespace palpate::test
