// What the first lines of a page say of a case.
#include <gtest/gtest.h>

#include "base/text.h"
#include "scenario/tested.h"
#include "scenario_text.h"

namespace palpate::scenario {
namespace {

std::string words_of_case(const std::string& text, const std::vector<std::string>& varied = {},
                          const Touched& touched = {}) {
  return joined(tested(read_case(text), varied, touched), "; ");
}

TEST(Tested, SaysTissueShapeRegionsAndTheLoadingHistory) {
  EXPECT_EQ(words_of_case(press),
            "Tissue: skin, E 72.4 kPa, nu 0.33; block of 60 x 60 x 30 mm; pressed 2 mm by a sphere "
            "of radius 11 mm");
  EXPECT_EQ(
      words_of_case(press +
                    "[[step]]\nkind = \"hold\"\ntime = \"0.3 s\"\n[[step]]\nkind = \"slide\"\nby = "
                    "\"6 mm\"\n[[step]]\nkind = \"retract\"\nto = \"-1 mm\"\n[tissue]\nviscosity = "
                    "\"none\"\nshape = { kind = \"half_space\" }\n[finger]\nradius = \"5 mm\"\n"),
      "Tissue: skin, E 72.4 kPa, nu 0.33, elastic; half-space; pressed 2 mm by a sphere of "
      "radius 5 mm, then held for 0.3 s, then slid by 6 mm, then withdrawn to -1 mm");
  EXPECT_EQ(
      words_of_case("[[step]]\nkind = \"indent\"\nto = \"0.5 N\"\n[[region]]\nkind = \"sphere\"\n"
                    "centre = [\"30 mm\", \"30 mm\", \"15 mm\"]\nradius = \"8 mm\"\nmaterial = "
                    "\"muscle\"\n"),
      "Tissue: skin, E 72.4 kPa, nu 0.33; block of 60 x 60 x 30 mm; region 1: muscle, E 6 "
      "kPa; pressed to 0.5 N by a sphere of radius 11 mm");
  EXPECT_EQ(words_of_case(creep),
            "Tissue: skin, E 72.4 kPa, nu 0.33; block of 60 x 60 x 30 mm; creep under 1 kPa for 1 "
            "s, then recovery for 1 s");
}

TEST(Tested, DoesNotSayWhatVaries) {
  EXPECT_EQ(words_of_case(press, {"tissue.young_modulus", "step.1.to"}),
            "Tissue: skin, nu 0.33; block of 60 x 60 x 30 mm; pressed by a sphere of radius 11 mm");
  EXPECT_EQ(words_of_case(press, {"tissue.material", "tissue.shape", "finger.radius"}),
            "pressed 2 mm");
  EXPECT_EQ(words_of_case(press, {"tissue.shape.size.3", "finger"}),
            "Tissue: skin, E 72.4 kPa, nu 0.33; pressed 2 mm");
}

TEST(Tested, TakesTheDepthOfARunThatPressedOnce) {
  const Touched touched{.depth = "1.5 mm", .place = " at x 30 mm"};
  EXPECT_EQ(words_of_case(press, {"tissue"}, touched),
            "pressed 1.5 mm by a sphere of radius 11 mm at x 30 mm");
  EXPECT_EQ(
      words_of_case(press + "[[step]]\nkind = \"indent\"\nto = \"3 mm\"\n", {"tissue"}, touched),
      "pressed 2 mm by a sphere of radius 11 mm at x 30 mm, then pressed 3 mm");
}

}  // namespace
}  // namespace palpate::scenario
