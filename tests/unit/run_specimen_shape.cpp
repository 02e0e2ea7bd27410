// What cases of a sweep share of their specimen is what each would have built by itself.
#include "scene/specimen_shape.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "geometry/cuboid.h"
#include "run/refined_mesh.h"
#include "scenario/family.h"
#include "scene/places.h"
#include "scene/scene.h"
#include "surface_file.h"

namespace palpate {
namespace {

const std::string press =
    "[contact]\ncoupling = \"one_way\"\n"
    "[solver]\nmodel = \"mass_spring\"\n[tissue]\nviscosity = \"none\"\n"
    "[tissue.mesh]\nkind = \"mirrored\"\ncells = [2, 3, 2]\n"
    "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n";

scenario::Family family_of(const std::string& sweep, std::vector<std::string> settings = {}) {
  return scenario::parse(press + "[sweep]\n" + sweep, "press.toml", settings);
}

void expect_same_bits(const scene::Specimen& a, const scene::Specimen& b) {
  EXPECT_EQ(a.mesh.nodes, b.mesh.nodes);
  EXPECT_EQ(a.mesh.tetrahedra, b.mesh.tetrahedra);
  EXPECT_EQ(a.network.stiffness, b.network.stiffness);
  EXPECT_EQ(a.network.node_mass, b.network.node_mass);
  EXPECT_EQ(a.outer_surface, b.outer_surface);
  EXPECT_EQ(a.surface->surface().vertices, b.surface->surface().vertices);
  EXPECT_EQ(a.surface->corner_normal(0, 1), b.surface->corner_normal(0, 1));
  EXPECT_EQ(a.held, b.held);
  EXPECT_EQ(a.base_height, b.base_height);
  EXPECT_EQ(a.measured.young_modulus, b.measured.young_modulus);
  EXPECT_EQ(a.plan.substep, b.plan.substep);
}

// Sweeps over what a shape knows and over what it does not, the cases in either order.
TEST(SpecimenShapes, build_the_same_scene_to_the_bit) {
  for (const char* sweep : {
           "\"tissue.young_modulus\" = [\"10 kPa\", \"14 kPa\"]\n"
           "\"tissue.poisson_ratio\" = [0.3, 0.4]\n",
           "\"tissue.density\" = [\"900 kg/m^3\", \"1100 kg/m^3\"]\n",
           "\"finger.x\" = [\"20 mm\", \"30 mm\"]\n",
           "\"tissue.mesh.cells\" = [[2, 3, 2], [3, 2, 2]]\n",
           "\"solver.model\" = [\"mass_spring\", \"coupled_springs\"]\n",
           "\"solver.stiffness\" = [\"van_gelder\", \"fitted\"]\n",
       }) {
    const scenario::Family family = family_of(sweep);
    for (const bool backwards : {false, true}) {
      scene::SpecimenShapes shapes;
      for (std::size_t i = 0; i < family.cases.size(); ++i) {
        const auto& one = family.cases[backwards ? family.cases.size() - 1 - i : i];
        const scene::Scene shared = run::build_scene(one, family, shapes);
        expect_same_bits(*shared.specimen, *run::build_scene(one, family).specimen);
      }
    }
  }
}

scenario::Resolved resolved(const scenario::Case& one) {
  return scenario::resolve(one, scenario::Model::mass_spring);
}

TEST(SpecimenShapes, are_built_once_for_all_that_differ_in_substance) {
  const auto family = family_of(
      "\"tissue.young_modulus\" = [\"10 kPa\", \"14 kPa\"]\n\"finger.radius\" = [\"9 mm\", "
      "\"11 mm\"]\n\"contact.coupling\" = [\"one_way\", \"consistent\"]\n");
  scene::SpecimenShapes shapes;
  const scene::SpecimenShape* first = &shapes.shape(resolved(family.cases.front()), "");
  const tissue::SpringFit* fit = &shapes.fit(resolved(family.cases.front()), "");
  for (const scenario::Case& one : family.cases) {
    EXPECT_EQ(&shapes.shape(resolved(one), ""), first) << one.name;
    EXPECT_EQ(&shapes.fit(resolved(one), ""), fit) << one.name;
  }
}

// Those that find a mesh made know what it took.
TEST(SpecimenShapes, tell_how_long_they_took) {
  const auto family = family_of("\"tissue.mesh.cells\" = [[2, 3, 2], [3, 2, 2]]\n");
  const scenario::Resolved one = resolved(family.cases[0]);
  scene::SpecimenShapes shapes;
  EXPECT_EQ(shapes.seconds(), 0.0);
  (void)shapes.shape(one, "");
  const double alone = shapes.seconds(one);
  EXPECT_GT(alone, 0.0);
  EXPECT_EQ(shapes.seconds(), alone);
  (void)shapes.shape(one, "");
  EXPECT_EQ(shapes.seconds(one), alone);
  (void)shapes.fit(one, "");
  const double fitted = shapes.seconds(one);
  EXPECT_GT(fitted, alone);
  EXPECT_EQ(shapes.seconds(), fitted);
  (void)shapes.shape(resolved(family.cases[1]), "");
  EXPECT_EQ(shapes.seconds(one), fitted);
  EXPECT_GT(shapes.seconds(), fitted);
}

// Whatever moves a node or changes what a tetrahedron is made of.
TEST(SpecimenShapes, are_apart_where_the_mesh_differs) {
  const auto key = [](const std::vector<std::string>& settings, const std::string& more = "") {
    return scene::shape_key(
        resolved(scenario::parse(press + more, "press.toml", settings).cases.front()));
  };
  const std::string lump = "[[region]]\nkind = \"sphere\"\n";
  const std::string plain = key({});
  const std::string graded = key({"tissue.mesh.grading=2"});
  EXPECT_NE(key({"tissue.mesh.cells=[2, 2, 2]"}), plain);
  EXPECT_NE(key({"tissue.mesh.kind=kuhn"}), plain);
  EXPECT_NE(key({"tissue.shape.size=[\"60 mm\", \"60 mm\", \"31 mm\"]"}), plain);
  EXPECT_NE(graded, plain);
  EXPECT_NE(key({"tissue.mesh.grading=2", "finger.x=20 mm"}), graded);
  EXPECT_NE(key({"tissue.mesh.grading=2", "tissue.mesh.kind=kuhn", "finger.y=20 mm"}),
            key({"tissue.mesh.grading=2", "tissue.mesh.kind=kuhn"}));
  const std::vector<std::string> meshed{"tissue.mesh={ kind = \"tetgen\", nodes = 200 }"};
  const std::string soft = key(meshed, lump);
  EXPECT_NE(soft, key(meshed));
  EXPECT_NE(soft, key(meshed, lump + "radius = \"4 mm\"\n"));
  EXPECT_EQ(soft, key(meshed, lump + "young_modulus = \"50 kPa\"\n"));
  const std::string creep =
      "[tissue]\nshape = { kind = \"ligament\" }\n[[step]]\nkind = \"creep\"\n";
  const std::string pressed =
      "[tissue]\nshape = { kind = \"ligament\" }\n[[step]]\nkind = \"indent\"\n";
  const auto only = [](const std::string& text) {
    return scene::shape_key(resolved(scenario::parse(text, "a.toml", {}).cases.front()));
  };
  EXPECT_NE(only(creep), only(pressed));  // a uniform test stands it on its end
}

// Two blocks in one file, each pressed from above in two places and from a side.
TEST(SpecimenShapes, places_on_one_part_share_its_surface_and_mesh) {
  const test::TemporaryFolder folder;
  geometry::Surface both;
  for (const double x : {0.0, 0.05}) {
    const geometry::Surface block =
        geometry::outer_surface(
            geometry::cuboid(Vec3(0.03, 0.03, 0.02), {2, 2, 2}, geometry::CellPattern::mirrored))
            .surface;
    const int before = static_cast<int>(both.vertices.size());
    for (const Vec3& vertex : block.vertices)
      both.vertices.push_back((x > 0.0 ? 0.9 : 1.0) * vertex + Vec3(x, 0.0, 0.0));
    for (const auto& [a, b, c] : block.triangles)
      both.triangles.push_back({a + before, b + before, c + before});
  }
  test::write_off(folder / "both.off", both);
  scene::SpecimenShapes shapes;
  const auto placed = [&](const std::string& at) {
    scenario::Case one =
        scenario::parse(
            "[tissue]\nshape = { kind = \"file\", file = \"both.off\", unit = \"mm\" }\n"
            "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n[finger]\nat = " +
                at + "\n",
            (folder / "press.toml").string(), {})
            .cases.front();
    scenario::Resolved found = scenario::resolve(one, scenario::strongest.of);
    scene::place_in_scene(found, folder.path().string(), shapes);
    return found;
  };
  const auto surface = [&](const scenario::Resolved& one) {
    return shapes.surface(one, folder.path().string()).surface;
  };
  const scenario::Resolved first = placed("[\"10 mm\", \"10 mm\", \"20 mm\"]");
  const scenario::Resolved beside = placed("[\"20 mm\", \"12 mm\", \"20 mm\"]");
  const scenario::Resolved other = placed("[\"60 mm\", \"10 mm\", \"18 mm\"]");
  const scenario::Resolved side = placed("[\"0 mm\", \"10 mm\", \"10 mm\"]");
  ASSERT_TRUE(surface(first));
  EXPECT_EQ(first.tissue.near_part, 1);
  EXPECT_EQ(other.tissue.near_part, 2);
  EXPECT_EQ(surface(first), surface(beside)) << "one object";
  EXPECT_NE(surface(first), surface(other));
  EXPECT_NE(surface(first), surface(side));
  EXPECT_EQ(scene::shape_key(first), scene::shape_key(beside));
  EXPECT_NE(scene::shape_key(first), scene::shape_key(other));
  EXPECT_NE(scene::shape_key(first), scene::shape_key(side));
}

TEST(SpecimenShapes, refuse_each_time_they_are_asked) {
  scenario::Resolved lost = resolved(family_of("").cases.front());
  lost.tissue.shape = scenario::AsMeshed{};
  lost.tissue.mesh = scenario::MeshFile{{}, "none.msh", "mm"};
  scene::SpecimenShapes shapes;
  for (int i = 0; i < 2; ++i) EXPECT_THROW((void)shapes.shape(lost, "/nowhere"), std::exception);
}

}  // namespace
}  // namespace palpate
