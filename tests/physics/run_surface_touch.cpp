// `hertz` on a surface file against a mesh of the same file, on the top and where it is inclined.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "base/text.h"
#include "geometry/shapes.h"
#include "run_text.h"
#include "surface_file.h"

namespace palpate::run {
namespace {

// Half axes of 400, 300 and 360 mm: the whole body's compression is small.
const geometry::Ellipsoid body{{0.8, 0.6, 0.72}};

void write_body(const test::fs::path& path) {
  test::write_off(path, geometry::sampled(body, {20e-3, 20e-3}).parts.front().surface);
}

record::CaseRecord pressed(const std::string& shape, const std::string& x,
                           const std::string& model) {
  return test::run_text(
      "[tissue]\nmaterial = \"skin\"\nviscosity = \"none\"\nshape = " + shape +
      "\nmesh = { kind = \"tetgen\", nodes = 1000 }\n[finger]\nx = \"" + x +
      "\"\ny = \"340 mm\"\n[output]\npressure_maps = false\n[solver]\nmodel = \"" + model + "\"\n" +
      (model == "hertz" ? "" : "integrator = \"quasi_static\"\n") +
      "[[step]]\nkind = \"indent\"\nto = \"2 mm\"\nrate = \"5 mm/s\"\n");
}

// Newtons per mm^(3/2): it contains both curvatures and the normal, but not the compression of the
// whole body, which only the mesh has.
double stiffness(const record::CaseRecord& record) {
  const auto& row = record.contact.back();
  return row.contact_force / std::pow(1e3 * row.indentation, 1.5);
}

TEST(SurfaceFile, HasTheSameContactWithoutAMesh) {
  const test::TemporaryFolder folder;
  write_body(folder.path() / "body.off");
  const std::string file =
      "{ file = \"" + (folder.path() / "body.off").string() + "\", unit = \"mm\" }";
  for (const char* x : {"400 mm", "660 mm"}) {
    const record::CaseRecord hertz = pressed(file, x, "hertz");
    const record::CaseRecord mesh = pressed(file, x, "coupled_springs");
    ASSERT_EQ(hertz.outcome, record::Outcome::completed) << hertz.reason;
    ASSERT_EQ(mesh.outcome, record::Outcome::completed) << mesh.reason;
    // The mesh has its curvature from cells of 60 mm, of 1 % each, in 1/R + kappa with 1/R = 91/m.
    EXPECT_NEAR(stiffness(hertz) / stiffness(mesh), 1.0, 0.005) << x;
    // What the sentence of `explain` promises.
    const double stated = std::get<double>(test::finding(hertz, "predicted_error")) +
                          std::get<double>(test::finding(mesh, "predicted_error"));
    EXPECT_NEAR(hertz.contact.back().contact_force / mesh.contact.back().contact_force, 1.0, stated)
        << x;
    // The finger goes down vertically, and the indentation is along the normal.
    const double cosine = hertz.contact.back().indentation / hertz.contact.back().travel;
    EXPECT_LT(cosine, x[0] == '4' ? 1.0 : 0.95);
  }
}

TEST(SurfaceFile, HasTheForceOfItsShape) {
  const test::TemporaryFolder folder;
  write_body(folder.path() / "body.off");
  const std::string file =
      "{ file = \"" + (folder.path() / "body.off").string() + "\", unit = \"mm\" }";
  for (const char* x : {"400 mm", "660 mm"}) {
    const double of_file = pressed(file, x, "hertz").contact.back().contact_force;
    const double of_shape =
        pressed("{ kind = \"ellipsoid\", size = [\"800 mm\", \"600 mm\", \"720 mm\"] }", x, "hertz")
            .contact.back()
            .contact_force;
    EXPECT_NEAR(of_file / of_shape, 1.0, 0.002) << x;  // a per cent of the curvature, in 91/m
  }
}

// One body in six positions, and pressed against its base and from the side, is one body: a file
// whose axes are exchanged, with another `up`, and the finger's way with them.
TEST(SurfaceFile, HasOneForceFromAnySide) {
  const test::TemporaryFolder folder;
  geometry::Surface given = geometry::sampled(geometry::Ellipsoid{{0.06, 0.05, 0.04}}, {7e-3, 7e-3})
                                .parts.front()
                                .surface;
  for (Vec3& vertex : given.vertices) vertex -= Vec3(0.02, 0.03, 0.01);
  const std::string lump =
      "[[region]]\nkind = \"sphere\"\nyoung_modulus = \"80 kPa\"\nradius = \"5 mm\"\n";
  struct Standing {
    std::array<int, 3> axes;  // of the file, for x, y and z of the body
    std::array<int, 3> signs;
  };
  std::map<std::string, std::pair<double, double>> known;  // force and stated error
  for (const Standing& one : {Standing{{0, 1, 2}, {1, 1, 1}},
                              {{0, 1, 2}, {1, -1, -1}},
                              {{1, 2, 0}, {1, 1, 1}},
                              {{1, 2, 0}, {-1, 1, -1}},
                              {{2, 0, 1}, {1, 1, 1}},
                              {{2, 0, 1}, {1, -1, -1}}}) {
    const auto placed = [&](const Vec3& place) {
      Vec3 own;
      for (std::size_t i = 0; i < 3; ++i)
        own[one.axes[i]] = one.signs[i] * place[static_cast<Eigen::Index>(i)];
      return own;
    };
    const auto named = [&](std::size_t axis, int sign) {
      return std::string(sign * one.signs[axis] > 0 ? "" : "-") + "xyz"[one.axes[axis]];
    };
    geometry::Surface turned = given;
    for (Vec3& vertex : turned.vertices) vertex = placed(vertex);
    test::write_off(folder.path() / "body.off", turned);
    const Vec3 centre = 1e3 * placed(Vec3(0.010, -0.005, 0.016));
    for (const std::string& way : {named(2, -1), named(0, -1)}) {
      const bool down = way == named(2, -1);
      const record::CaseRecord record = test::run_text(
          "[tissue]\nmaterial = \"muscle\"\nviscosity = \"none\"\nshape = { file = \"" +
          (folder.path() / "body.off").string() + "\", unit = \"mm\", up = \"" + named(2, 1) +
          "\" }\nmesh = { kind = \"tetgen\", nodes = 400 }\n[finger]\nradius = \"5 mm\"\n" +
          "towards = \"" + way + "\"\n[output]\npressure_maps = false\n[solver]\n" +
          "model = \"coupled_springs\"\nintegrator = \"quasi_static\"\ntolerance = 0.3\n" + lump +
          "centre = [\"" + number_text(centre.x()) + " mm\", \"" + number_text(centre.y()) +
          " mm\", \"" + number_text(centre.z()) +
          " mm\"]\n[[step]]\nkind = \"indent\"\nto = \"0.5 mm\"\nrate = \"0.5 mm/s\"\n");
      ASSERT_EQ(record.outcome, record::Outcome::completed) << record.reason;
      const std::pair now{record.contact.back().contact_force,
                          std::get<double>(test::finding(record, "stated_error"))};
      const auto [first, added] = known.try_emplace(down ? "down" : "side", now);
      // The meshes differ, and each is within what it states.
      EXPECT_NEAR(now.first / first->second.first, 1.0, now.second + first->second.second) << way;
      EXPECT_LT(now.second, 0.15);
    }
  }
  EXPECT_GT(std::abs(known["down"].first / known["side"].first - 1.0), 0.2) << "two presses";
}

// The contact force as the derivative of its energy: the work of the vertical travel is what the
// contact stores, 2/5 F h, up to the third order that the indentation excludes.
TEST(InclinedSurface, StoresTheWorkOfTheFinger) {
  const record::CaseRecord record =
      pressed("{ kind = \"cylinder\", radius = \"40 mm\", length = \"800 mm\" }", "65 mm", "hertz");
  ASSERT_EQ(record.outcome, record::Outcome::completed) << record.reason;
  double work = 0.0;
  for (std::size_t i = 1; i < record.contact.size(); ++i)
    work += 0.5 * (record.contact[i].contact_force + record.contact[i - 1].contact_force) *
            (record.contact[i].travel - record.contact[i - 1].travel);
  const auto& last = record.contact.back();
  // The normal's vertical part at the touch, less what it loses while the finger slides down.
  const double sine = 25.0 / 51.0;
  const double cosine = std::sqrt(1.0 - sine * sine);
  const double turned = cosine - 1e3 * last.travel * sine * sine / 51.0;
  const double stored = 0.4 * last.contact_force / turned * last.indentation;
  EXPECT_NEAR(work / stored, 1.0, 0.003);  // (travel / 51 mm)^2, and 1e-4 of the trapezia
}

}  // namespace
}  // namespace palpate::run
