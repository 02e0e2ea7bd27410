// `hertz` on shapes and surface files, away from their tops: what is run, refused and explained.
#include <gtest/gtest.h>

#include "base/text.h"
#include "geometry/shapes.h"
#include "program.h"

namespace palpate::test {
namespace {

const std::string hertz =
    "[[step]]\nkind = \"indent\"\n[output]\nfigures = false\npressure_maps = false\n"
    "[solver]\nmodel = \"hertz\"\n";

class RunSurfaces : public testing::Test {
 protected:
  [[nodiscard]] Ended palpate_on(const char* verb, const std::string& tissue,
                                 const std::string& finger) const {
    write_file(folder_ / "press.toml", hertz + "[tissue]\n" + tissue + "[finger]\n" + finger);
    return palpate(folder_.path(), {verb, "press.toml"},
                   verb == std::string("run") ? std::vector<std::string>{"--force"}
                                              : std::vector<std::string>{});
  }

  TemporaryFolder folder_;
};

TEST_F(RunSurfaces, press_every_shape_beside_its_middle) {
  for (const char* kind : {"cylinder", "ellipsoid", "ligament", "bone_shaft"}) {
    const Ended ended =
        palpate_on("run", "shape = { kind = \"" + std::string(kind) + "\" }\n", "x = \"20 mm\"\n");
    EXPECT_EQ(ended.code, 0) << kind << ended.err;
  }
}

TEST_F(RunSurfaces, are_refused_with_the_reason_and_a_remedy) {
  const std::string cylinder = "shape = { kind = \"cylinder\" }\n";
  const auto refused = [&](const std::string& finger, int code, const std::string& sentence) {
    const Ended ended = palpate_on("run", cylinder, finger);
    EXPECT_EQ(ended.code, code);
    EXPECT_TRUE(says(ended, sentence)) << ended.err;
  };
  const std::string start = "press.toml:7:9: `hertz` cannot compute this scene: ";
  const std::string mesh = "; set `solver.model = \"auto\"`, which takes one that can";
  refused(
      "y = \"-3 mm\"\n", 2,
      start + "the finger first touches an edge of the surface, where it has no curvature" + mesh);
  refused("x = \"68 mm\"\n", 2,
          start +
              "the surface is inclined by 68 degrees where the finger touches it, and the formula "
              "holds up to 60" +
              mesh);
  refused("x = \"90 mm\"\n", 2,
          "press.toml:11:5: the finger passes beside the specimen at x 90 mm, y 40 mm, where "
          "it has nothing: its box has x ");
}

TEST_F(RunSurfaces, slide_from_under_an_inclined_press_where_the_base_has_no_friction) {
  const std::string cylinder = "base = \"frictionless\"\nshape = { kind = \"cylinder\" }\n";
  const auto run = [&](const std::string& x) {
    write_file(folder_ / "press.toml",
               "[[step]]\nkind = \"indent\"\n[output]\nfigures = false\npressure_maps = false\n"
               "[solver]\nmodel = \"coupled_springs\"\n[tissue]\n" +
                   cylinder + "[finger]\nx = \"" + x + " mm\"\n");
    return palpate(folder_.path(), {"run", "press.toml"},
                   {"--force", "--set", "solver.tolerance=0.3"});  // a coarse mesh serves
  };
  const Ended ended = run("33");
  EXPECT_EQ(ended.code, 2);
  EXPECT_TRUE(
      says(ended,
           "press.toml:9:8: the finger presses on a surface that is inclined by 4.2 degrees, and "
           "on a frictionless base nothing keeps the specimen from sliding away; set "
           "`tissue.base = \"bonded\"`, or press where the surface is level"))
      << ended.err;
  EXPECT_EQ(run("31").code, 0);
}

TEST_F(RunSurfaces, are_explained) {
  const geometry::Surface ball =
      geometry::sampled(geometry::Ellipsoid{{0.1, 0.1, 0.1}}, {4e-3, 4e-3}).parts.front().surface;
  std::string off = "OFF\n" + std::to_string(ball.vertices.size()) + " " +
                    std::to_string(ball.triangles.size()) + " 0\n";
  for (const Vec3& v : ball.vertices)
    off += number_text(v.x()) + " " + number_text(v.y()) + " " + number_text(v.z()) + "\n";
  for (const auto& [a, b, c] : ball.triangles)
    off += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
  write_file(folder_ / "ball.off", off);
  // (11 + 50 mm) sin 30 degrees beside the middle.
  const Ended ended =
      palpate_on("explain", "shape = { file = \"ball.off\", unit = \"m\" }\n", "x = \"80.5 mm\"\n");
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_NE(ended.out.find("file ball.off, in m, "), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("top          curvatures 20"), std::string::npos) << ended.out;
  EXPECT_NE(ended.out.find("press        at (75, 50, 93.3) mm, in the file's coordinates"),
            std::string::npos)
      << ended.out;
  EXPECT_NE(ended.out.find("positive if convex; the surface is inclined by 30 degrees"),
            std::string::npos)
      << ended.out;
  EXPECT_NE(ended.out.find("size         change of a half-space's force by the size of the body"),
            std::string::npos);
}

}  // namespace
}  // namespace palpate::test
