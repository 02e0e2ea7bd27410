// Where the finger presses, its spheres, local curvature, rings and slides: read, refused, echoed.
#include "scenario_text.h"

namespace palpate::scenario {
namespace {

// The echo of a text reads back to itself, and holds every line that is wanted.
void expect_echo(const std::string& text, const std::vector<std::string>& lines) {
  const std::string written = echo(parse(text, "press.toml", {}));
  EXPECT_EQ(echo(parse(written, "press.toml", {})), written) << text;
  for (const std::string& line : lines)
    EXPECT_NE(written.find(line), std::string::npos) << line << "\n" << written;
}

TEST(LocalContact, HasDefaults) {
  const Scenario scenario = read_one(press + "[[step]]\nkind = \"slide\"\n");
  EXPECT_FALSE(scenario.finger.x || scenario.finger.y);
  EXPECT_EQ(scenario.finger.spheres, 1);
  EXPECT_EQ(scenario.finger.calibration, finger::Calibration::force);
  EXPECT_EQ(scenario.contact.law, contact::CurvatureLaw::elliptic);
  EXPECT_EQ(scenario.contact.curvature, geometry::CurvatureMethod::quadric);
  EXPECT_EQ(scenario.contact.curvature_on, Contact::CurvatureOn::rest);
  EXPECT_EQ(scenario.contact.curvature_rings, 2);
  EXPECT_FALSE(scenario.solver.rings);
  const auto& slide = std::get<Slide>(scenario.steps[1]);
  EXPECT_EQ(slide.by, 0.010);
  EXPECT_EQ(slide.rate, 0.005);
  EXPECT_EQ(slide.direction, 0.0);
  EXPECT_EQ(slide.keep, Slide::Keep::displacement);
}

TEST(LocalContact, IsReadAndEchoed) {
  const std::string text =
      press +
      "[[step]]\nkind = \"slide\"\nby = \"7 mm\"\nrate = \"1 cm/s\"\ndirection = -90\nkeep "
      "= \"force\"\n"
      "[finger]\nspheres = 8\ncalibration = \"mass\"\nx = \"12 mm\"\ny = \"auto\"\n"
      "[contact]\nlaw = \"mean\"\ncurvature = \"taubin\"\ncurvature_on = "
      "\"deformed\"\ncurvature_rings = 3\n[solver]\nrings = 4\n";
  const Scenario scenario = read_one(text);
  EXPECT_EQ(scenario.finger.x, 0.012);
  EXPECT_FALSE(scenario.finger.y);
  EXPECT_EQ(scenario.finger.spheres, 8);
  EXPECT_EQ(scenario.finger.calibration, finger::Calibration::mass);
  EXPECT_EQ(scenario.contact.law, contact::CurvatureLaw::mean);
  EXPECT_EQ(scenario.contact.curvature, geometry::CurvatureMethod::taubin);
  EXPECT_EQ(scenario.contact.curvature_on, Contact::CurvatureOn::deformed);
  EXPECT_EQ(scenario.contact.curvature_rings, 3);
  EXPECT_EQ(scenario.solver.rings, 4);
  const auto& slide = std::get<Slide>(scenario.steps[1]);
  EXPECT_EQ(slide.by, 0.007);
  EXPECT_EQ(slide.rate, 0.01);
  EXPECT_EQ(slide.direction, -90.0);
  EXPECT_EQ(slide.keep, Slide::Keep::force);
  expect_echo(text, {"x = \"12 mm\"", "y = \"auto\"", "spheres = 8", "calibration = \"mass\"",
                     "law = \"mean\"", "curvature = \"taubin\"", "curvature_on = \"deformed\"",
                     "curvature_rings = 3", "rings = 4", "by = \"7 mm\"", "direction = -90",
                     "keep = \"force\""});
}

TEST(LocalContact, HasRanges) {
  const std::string range = "`; give a value in that range";
  expect_refused({
      {"[finger]\nspheres = 0\n",
       "press.toml:5:11: `spheres` must be at least 1 and at most 64, got `0" + range},
      {"[contact]\ncurvature_rings = 9\n",
       "press.toml:5:19: `curvature_rings` must be at least 1 and at most 8, got `9" + range},
      {"[solver]\nrings = 0\n",
       "press.toml:5:9: `rings` must be at least 1 and at most 1000, got `0" + range},
      {"[finger]\nx = \"middle\"\n",
       "press.toml:5:5: `x` wants `auto` or a length, got `middle`; write `auto`"},
      {"[finger]\ny = \"3 kPa\"\n",
       "press.toml:5:5: `y` wants a length, got `3 kPa`, a pressure; write it as `3 mm`"},
      {"[contact]\nlaw = \"circle\"\n",
       "press.toml:5:7: `law` does not know `circle`; it is one of elliptic, geometric, mean"},
      {"[[step]]\nkind = \"slide\"\ndirection = 400\n",
       "press.toml:6:13: `direction` must be at least -360 and at most 360, got `400" + range},
      {"[[step]]\nkind = \"slide\"\nby = \"-1 mm\"\n",
       "press.toml:6:6: `by` must be above 0 mm, got `-1 mm" + range},
      {"[[step]]\nkind = \"slide\"\nkeep = \"depth\"\n",
       "press.toml:6:8: `keep` does not know `depth`; it is one of displacement, force"},
  });
}

TEST(LocalContact, SlidesKeepAForceThatIsThere) {
  const std::string slide = "[[step]]\nkind = \"slide\"\nkeep = \"force\"\n";
  const std::string away = "[[step]]\nkind = \"retract\"\nto = \"-1 mm\"\n";
  const std::string sentence =
      "`slide` has no force to keep, for the finger does not press yet; put an `indent` before it, "
      "or write `keep = \"displacement\"`";
  EXPECT_EQ(refusal(press + slide), "accepted");
  EXPECT_EQ(refusal("[[step]]\nto = \"1 N\"\n" + slide), "accepted");
  EXPECT_EQ(refusal(slide + press), "press.toml:3:8: " + sentence);
  EXPECT_EQ(refusal(press + away + slide), "press.toml:9:8: " + sentence);
  EXPECT_EQ(refusal(press + away + "[[step]]\nkind = \"slide\"\n"), "accepted")
      << "on the way to another place";
}

TEST(LocalContact, IsLeftUnreadWithANoteWhereNothingUsesIt) {
  const std::string mesh =
      "` is left unread: it is used only with `solver.model = "
      "\"mass_spring\"` or `\"coupled_springs\"`\n";
  EXPECT_EQ(notes(press + "[solver]\nmodel = \"hertz\"\nrings = 3\n[contact]\ncurvature = "
                          "\"taubin\"\ncurvature_on = \"deformed\"\ncurvature_rings = 3\n"
                          "[tissue]\nbase_height = \"1 mm\"\n[output]\ntissue = true\n"),
            "press.toml:12:1: `base_height" + mesh + "press.toml:8:1: `curvature" + mesh +
                "press.toml:9:1: `curvature_on" + mesh + "press.toml:10:1: `curvature_rings" +
                mesh + "press.toml:6:1: `rings" + mesh + "press.toml:14:1: `tissue" + mesh);
  EXPECT_EQ(notes(press + "[solver]\nmodel = \"solid\"\n[tissue]\nbase_height = \"1 mm\"\n"), "")
      << "the base of a solid is where it is said";
  const std::string finger =
      "` is left unread: it is used only by steps with a finger (indent, hold, retract, slide)\n";
  EXPECT_EQ(notes(creep + "[solver]\nrings = 3\n[output]\ntissue = true\npicture = "
                          "true\npressure_maps = false\n"),
            "press.toml:5:1: `rings" + finger + "press.toml:9:1: `pressure_maps" + finger +
                "press.toml:7:1: `tissue" + finger);
  // What a specimen rests on is physics.
  expect_refused({{"[tissue]\nbase_height = \"1 mm\"\n",
                   "press.toml:5:1: `base_height` has no effect here: it is used only by steps "
                   "with a finger (indent, hold, retract, slide); remove it or change that"}},
                 creep);
  EXPECT_EQ(notes(press + "[finger]\ncalibration = \"mass\"\n"),
            "press.toml:5:1: `calibration` is left unread: it is used only with more than one of "
            "`spheres`\n");
}

}  // namespace
}  // namespace palpate::scenario
