// `hertz` on a surface file against a mesh of the same file, on the top and where it is inclined.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/shapes.h"
#include "run_text.h"
#include "surface_file.h"

namespace palpate::run {
namespace {

// Half axes of 400, 300 and 360 mm: the whole body's compression is small.
const geometry::Ellipsoid body{{0.8, 0.6, 0.72}};

void write_body(const test::fs::path& path) {
  test::write_off(path, geometry::sampled(body, {15e-3, 15e-3}).parts.front().surface);
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

// The contact force as the derivative of its energy: the work of the vertical travel is what the
// contact stores, 2/5 F h, up to the third order that the indentation leaves out.
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
