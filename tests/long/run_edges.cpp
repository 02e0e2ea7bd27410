// What is stated where a block from a file is pressed at its edge or beside it.
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/shapes.h"
#include "run_text.h"
#include "surface_file.h"

namespace palpate {
namespace {

class Edges : public testing::Test {
 protected:
  void write(const Vec3& size) {
    const geometry::Shape block = geometry::Cuboid{size};
    test::write_off(folder_.path() / "block.off",
                    geometry::sampled(block, {2e-3, 2e-3}).parts.front().surface);
  }

  // Pressed 0.5 mm deep by a rigid sphere of 11 mm at x and y, mm.
  [[nodiscard]] record::CaseRecord run(const char* model, double x, double y) const {
    return test::run_text(
        "[tissue]\nmaterial = \"skin\"\nviscosity = \"none\"\nshape = { file = \"" +
        (folder_.path() / "block.off").string() +
        "\", unit = \"mm\" }\n[finger]\nmaterial = \"rigid\"\nx = \"" + number_text(x) +
        " mm\"\ny = \"" + number_text(y) +
        " mm\"\n[contact]\ndepth = \"hertz\"\n[solver]\nmodel = \"" + model +
        "\"\n[output]\npressure_maps = false\nfits = false\n[[step]]\nkind = \"indent\"\nto = "
        "\"0.5 "
        "mm\"\n");
  }

  test::TemporaryFolder folder_;
};

// The forces are those of a cuboid with `resolved` contact on graded cells:
//   palpate run BLOCK.toml --set solver.model=coupled_springs --set contact.coupling=resolved
//     --set finger.x="1.2 mm" --set "tissue.mesh={kind='mirrored',cells=[40,30,16],grading=6}"
TEST_F(Edges, StateWhatTheyMayCostInTheContact) {
  write({0.024, 0.024, 0.012});
  const double resolved[][2] = {{1.2, 0.0904}, {0.6, 0.0765}};
  for (const auto& [x, truth] : resolved) {
    const record::CaseRecord pressed = run("coupled_springs", x, 12.0);
    const double off = test::found(pressed, "peak_force_N") / truth - 1.0;
    EXPECT_GT(off, 0.2) << x;
    EXPECT_LT(off, test::found(pressed, "stated_error")) << x;
    EXPECT_LT(test::found(pressed, "stated_error"), 4.0 * off) << x;
  }
  EXPECT_EQ(test::found(run("coupled_springs", 8.0, 12.0), "edge_effect"), 0.0);
}

// Against a mesh of the same block, whose own error is less than 4 %.
TEST_F(Edges, StateWhatTheyCostHertzBesideTheContact) {
  write({0.060, 0.060, 0.030});
  for (const double x : {3.0, 4.0, 6.0}) {
    const record::CaseRecord mesh = run("coupled_springs", x, 30.0);
    const record::CaseRecord formula = run("hertz", x, 30.0);
    const double off =
        test::found(formula, "peak_force_N") / test::found(mesh, "peak_force_N") - 1.0;
    EXPECT_LT(std::abs(off), test::found(formula, "stated_error")) << x;
    EXPECT_LT(test::found(mesh, "mesh_error"), 0.04) << x;
  }
}

}  // namespace
}  // namespace palpate
