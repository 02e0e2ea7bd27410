// Every figure of the paper and of a run can be read: no texts that overlap or are clipped, a plot
// that is not crushed by its legend, and no curve on the axis.
#include <gtest/gtest.h>

#include "program.h"
#include "svg_text.h"

namespace palpate::test {
namespace {

// What a reader of the figure would complain about.
std::vector<std::string> complaints(const fs::path& figure) {
  const SvgPicture picture(read_file(figure));
  std::vector<std::string> all = picture.faults();
  if (picture.frame.width() < 0.55 * picture.width)
    all.push_back("the plot is " + std::to_string(static_cast<int>(picture.frame.width())) +
                  " px wide");
  // A curve of less than a thirtieth of the height cannot be told from the axis that it touches.
  for (const Box& curve : picture.curves)
    if (curve.height() < picture.frame.height() / 30.0 &&
        curve.bottom > picture.frame.bottom - picture.frame.height() / 30.0)
      all.push_back("a curve lies on the axis");
  return all;
}

class Figures : public testing::Test {
 protected:
  // Runs a scenario and returns its figures.
  [[nodiscard]] std::vector<fs::path> figures(const std::string& scenario,
                                              const std::vector<std::string>& more = {}) const {
    const Ended ended = palpate(folder_.path(), {"run", scenario, "--out", "out"}, more);
    EXPECT_EQ(ended.code, 0) << ended.err;
    std::vector<fs::path> found;
    for (const auto& entry :
         fs::directory_iterator(folder_ / "out" / fs::path(scenario).stem().string()))
      if (entry.path().extension() == ".svg") found.push_back(entry.path());
    return found;
  }
  void expect_readable(const std::vector<fs::path>& all, std::size_t count) const {
    EXPECT_EQ(all.size(), count);
    for (const fs::path& figure : all) {
      std::vector<std::string> found = complaints(figure);
      // Of decades the soft tissues lie on the linear axis; logarithmic ones beside it show them.
      if (fs::exists(figure.parent_path() / (figure.stem().string() + "_decades.svg")))
        std::erase(found, "a curve lies on the axis");
      EXPECT_EQ(found, std::vector<std::string>{}) << figure;
    }
  }
  TemporaryFolder folder_;
};

TEST_F(Figures, FiveTissuesOnOnePlot) {
  expect_readable(figures(project_file("scenarios/figure6_force_indentation.toml"),
                          {"--set", "output.interval=20 ms"}),
                  2);
  const std::string svg =
      read_file(folder_ / "out/figure6_force_indentation/figure_force_indentation.svg");
  EXPECT_NE(svg.find(">a + b ln h, R² "), std::string::npos) << "the regression of the paper";
}

TEST_F(Figures, TwentyEightCasesAreColours) {
  const auto all = figures(project_file("scenarios/figure6_local_geometry.toml"));
  expect_readable(all, 3);
  const std::string svg =
      read_file(folder_ / "out/figure6_local_geometry/figure_force_indentation.svg");
  EXPECT_NE(svg.find(">Shape curvature (1/m)<"), std::string::npos) << "the colour bar";
  EXPECT_EQ(svg.find("ln h"), std::string::npos) << "no regression that nobody asked for";
}

TEST_F(Figures, StrainsOfFigureSeven) {
  expect_readable(figures(project_file("scenarios/figure7_muscle_leg.toml")), 1);
}

TEST_F(Figures, LongNamesStandBelow) {
  write_file(folder_ / "long.toml",
             "[tissue]\nshape = { kind = \"half_space\" }\n[[step]]\nkind = \"indent\"\nto = \"1 "
             "mm\"\n[[step]]\nkind = \"hold\"\n[output]\ninterval = \"50 ms\"\npng = "
             "true\npressure_maps = false\nreport = false\n[sweep]\n"
             "\"tissue.young_modulus\" = [\"1.23456789 kPa\", \"1234.56789 kPa\"]\n"
             "\"tissue.poisson_ratio\" = [0.333333333, 0.444444444]\n");
  expect_readable(figures("long.toml"), 2);  // force over indentation, and over time in the hold
  EXPECT_TRUE(fs::exists(folder_ / "out/long/figure_force_time.png"));
}

// The reader itself, on a picture with every fault.
TEST(SvgText, SeesWhatOverlapsAndWhatIsClipped) {
  const auto at = [](const std::string& place, const std::string& anchor,
                     const std::string& words) {
    return "<g transform=\"translate(" + place +
           ")\" fill=\"black\" font-size=\"15.00\"  "
           "text-anchor=\"" +
           anchor + "\">\n\t\t<text>" + words + "</text>\n</g>\n";
  };
  const std::string head = "<svg viewBox=\"0 0 820 500\">\n";
  EXPECT_TRUE(SvgPicture(head + at("100.0,50.0", "start", "skin") +
                         at("100.0,70.0", "start", "bone") + at("20.0,250.0", "end", "1"))
                  .faults()
                  .empty());
  EXPECT_EQ(SvgPicture(head + at("100.0,50.0", "start", "skin") +
                       at("110.0,55.0", "middle", "bone") + at("815.0,90.0", "start", "1e+06"))
                .faults(),
            (std::vector<std::string>{"`skin` and `bone` overlap", "`1e+06` is clipped",
                                      "`1e+06` is a number for machines"}));
  EXPECT_EQ(SvgPicture(head + at("10.0,20.0) rotate(-90.00", "middle", "Force F (N)")).faults(),
            std::vector<std::string>{"`Force F (N)` is clipped"});
}

}  // namespace
}  // namespace palpate::test
