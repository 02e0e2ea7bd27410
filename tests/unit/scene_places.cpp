// Boxes, and regions that are not where the body is.
#include "scene/places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "geometry/shapes.h"
#include "scene/scene.h"

namespace palpate::scene {
namespace {

const std::string kLump =
    "[tissue]\nyoung_modulus = \"10 kPa\"\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n"
    "[[region]]\nkind = \"sphere\"\nradius = \"5 mm\"\n";

std::string refusal_of(const std::string& text) {
  try {
    const scenario::Family family = scenario::parse(text, "press.toml", {});
    (void)build(family.cases.front(), family);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Places, the_part_of_a_ball_in_a_half_space_is_that_of_its_cap) {
  const geometry::Surface box =
      geometry::sampled(geometry::Cuboid{Vec3(1.0, 1.0, 1.0)}, {0.1, 0.1}).parts.front().surface;
  for (const double height : {-0.1, 0.0, 0.03, 0.06, 0.11}) {
    // A cap of the height h of a ball of radius r has the part h^2 (3 r - h) / (4 r^3).
    const double r = 0.1;
    const double h = std::clamp(r + height, 0.0, 2.0 * r);
    EXPECT_NEAR(share_inside(box, {Vec3(0.5, 0.5, height), r, 0}),
                h * h * (3.0 * r - h) / (4.0 * r * r * r), 0.002)  // as promised
        << height;
  }
}

TEST(Places, a_lump_outside_is_refused_with_both_boxes) {
  EXPECT_EQ(
      refusal_of(kLump + "centre = [\"70 mm\", \"30 mm\", \"15 mm\"]\n"),
      "press.toml:9:10: `[[region]]` 1 lies outside the body: it has x 65 to 75, y 25 to 35, z "
      "10 to 20 mm, the body x 0 to 60, y 0 to 60, z 0 to 30 mm, from the lowest corner of its "
      "box; change `centre` or `radius`");
  EXPECT_TRUE(refusal_of(kLump + "centre = [\"30 mm\", \"30 mm\", \"27 mm\"]\n")
                  .starts_with("press.toml:9:10: only "));
}

TEST(Places, a_slab_and_a_base_are_asked_too) {
  const std::string press =
      "[tissue]\nyoung_modulus = \"10 kPa\"\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n";
  EXPECT_NE(
      refusal_of(press + "[[region]]\nkind = \"slab\"\nbottom = \"-20 mm\"\ntop = \"-5 mm\"\n")
          .find("`[[region]]` 1 lies outside the body: it has z -20 to -5 mm, the body z 0 to 30"),
      std::string::npos);
  EXPECT_NE(refusal_of("[tissue]\nyoung_modulus = \"10 kPa\"\nbase_height = \"31 mm\"\n[[step]]\n"
                       "kind = \"indent\"\nto = \"1 mm\"\n")
                .find("the base ends at z 31 mm, but the body has z 0 to 30 mm"),
            std::string::npos);
}

}  // namespace
}  // namespace palpate::scene
