// report.html of every kind in a real browser: read, reached and seen.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "browser.h"
#include "sweep_program.h"

namespace palpate::test {
namespace {

const std::string titled_press =
    "title = \"A <press> & 'more'\"\n[tissue]\nshape = { kind = \"cuboid\", size = [\"40 mm\", "
    "\"40 "
    "mm\", \"20 mm\"] }\nmesh = { kind = \"kuhn\", cells = [3, 3, 2] }\n[solver]\nmodel = "
    "\"mass_spring\"\nintegrator = \"quasi_static\"\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n"
    "[[step]]\nkind = \"hold\"\ntime = \"50 ms\"\n[output]\ninterval = \"20 ms\"\n"
    "regression = \"power\"\n";
const std::string short_creep =
    "[tissue]\nmesh = { kind = \"kuhn\", cells = [2, 2, 2] }\nviscosity = \"kelvin_voigt\"\n"
    "[solver]\nmodel = \"mass_spring\"\n[[step]]\nkind = \"creep\"\nload_time = \"0.1 s\"\n"
    "recovery_time = \"0.1 s\"\n[output]\ninterval = \"10 ms\"\n";

// 4/3 E / (1 - nu^2) sqrt(R) h^(3/2) of 60 kPa, 0.45 and 11 mm, in mm and mN, with a ripple.
std::string rippled_measurement() {
  std::string text = "Displacement (mm);Load (mN)\n";
  for (int i = 0; i <= 40; ++i) {
    const double h = 0.05e-3 * i;
    const double force =
        4.0 / 3.0 * 60e3 / (1.0 - 0.45 * 0.45) * std::sqrt(0.011) * h * std::sqrt(h);
    text +=
        std::to_string(1e3 * h) + ";" + std::to_string(1e3 * force + (i % 2 == 0 ? 2 : -2)) + "\n";
  }
  return text;
}

class ReportPages : public SweepProgram {
 protected:
  void make(const std::vector<std::string>& arguments) const {
    const Ended ended = palpate(folder_.path(), arguments);
    ASSERT_EQ(ended.code, 0) << ended.err;
  }
};

TEST_F(ReportPages, OpenWithoutAFault) {
  write_file(folder_ / "press.toml", titled_press);
  write_file(folder_ / "creep.toml", short_creep);
  write_file(folder_ / "found.toml",
             "[tissue]\nshape = { kind = \"half_space\" }\n[finger]\nmaterial = \"rigid\"\n"
             "[[step]]\nkind = \"indent\"\nto = \"2 mm\"\n[output]\ninterval = \"10 ms\"\n");
  write_file(folder_ / "measured.csv", rippled_measurement());
  make({"run", "press.toml", "creep.toml"});
  make({"identify", "measured.csv", "found.toml", "--unknown", "tissue.young_modulus=1..500 kPa"});
  plan(quick_sweep);
  ASSERT_EQ(sweep({"run", "out/s_sweep"}).code, 0);
  ASSERT_EQ(sweep({"merge", "out/s_sweep"}).code, 0);
  make({"compare", "out/press", "out/press", "--report", "out/compared/report.html"});
  write_file(
      folder_ / "slide.toml",
      "[tissue]\n[[region]]\nkind = \"sphere\"\ncentre = [\"30 mm\", \"30 mm\", \"20 mm\"]\n"
      "radius = \"5 mm\"\nmaterial = \"muscle\"\n[contact]\nfriction = 0.3\n"
      "[finger]\nx = \"20 mm\"\n[solver]\nmodel = \"mass_spring\"\n"
      "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n[[step]]\nkind = \"slide\"\nby = \"6 mm\"\n"
      "[[step]]\nkind = \"slide\"\nby = \"6 mm\"\n[output]\ninterval = \"100 ms\"\n[sweep]\n"
      "\"finger.spheres\" = [1, 8]\n");
  make({"run", "slide.toml"});
  make({"chart", "--frames", "5", "--report", "out/frames/report.html"});
  make({"open", "out"});
  const std::vector<std::string> pages{"out/press/report.html",
                                       "out/creep/report.html",
                                       "out/found_identified/report.html",
                                       "out/s_sweep/merged/report.html",
                                       "out/compared/report.html",
                                       "out/slide/report.html",
                                       "out/frames/report.html",
                                       "out/index.html"};
  for (const Scheme scheme : {Scheme::light, Scheme::dark})
    EXPECT_EQ(faults_of_pages(folder_.path(), pages, scheme), std::vector<std::string>{});
}

TEST_F(ReportPages, TheInspectorFindsFaults) {
  write_file(
      folder_ / "bad.html",
      "<!DOCTYPE html><html lang=en><body><h1 id=a>x</h1><main id=a style=\"color:#aaaaaa;"
      "background:#ffffff\">pale 7 mm<p class=result style=\"height:901px\"></p><a "
      "href=\"#b\">b</a><a href=c.csv>c</a><img src=d.png>"
      "<div style=\"width:500px\">wide</div><div class=wide style=\"width:20px;overflow:auto\">"
      "abcdefghijkl</div><div class=plot><svg aria-label=x><path d=\"M0 0L9 9\" "
      "stroke=\"#b4b4b4\"/><text y=9>under</text><text y=9>over</text></svg></div>"
      "<table><caption>hash</caption><tr><td>"
      "0123456789012345678901234567890123456789012345678901234567890123456789"
      "0123456789012345678901234567890123456789</td></tr></table></main><script>nothing()</"
      "script></body></html>");
  const auto faults = faults_of_pages(folder_.path(), {"bad.html"}, Scheme::light);
  for (const char* fault :
       {"CONSOLE", "id a twice", "no place #b", "c.csv", "loads d.png", "without words", "px wide",
        "contrast of 2.32", "cut at 390", "with 2.07 to 1", "is cut on paper: hash",
        "has over over under in a figure at 360", "has its result beyond the first screen",
        "may part a number from its unit in 7 mm"})
    EXPECT_TRUE(std::any_of(faults.begin(), faults.end(), [&](const auto& one) {
      return one.find(fault) != std::string::npos;
    })) << fault;
}

TEST_F(ReportPages, AreLightOrDarkAsTheReaderLikes) {
  write_file(folder_ / "press.toml", titled_press);
  make({"run", "press.toml"});
  const auto mean = [&](Scheme scheme) {
    const std::vector<double> all = lightness(folder_ / "out/press/report.html", scheme);
    EXPECT_EQ(all.size(), 12U * 16U);
    return std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
  };
  // The grounds are 255 and 23 of 255; text and curves cover less than a tenth, the cards are near
  // the ground. A figure that stayed white in the dark would raise its mean above 60.
  EXPECT_GT(mean(Scheme::light), 225.0);
  EXPECT_LT(mean(Scheme::dark), 60.0);
}

TEST_F(ReportPages, TheSameTwice) {
  write_file(folder_ / "press.toml", titled_press);
  make({"run", "press.toml"});
  const std::string first = read_file(folder_ / "out/press/report.html");
  make({"run", "press.toml", "--force"});
  EXPECT_TRUE(read_file(folder_ / "out/press/report.html") == first);
  EXPECT_EQ(first.find("A <press>"), std::string::npos) << "the title is not escaped";
  make({"run", "press.toml", "--force", "--set", "output.report=false"});
  EXPECT_FALSE(fs::exists(folder_ / "out/press/report.html"));
}

}  // namespace
}  // namespace palpate::test
