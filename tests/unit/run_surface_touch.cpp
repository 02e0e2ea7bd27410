// The touch on surface files, its limits, and the indentation on an inclined surface.
#include "scene/surface_touch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "base/text.h"
#include "geometry/shapes.h"
#include "refusal.h"
#include "run/choose.h"
#include "scenario_text.h"
#include "scene/estimates.h"
#include "scene/specimen_shape.h"
#include "scene_text.h"
#include "surface_file.h"
#include "temporary_folder.h"
#include "test_surfaces.h"

namespace palpate::scene {
namespace {

geometry::Surface sampled(const geometry::Shape& shape, double spacing) {
  return geometry::sampled(shape, {spacing, spacing}).parts.front().surface;
}

class SurfaceFiles : public testing::Test {
 protected:
  void write(const geometry::Surface& surface) {
    test::write_off(folder_.path() / "body.off", surface);
  }

  [[nodiscard]] std::string text(const std::string& finger, const std::string& more = "") const {
    return "[tissue]\nmaterial = \"skin\"\nshape = { file = \"" +
           (folder_.path() / "body.off").string() + "\", unit = \"mm\" }\n[finger]\n" + finger +
           "[[step]]\nkind = \"indent\"\nto = \"2 mm\"\n" + more;
  }
  [[nodiscard]] SurfaceTouch touch(const std::string& finger) const {
    return touch_of(text(finger));
  }
  [[nodiscard]] static SurfaceTouch touch_of(const std::string& text) {
    SpecimenShapes shapes;
    return surface_touch(scenario::resolve(scenario::read_case(text), scenario::strongest.of), "",
                         shapes);
  }
  [[nodiscard]] std::string refused(const std::string& finger, const std::string& more) const {
    return test::refusal([&] { return test::scene_of(text(finger, hertz + more)); });
  }

  const std::string hertz = "[solver]\nmodel = \"hertz\"\n";
  test::TemporaryFolder folder_;
};

TEST_F(SurfaceFiles, AreTouchedWhereTheShapeIs) {
  for (const double spacing : {5e-3, 2e-3}) {
    write(sampled(geometry::Ellipsoid{}, spacing));
    for (const char* x : {"77 mm", "107 mm", "30 mm"}) {
      const std::string place = "x = \"" + std::string(x) + "\"\ny = \"80 mm\"\n";
      const SurfaceTouch file = touch(place);
      const SurfaceTouch shape =
          touch_of("[tissue]\nmaterial = \"skin\"\nshape = { kind = \"ellipsoid\" }\n[finger]\n" +
                   place + "[[step]]\nkind = \"indent\"\n");
      ASSERT_TRUE(file.known() && shape.known()) << file.cannot;
      EXPECT_NEAR(file.curvature.kappa_1 / shape.curvature.kappa_1, 1.0, 0.01);
      EXPECT_NEAR(file.curvature.kappa_2 / shape.curvature.kappa_2, 1.0, 0.01);
      EXPECT_GT(file.curvature.normal.dot(shape.curvature.normal), std::cos(0.005));
      // The smooth surface through the triangles follows the shape to second order.
      EXPECT_LT((file.lowest - shape.lowest).norm(), 0.02e-3);
      // Straight down, a file ends at its own underside, a shape at that of its box.
      EXPECT_LT(file.thickness, shape.thickness + 0.5e-3);
      EXPECT_GT(file.thickness, 0.9 * shape.thickness);
      EXPECT_LT((file.size - shape.size).norm(), 0.5e-3);
    }
  }
}

// A scan has a grain: here 0.02 mm on triangles of 1 mm, which alone would be curvatures of 100/m.
TEST_F(SurfaceFiles, WithAGrainAreMeasuredOverTheContact) {
  geometry::Surface surface = sampled(geometry::Ellipsoid{{0.1, 0.1, 0.1}}, 1e-3);
  test::Dice dice(7);
  for (Vec3& vertex : surface.vertices)
    vertex += 0.02e-3 * (2.0 * dice.roll() - 1.0) * (vertex - Vec3::Constant(0.05)).normalized();
  write(surface);
  const SurfaceTouch found = touch("x = \"60 mm\"\n");
  ASSERT_TRUE(found.known()) << found.cannot;
  EXPECT_NEAR(found.curvature.kappa_1, 20.0, 6.0);  // a third: four times less than two rings give
  EXPECT_NEAR(found.curvature.kappa_2, 20.0, 6.0);
}

TEST_F(SurfaceFiles, TellAutoTheirThicknessAndWidth) {
  write(sampled(geometry::Ellipsoid{{0.08, 0.08, 0.02}}, 2e-3));
  const Choice choice = run::choose(scenario::read_case(text("")));
  EXPECT_NEAR(choice.touch.size.x(), 0.08, 1e-4);
  EXPECT_NEAR(choice.touch.thickness, 0.02, 1e-4);
  const Estimates found = choice.expected;
  ASSERT_TRUE(found.measured);
  const Question* size = nullptr;
  for (const Question& question : choice.questions)
    if (question.asked == "size") size = &question;
  ASSERT_NE(size, nullptr);
  // A flat layer as thick would have a quarter more; its lowest tenth, a circle of 0.3 of its
  // width, takes some of it back.
  EXPECT_GT(found.size, 0.05);
  EXPECT_LT(found.size, 0.4);
  EXPECT_EQ(size->number, found.size);
  ASSERT_NE(choice.forecast(scenario::Model::hertz), nullptr);
  EXPECT_GT(choice.forecast(scenario::Model::hertz)->error, 0.1);
  EXPECT_NE(choice.chosen.solver.model, scenario::Model::hertz);
  // A large body of the same tissue is nearly a half-space.
  write(sampled(geometry::Ellipsoid{{0.4, 0.4, 0.4}}, 10e-3));
  const Choice large = run::choose(scenario::read_case(text("x = \"240 mm\"\n")));
  EXPECT_LT(std::abs(large.expected.size), 0.05);
}

TEST_F(SurfaceFiles, KnowTheirNearestEdge) {
  write(sampled(geometry::Cuboid{{0.024, 0.024, 0.012}}, 2e-3));
  EXPECT_NEAR(touch("x = \"5 mm\"\ny = \"12 mm\"\n").to_edge, 0.005, 1e-9);
  EXPECT_NEAR(touch("x = \"5 mm\"\ny = \"21 mm\"\n").to_edge, 0.003, 1e-9);
  write(sampled(geometry::Ellipsoid{}, 5e-3));
  EXPECT_FALSE(std::isfinite(touch("").to_edge));
  write({{{0.03, 0, 0}, {-0.03, 0, 0}, {0, 0.03, 0}, {0, -0.03, 0}, {0, 0, 0.02}, {0, 0, -0.02}},
         {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}});
  EXPECT_EQ(touch("").to_edge, 0.0) << "a tip";
  const std::string bar =
      "[tissue]\nmaterial = \"skin\"\nshape = { kind = \"cylinder\" }\n"
      "[finger]\ny = \"3 mm\"\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n";
  EXPECT_NEAR(touch_of(bar).to_edge, 0.003, 1e-9);
}

TEST_F(SurfaceFiles, MayHaveSlabs) {
  write(sampled(geometry::Ellipsoid{{0.08, 0.08, 0.02}}, 2e-3));
  const Choice choice = run::choose(scenario::read_case(
      text("",
           "[[region]]\nkind = \"slab\"\nbottom = \"0 mm\"\ntop = \"4 mm\"\nmaterial = "
           "\"muscle\"\n")));
  EXPECT_EQ(choice.chosen.solver.model, scenario::Model::solid);
}

TEST_F(SurfaceFiles, AreRefusedWhereNoFormulaHolds) {
  write(sampled(geometry::Cylinder{}, 2e-3));
  EXPECT_NE(refused("y = \"-3 mm\"\n", "").find("first touches an edge of the surface"),
            std::string::npos);
  EXPECT_NE(refused("x = \"68 mm\"\n", "").find("the surface is inclined by "), std::string::npos);
  EXPECT_NE(refused("spheres = 3\n", "").find("several spheres meet a curved surface"),
            std::string::npos);
  EXPECT_NE(refused("", "[[step]]\nkind = \"slide\"\nby = \"1 mm\"\n")
                .find("the finger slides over a curved surface"),
            std::string::npos);
  EXPECT_NE(test::refusal<MeshError>([&] {
              return test::scene_of(text("x = \"90 mm\"\n", hertz));
            }).find("the finger passes beside the specimen at x 90 mm, y "),
            std::string::npos);
  geometry::Surface open = sampled(geometry::Cylinder{}, 5e-3);
  open.triangles.resize(open.triangles.size() * 3 / 4);  // too much to be mended
  write(open);
  EXPECT_NE(
      test::refusal<MeshError>([&] { return test::scene_of(text("", hertz)); }).find("is open: "),
      std::string::npos);
}

TEST_F(SurfaceFiles, AreReadOnceForAllCases) {
  write(sampled(geometry::Ellipsoid{}, 8e-3));
  SpecimenShapes shapes;
  const scenario::Case one = scenario::read_case(text(""));
  const SurfaceTouch first = run::choose(one, shapes).touch;
  test::fs::remove(folder_.path() / "body.off");
  EXPECT_EQ(run::choose(one, shapes).touch.position, first.position);
  EXPECT_NE(run::choose(one).touch.cannot, "");
}

// A ball on a ball: the indentation is the sum of the radii less the distance of the centres.
TEST(Inclined, IndentationIsTheSpheresToSecondOrder) {
  constexpr double own = 0.011;
  constexpr double other = 0.040;
  SurfaceTouch touch;
  const Vec3 normal = Vec3(0.3, -0.4, 1.0).normalized();
  const auto [a, b] = geometry::tangent_axes(normal);
  touch.curvature = {1.0 / other, 1.0 / other, a, b, normal};
  for (const double travel : {1e-4, 1e-3, 4e-3}) {
    const Vec3 centre = (own + other) * normal - travel * Vec3::UnitZ();
    const auto [depth, direction] = touch.pressed(own, travel);
    // The next term of the square root: t^3 cos sin^2 / (2 (R + R_2)^2), and 10 % for those after.
    const double cosine = normal.z();
    const double third = 0.55 * travel * travel * travel * cosine * (1.0 - cosine * cosine) /
                         ((own + other) * (own + other));
    EXPECT_NEAR(depth, own + other - centre.norm(), third);
    EXPECT_LT((direction - centre.normalized()).norm(), std::pow(travel / (own + other), 2));
    EXPECT_GT(std::abs(travel * normal.z() - (own + other - centre.norm())), 3.0 * third);
  }
}

TEST(Inclined, AFlatIsExact) {
  SurfaceTouch touch;
  touch.curvature.normal = Vec3(0.6, 0.0, 0.8);
  touch.curvature.direction_1 = Vec3(0.8, 0.0, -0.6);
  EXPECT_EQ(touch.pressed(0.011, 0.002).depth, 0.002 * 0.8);
  EXPECT_EQ(SurfaceTouch{}.pressed(0.011, 0.002).depth, 0.002);
}

}  // namespace
}  // namespace palpate::scene
