// What bodies move under a tangential load beyond a half-space, against independent solutions.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/dense.h"
#include "cases.h"
#include "mechanics/pressed_mesh.h"
#include "revolved_bodies.h"
#include "scene/first_touch.h"
#include "scene_text.h"

namespace palpate {
namespace {

constexpr double young_modulus = 72.4e3;  // Pa

double shear_modulus(double nu) { return 0.5 * young_modulus / (1.0 + nu); }

contact::Patch patch_of(const scene::Scene& scene, double radius) {
  const geometry::SmoothSurface& outer_surface = *scene.specimen->surface;
  contact::Patch patch;
  patch.at = scene::first_touch(scene).at;
  patch.position = outer_surface.position(patch.at);
  patch.normal = outer_surface.normal(patch.at);
  patch.axis = Vec3::UnitX();
  patch.a = patch.b = radius;
  return patch;
}

// s + e along x and y, m/N.
Eigen::Matrix3d shear_of(const std::string& text, double radius) {
  const scene::Scene scene = test::scene_of(text + "[contact]\nfriction = 0.3\n");
  const tissue::Part part = tissue::whole_part(scene.specimen->network);
  mechanics::BodySurfaceDisplacement beyond(scene, part, scene.specimen->held,
                                            radius * radius / 11e-3);
  return beyond.shear(patch_of(scene, radius));
}

// What a traction of Hertz's shape over one radius (m) moves the skin under a second one more than
// a half-space, on an infinitely wide bonded layer, m/N: with the transform 3 (sin x - x cos x)/x^3
// of that shape at x = u a/h, the in-plane response L and tanh u, that of pure shear,
//   s = 1/(4 pi G h) int shape_1 shape_2 [(1 - nu)(L - 1) + tanh u - 1] du,
//   L = (2 K sinh 2u + 4u) / (2 K cosh 2u + 1 + K^2 + 4 u^2),  K = 3 - 4 nu.
double layer_shear(double nu, double height, double first, double second) {
  const double kappa = 3.0 - 4.0 * nu;
  constexpr double step = 2e-3;
  const auto shape = [](double x) {
    return x < 1e-2 ? 1.0 - 0.1 * x * x : 3.0 * (std::sin(x) - x * std::cos(x)) / (x * x * x);
  };
  double sum = 0.0;
  for (double u = 0.5 * step; u < 25.0; u += step) {
    const double in_plane = (2.0 * kappa * std::sinh(2.0 * u) + 4.0 * u) /
                            (2.0 * kappa * std::cosh(2.0 * u) + 1.0 + kappa * kappa + 4.0 * u * u);
    sum += step * shape(u * first / height) * shape(u * second / height) *
           ((1.0 - nu) * (in_plane - 1.0) + std::tanh(u) - 1.0);
  }
  return sum / (4.0 * std::numbers::pi * shear_modulus(nu) * height);
}

// 3 (2 - nu) / (20 G a), m/N.
double half_space_shear(double nu, double radius) {
  return 0.15 * (2.0 - nu) / (shear_modulus(nu) * radius);
}

TEST(Shear, OfThinDiscsIsThatOfABondedLayer) {
  constexpr double radius = 2.35e-3;
  for (const double nu : {0.33, 0.45})
    for (const double height : {5.0, 10.0}) {
      const double half_space = half_space_shear(nu, radius);
      const double layer = layer_shear(nu, 1e-3 * height, radius, radius);
      std::vector<double> known;
      for (const int nodes : {400, 1500}) {
        const test::TemporaryFolder folder;
        const test::Body body{.id = {},
                              .profile = [=](double h) { return test::disc(30.0, height, h); },
                              .volume = test::of_disc(30.0, height),
                              .young_modulus = 1e-3 * young_modulus,
                              .poisson_ratio = nu,
                              .deepest = 0.5,
                              .most = 0.0};
        const std::string mesh =
            "mesh = { kind = \"tetgen\", nodes = " + std::to_string(nodes) + " }\n";
        const Eigen::Matrix3d shear = shear_of(
            test::body_press(body, folder.path() / "disc.off", nodes, "coupled_springs", mesh),
            radius);
        // The mesh, and the disc's rim, in all that the contact moves.
        for (const int axis : {0, 1})
          EXPECT_NEAR(half_space + shear(axis, axis), half_space + layer,
                      0.007 * (half_space + layer))
              << nu << " " << height << " " << nodes;
        EXPECT_NEAR(shear(0, 1), 0.0, 1e-3 * half_space) << nu << " " << height;
        known.push_back(shear(0, 0));
      }
      EXPECT_NEAR(known[0], known[1], 0.004 * half_space) << nu << " " << height;
    }
}

// By finite elements of second order under the traction itself.
TEST(Shear, OfABlockIsThatOfFiniteElements) {
  constexpr double radius = 4e-3;
  struct Block {
    const char* size;
    double nu;
    std::array<const char*, 2> cases;  // along its length and width
  };
  for (const Block& block :
       {Block{"60 mm\", \"60 mm\", \"30 mm", 0.33, {"tangential-01", "tangential-01"}},
        Block{"60 mm\", \"60 mm\", \"30 mm", 0.45, {"tangential-02", "tangential-02"}},
        Block{"30 mm\", \"60 mm\", \"20 mm", 0.45, {"tangential-03", "tangential-04"}}}) {
    const double half_space = half_space_shear(block.nu, radius);
    std::vector<double> known;
    for (const int nodes : {400, 1500}) {
      const Eigen::Matrix3d shear = shear_of(
          "[tissue]\nmaterial = \"skin\"\nyoung_modulus = \"72.4 kPa\"\npoisson_ratio = " +
              number_text(block.nu) + "\nshape = { kind = \"cuboid\", size = [\"" + block.size +
              "\"] }\nmesh = { kind = \"tetgen\", nodes = " + std::to_string(nodes) +
              " }\n[solver]\nmodel = \"coupled_springs\"\n[[step]]\nkind = "
              "\"indent\"\nto = \"1 mm\"\n",
          radius);
      for (const int axis : {0, 1}) {
        const test::Case want = test::find_case(block.cases[as_index(axis)]);
        EXPECT_NEAR(half_space + shear(axis, axis), want.value,
                    (nodes == 400 ? 2.0 : 1.0) * want.rel_tol * want.value)
            << block.cases[as_index(axis)] << " " << nodes;
      }
      known.push_back(shear(0, 0));
    }
    EXPECT_NEAR(known[0], known[1], 0.004 * half_space) << block.size << block.nu;
  }
}

const std::string shear_press =
    "[tissue]\nmaterial = \"skin\"\nviscosity = \"none\"\n[contact]\nfriction = "
    "0.3\n[solver]\nmodel = "
    "\"mass_spring\"\nintegrator = \"quasi_static\"\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n";

// Contacts of the finger `offset` (m) from its first touch.
mechanics::Touch touch_of(const scene::Scene& scene, const Vec3& offset) {
  mechanics::PressedMesh mesh(scene);
  mechanics::Touch touch;
  touch.finger = scene::first_touch(scene).finger;
  EXPECT_FALSE(mesh.try_out(touch.finger + offset, touch));
  EXPECT_GT(touch.contacts.size(), 0U);
  return touch;
}

TEST(Shear, IsNoneWhereItIsNotKnown) {
  for (const char* setting :
       {"tissue.mesh={ kind = \"kuhn\", cells = [4, 4, 4] }", "tissue.base=frictionless",
        "contact.friction=0", "contact.slip=coulomb", "contact.coupling=one_way"}) {
    const mechanics::Touch touch =
        touch_of(test::scene_of(shear_press, {setting}), {0.0, 0.0, -1e-3});
    const bool known = std::string(setting).find("mesh") != std::string::npos;
    EXPECT_EQ(touch.contacts.front().shear.norm() > 0.0, known) << setting;
  }
}

TEST(Shear, IsInTheTangentPlaneOfCurvedSkin) {
  const scene::Scene scene = test::scene_of(
      shear_press,
      {"tissue.shape={ kind = \"ellipsoid\", size = [\"60 mm\", \"90 mm\", \"50 mm\"] }",
       "tissue.mesh={ kind = \"tetgen\", nodes = 400 }"});
  for (const Vec3& offset : {Vec3(0.0, 0.0, -1e-3), Vec3(5e-3, -3e-3, -1.5e-3)}) {
    const mechanics::SphereContact contact = touch_of(scene, offset).contacts.front();
    const double size = contact.shear.norm();
    EXPECT_LT((contact.shear * contact.patch.normal).norm(), 1e-12 * size);
    EXPECT_LT((contact.shear - contact.shear.transpose()).norm(), 1e-12 * size);
    // The ellipsoid yields to both directions, and less along than across.
    EXPECT_GT(contact.shear(0, 0), contact.shear(1, 1));
  }
}

// Spheres that represent one share its tensor; under their whole drag each moves as it would.
TEST(Shear, OfSpheresThatRepresentOneIsItsOwn) {
  const Vec3 down(0.0, 0.0, -0.5e-3);
  const std::string layer =
      "tissue.shape={ kind = \"cuboid\", size = [\"60 mm\", \"60 mm\", \"8 mm\"] }";
  const mechanics::Touch one = touch_of(test::scene_of(shear_press, {layer}), down);
  const mechanics::Touch all =
      touch_of(test::scene_of(shear_press, {layer, "finger.spheres=8"}), down);
  ASSERT_GT(all.contacts.size(), 1U);
  const double want = one.contacts.front().shear(0, 0);
  for (const mechanics::SphereContact& contact : all.contacts)
    EXPECT_NEAR(contact.shear(0, 0) * contact.force / all.pressed(), want, 0.1 * std::abs(want));
}

// The law [stick] against a layer solved for its traction. The contact sticks where the traction
// stores the least energy among sums of Hertz's shapes of twelve radii; it begins to slip
// everywhere when its middle has moved as far as the finger.
TEST(Shear, LawOfALayerIsThatOfItsOwnTraction) {
  constexpr double radius = 4e-3;
  constexpr Eigen::Index count = 12;
  for (const double nu : {0.33, 0.45})
    for (const auto& [height, tolerance] : {std::pair{8e-3, 0.01}, {5e-3, 0.025}}) {
      const double softness = (2.0 - nu) / shear_modulus(nu);
      Eigen::MatrixXd half_space(count, count);
      Eigen::MatrixXd layer(count, count);
      for (Eigen::Index i = 0; i < count; ++i)
        for (Eigen::Index j = 0; j < count; ++j) {
          const double first = radius * static_cast<double>(i + 1) / count;
          const double second = radius * static_cast<double>(j + 1) / count;
          const double wide = std::max(first, second);
          const double ratio = std::min(first, second) / wide;
          half_space(i, j) = 3.0 * softness / (16.0 * wide) * (1.0 - 0.2 * ratio * ratio);
          layer(i, j) = half_space(i, j) + layer_shear(nu, height, first, second);
        }
      const auto least = [&](const Eigen::MatrixXd& compliance) {
        const Eigen::VectorXd one = Eigen::VectorXd::Ones(count);
        return 1.0 / one.dot(dense::least_squares(compliance, one));
      };
      const double at_rest = softness / (8.0 * radius);
      const double middle = 3.0 * softness / (16.0 * radius);
      const double beyond = layer_shear(nu, height, radius, radius);
      const double stick = at_rest + least(layer) - least(half_space);
      const double slip = middle + layer_shear(nu, height, 1e-3 * radius, radius);
      EXPECT_NEAR(at_rest + beyond, stick, tolerance * stick) << nu << " " << height;
      EXPECT_NEAR(middle + beyond, slip, tolerance * slip) << nu << " " << height;
    }
}

}  // namespace
}  // namespace palpate
