// What a body sinks beyond a half-space does not depend on how it is computed.
#include "mechanics/energy_coupling.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "geometry/box_tree.h"
#include "geometry/cuboid.h"
#include "meshing/mesh_files.h"
#include "part_of_mesh.h"
#include "scene/first_touch.h"
#include "scene_text.h"
#include "temporary_folder.h"

namespace palpate::mechanics {
namespace {

const std::string press = "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n";
const std::string solver = "[solver]\nmodel = \"coupled_springs\"\n";
const std::string lump =
    "[tissue]\nmesh = { kind = \"tetgen\", nodes = 600 }\n[[region]]\nkind = \"sphere\"\ncentre = "
    "[\"30 "
    "mm\", \"30 mm\", \"20 mm\"]\nradius = \"6 mm\"\nmaterial = \"skin\"\n";

enum class Load { normal, tangential };

BeyondHalfSpace beyond(const scene::Scene& scene, Load load, int finer = 1) {
  const tissue::Part part = tissue::whole_part(scene.specimen->network);
  EnergyCoupling coupling(scene, part, scene.specimen->held);
  const geometry::SmoothSurface& outer_surface = *scene.specimen->surface;
  contact::Patch patch;
  patch.at = scene::first_touch(scene).at;
  patch.position = outer_surface.position(patch.at);
  patch.normal = outer_surface.normal(patch.at);
  patch.axis = patch.normal.unitOrthogonal();
  patch.a = patch.b = 3e-3;
  return coupling.beyond(patch, load == Load::tangential ? patch.axis : Vec3(-patch.normal), finer);
}

// 3 / (5 E' a), m/N.
double half_space(const scene::Scene& scene) {
  const auto& tissue = scene.scenario.tissue;
  return 0.6 * (1.0 - tissue.poisson_ratio * tissue.poisson_ratio) / (tissue.young_modulus * 3e-3);
}

TEST(EnergyCoupling, AFinerQuadratureChangesNothing) {
  for (const std::string& body :
       {std::string(),
        std::string("[tissue]\nshape = { kind = \"ellipsoid\", size = [\"60 mm\", \"80 mm\", \"40 "
                    "mm\"] }\nmesh = { kind = \"tetgen\", nodes = 400 }\n"),
        lump + "young_modulus = \"700 kPa\"\n"}) {
    const scene::Scene scene = test::scene_of(body + solver + press);
    for (const Load load : {Load::normal, Load::tangential}) {
      const BeyondHalfSpace once = beyond(scene, load);
      const BeyondHalfSpace twice = beyond(scene, load, 2);
      EXPECT_NEAR(once.surface_displacement, twice.surface_displacement, 0.003 * half_space(scene))
          << body;
      EXPECT_NEAR(once.error, twice.error, 0.003 * half_space(scene)) << body;
      EXPECT_GT(once.error, 0.0);
    }
  }
}

// Tetrahedra of another region but of the same tissue are treated by interpolation [split].
TEST(EnergyCoupling, ALumpOfTheSameTissueIsNone) {
  const scene::Scene scene = test::scene_of(lump + solver + press);
  const std::vector<int> regions = scene.specimen->mesh.regions;
  for (const Load load : {Load::normal, Load::tangential}) {
    scene.specimen->mesh.regions = regions;
    const BeyondHalfSpace with = beyond(scene, load);
    scene.specimen->mesh.regions.clear();
    const BeyondHalfSpace without = beyond(scene, load);
    EXPECT_NE(with.surface_displacement, without.surface_displacement);
    EXPECT_NEAR(with.surface_displacement + with.error,
                without.surface_displacement + without.error, 0.01 * half_space(scene));
  }
}

// A wall of 20 mm on a held plate, pressed in the middle of its side, and perhaps another wall in
// front of that side, 20 mm away.
std::vector<double> pressed_wall(bool another) {
  const geometry::TetMesh block =
      geometry::cuboid({0.060, 0.040, 0.040}, {12, 8, 8}, geometry::CellPattern::mirrored);
  const geometry::TetMesh walls = test::part_of(block, [another](const Vec3& middle) {
    return middle.z() < 0.010 || middle.x() < 0.020 || (another && middle.x() > 0.040);
  });
  const test::TemporaryFolder folder;
  meshing::write_node_ele(folder / "walls.node", walls);
  const scene::Scene scene = test::first_scene(scenario::parse(
      "[tissue]\nyoung_modulus = \"10 kPa\"\nbase_height = \"10 mm\"\nshape = { kind "
      "= \"as_meshed\" }\nmesh = { file = \"walls.node\", unit = \"m\" }\n[finger]\nx "
      "= \"10 mm\"\n" +
          solver + press,
      folder / "press.toml", {}));
  const tissue::Part part = tissue::whole_part(scene.specimen->network);
  EnergyCoupling coupling(scene, part, scene.specimen->held);
  const geometry::SmoothSurface& outer_surface = *scene.specimen->surface;
  const geometry::Near near =
      geometry::BoxTree(outer_surface.surface()).nearest({0.020, 0.021, 0.028});
  contact::Patch patch;
  patch.at = {near.triangle, near.weights};
  patch.position = outer_surface.position(patch.at);
  patch.normal = outer_surface.normal(patch.at);
  patch.axis = patch.normal.unitOrthogonal();
  std::vector<double> found;
  for (const double radius : {1e-3, 2e-3, 3e-3}) {
    patch.a = patch.b = radius;
    found.push_back(coupling.beyond(patch, -patch.normal).surface_displacement);
  }
  return found;
}

// The half-space's stress is that of its plane for points above it, and would press the other wall
// as hard as the patch is pressed.
TEST(EnergyCoupling, WhatHangsOverAContactIsNotPressed) {
  const std::vector<double> alone = pressed_wall(false);
  const std::vector<double> between = pressed_wall(true);
  for (std::size_t i = 0; i < alone.size(); ++i)
    EXPECT_NEAR(between[i], alone[i], 0.005 * alone[i]);  // the plate is held on its surface alone
}

}  // namespace
}  // namespace palpate::mechanics
