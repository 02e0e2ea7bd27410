// Meshes whose number of nodes a scenario leaves open.
#include <gtest/gtest.h>

#include "base/error.h"
#include "scenario/family.h"
#include "scenario_text.h"
#include "scene/specimen_shape.h"

namespace palpate::scene {
namespace {

SpecimenShape shape_of_text(const std::string& text) {
  const auto family = scenario::parse(text, "test.toml", {});
  return make_shape(scenario::resolve(family.cases.front(), scenario::strongest.of), "", nullptr);
}

// The surfaces of this limb alone have more than the 728 nodes of TetGen's default.
const std::string slender_limb =
    "[tissue]\nshape = { kind = \"layered_limb\", radius = \"20 mm\", end_radius = \"15 mm\", "
    "length = \"250 mm\", skin_thickness = \"1.5 mm\", bone_radius = \"2 mm\" }\n";

TEST(LeftOpenMesh, OfASlenderLimbHasWhatItsSurfacesNeed) {
  const SpecimenShape shape = shape_of_text(slender_limb + scenario::small_press);
  EXPECT_GT(shape.mesh.nodes.size(), 1.25 * 728);
  EXPECT_LT(shape.mesh.nodes.size(), 4000U);
}

TEST(LeftOpenMesh, IsNotOneThatTheScenarioGives) {
  EXPECT_THROW((void)shape_of_text(slender_limb + "mesh = { kind = \"tetgen\", nodes = 728 }\n" +
                                   scenario::small_press),
               MeshError);
}

}  // namespace
}  // namespace palpate::scene
