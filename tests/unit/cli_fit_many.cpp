// `palpate fit` of several curves and of specimens between platens, and `palpate data`.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "program.h"
#include "record/csv.h"

namespace palpate::test {
namespace {

// A press of E = 20 kPa, nu = 0.5, R = 5 mm, contact at 0.3 mm, force offset 0.1 N.
std::string press_curve(double young) {
  std::string text = "depth (mm),load (N)\n";
  for (int i = 0; i <= 60; ++i) {
    const double depth = 0.02 * i;
    const double h = std::max(0.0, 1e-3 * (depth - 0.3));
    const double force = 4.0 / 3.0 * young / 0.75 * std::sqrt(5e-3) * std::pow(h, 1.5) + 0.1;
    text += record::csv_text({{"a", "b"}, {{depth, force}}}).substr(4);
  }
  return text;
}

class FitMany : public testing::Test {
 protected:
  TemporaryFolder folder_;
};

TEST_F(FitMany, OneRowPerCurveAndThePopulation) {
  for (int i = 0; i < 4; ++i)
    write_file(folder_ / ("c" + std::to_string(i) + ".csv"), press_curve(20e3 + 2e3 * i));
  write_file(folder_ / "bad.csv", "depth (mm),load (N)\n1,2\n2,3\n");
  const Ended ended =
      palpate(folder_.path(), {"fit", "c0.csv", "c1.csv", "bad.csv", "c2.csv", "c3.csv", "--model",
                               "hertz", "--radius", "5 mm", "--poisson", "0.5", "--out", "all"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const record::Table rows = record::read_csv((folder_ / "all" / "curves.csv").string());
  ASSERT_EQ(rows.rows.size(), 5U);
  const auto at = [&](std::size_t row, const char* column) {
    return rows.rows[row][static_cast<std::size_t>(rows.find(column))];
  };
  EXPECT_NEAR(std::get<double>(at(1, "E_kPa")), 22.0, 1e-6);  // exact data
  EXPECT_NEAR(std::get<double>(at(4, "h_0_mm")), 0.3, 1e-6);  // likewise
  EXPECT_NEAR(std::get<double>(at(0, "F_0_N")), 0.1, 1e-9);   // likewise
  EXPECT_EQ(at(2, "status"), record::Cell("failed"));
  EXPECT_EQ(at(2, "warnings"),
            record::Cell("the model `hertz` needs at least 4 points, and 2 are usable; record more "
                         "points"));
  EXPECT_TRUE(says(ended, "4 of 5 curves are fitted")) << ended.err;
  EXPECT_TRUE(says(ended,
                   "E_kPa: median 23, quartiles 21.5 and 24.5, mean 23, standard deviation "
                   "2.582"))
      << ended.err;  // 20, 22, 24, 26
  EXPECT_TRUE(fs::exists(folder_ / "all" / "population.csv"));
  EXPECT_TRUE(fs::exists(folder_ / "all" / "population.gp"));
}

TEST_F(FitMany, SaysWhyNoneIsFittedEvenWhereItIsQuiet) {
  const Ended ended =
      palpate(folder_.path(), {"fit", "--quiet", "none.csv", "nor_this.csv", "--model", "hertz",
                               "--radius", "5 mm", "--poisson", "0.5"});
  EXPECT_EQ(ended.code, 2);
  EXPECT_EQ(ended.err,
            "palpate: 2 curves fail: cannot be read: No such file or directory; check the path\n");
}

// Force over length of a specimen of 8 mm height and 10 mm diameter, neo-Hookean with E = 9 kPa.
TEST_F(FitMany, CompressionOfASpecimen) {
  std::string text = "Compressive extension (mm),Compressive load (N)\n";
  const double area = std::acos(-1.0) / 4.0 * 1e-4;
  for (int i = 0; i <= 40; ++i) {
    const double length = 0.08 * i;
    const double stretch = 1.0 - length / 8.0;
    const double force = area * 3e3 * (1.0 / (stretch * stretch) - stretch);
    text += record::csv_text({{"a", "b"}, {{length, force}}}).substr(4);
  }
  write_file(folder_ / "c.csv", text);
  const std::vector<std::string> call{"fit",      "c.csv", "--model",    "neo_hookean",
                                      "--height", "8 mm",  "--diameter", "10 mm"};
  const Ended ended = palpate(folder_.path(), call);
  ASSERT_EQ(ended.code, 0) << ended.err;
  write_file(folder_ / "fit.csv", ended.out);
  const record::Table table = record::read_csv((folder_ / "fit.csv").string());
  EXPECT_NEAR(std::get<double>(table.rows[0][static_cast<std::size_t>(table.find("estimate"))]),
              9.0, 1e-9);  // exact data
  const Ended bare = palpate(folder_.path(), {"fit", "c.csv", "--model", "modulus"});
  EXPECT_EQ(bare.code, 2);
  EXPECT_TRUE(says(bare, "needs the specimen's height for the strain; give it as `--height"))
      << bare.err;
}

TEST_F(FitMany, DataSaysWhatIsUnderstood) {
  write_file(folder_ / "c.csv", press_curve(20e3));
  const Ended ended = palpate(folder_.path(), {"data", "c.csv"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  for (const char* line :
       {"c.csv: a table in text, 61 rows from line 2 to 62\n",
        "1  depth (mm): mm, a length, from 0 to 1.2\n",
        "contact point: 0.3 mm, if the tip is round\n", "force offset: 0.1 N\n",
        "next: palpate fit c.csv --x \"depth (mm)\" --y \"load (N)\" --model hertz --radius \"... "
        "mm\" --poisson 0.5\n"})
    EXPECT_NE(ended.out.find(line), std::string::npos) << line << "\n" << ended.out;
}

TEST_F(FitMany, DataIsJsonWithNumbers) {
  write_file(folder_ / "c.csv", press_curve(20e3));
  std::map<std::string, nlohmann::json> last;  // by event
  std::istringstream lines(palpate(folder_.path(), {"data", "c.csv", "--json"}).out);
  for (std::string line; std::getline(lines, line);) {
    const auto event = nlohmann::json::parse(line);
    last[event.at("event")] = event;
  }
  EXPECT_EQ(last["table"].at("rows"), 61);
  EXPECT_EQ(last["column"].at("number"), 2);
  EXPECT_EQ(last["column"].at("unit"), "N");
  EXPECT_EQ(last["column"].at("missing"), 0);
  EXPECT_LT(last["column"].at("low"), last["column"].at("high"));
  EXPECT_EQ(last["curve"].at("x"), "depth (mm)");
  EXPECT_NEAR(last["contact"].at("point_mm"), 0.3, 1e-6);  // exact data
  EXPECT_NEAR(last["contact"].at("offset_N"), 0.1, 1e-6);
  EXPECT_TRUE(last["next"].at("command").get<std::string>().starts_with("palpate fit c.csv"));
}

// A test to rupture is no press by a ball.
TEST_F(FitMany, DataAdvisesAModulusWhereTheSpecimenGivesWay) {
  std::string text = "Extension (mm),Load (N)\n";
  for (int i = 0; i < 80; ++i)
    text += std::to_string(0.1 * i) + "," + std::to_string(i < 60 ? 0.5 * i : 0.3) + "\n";
  write_file(folder_ / "torn.csv", text);
  const Ended ended = palpate(folder_.path(), {"data", "torn.csv"});
  EXPECT_NE(ended.out.find("20 points are excluded: beyond the largest force"), std::string::npos)
      << ended.out;
  EXPECT_NE(ended.out.find("--model modulus --height"), std::string::npos) << ended.out;
}

// Between platens the force grows as the displacement does, with or without a toe.
TEST_F(FitMany, DataAdvisesAModulusForAStraightLine) {
  for (const double toe : {0.0, 0.3}) {
    std::string text = "Extension (mm),Load (N)\n";
    for (int i = 0; i <= 80; ++i) {
      const double noise = 0.02 * std::sin(7.0 * i * i);
      text += std::to_string(0.02 * i) + "," +
              std::to_string(4.0 * std::max(0.02 * i - toe, 0.0) + noise) + "\n";
    }
    write_file(folder_ / "platens.csv", text);
    const Ended ended = palpate(folder_.path(), {"data", "platens.csv"});
    EXPECT_NE(ended.out.find("a straight line describes the curve better"), std::string::npos)
        << ended.out;
    EXPECT_NE(ended.out.find("--model modulus --height"), std::string::npos) << ended.out;
  }
  EXPECT_EQ(palpate(folder_.path(), {"data", "platens.csv", "--json"}).out.find("point_mm"),
            std::string::npos);
  write_file(folder_ / "stress.csv", "strain,stress (kPa)\n0,0\n0.1,2\n0.2,4\n0.3,6\n");
  const Ended stress = palpate(folder_.path(), {"data", "stress.csv"});
  EXPECT_NE(stress.out.find("--x-unit UNIT --model modulus"), std::string::npos) << stress.out;
  write_file(folder_ / "mass.csv", "Distance (mm),mass (g)\n0,0\n1,2\n2,4\n3,6\n");
  const Ended mass = palpate(folder_.path(), {"data", "mass.csv"});
  EXPECT_NE(mass.out.find("--y-unit gf --model hertz"), std::string::npos) << mass.out;
}

// A specimen of 10 mm that is compressed by half has P = E/3 (L^-2 - L); a ball has h^(3/2).
TEST_F(FitMany, DataTellsACompressedSpecimenFromABall) {
  const auto said = [&](const std::string& head, bool specimen, double height) {
    std::string text = head + "\n";
    for (int i = 0; i <= 120; ++i) {
      const double strain = 0.5 * i / 120;
      const double left = 1.0 - strain;
      const double load = specimen ? 1.0 / (left * left) - left : 6.0 * std::pow(strain, 1.5);
      text += std::to_string(height * strain) + "," +
              std::to_string(load + 0.01 * std::sin(7.0 * i * i)) + "\n";
    }
    write_file(folder_ / "c.csv", text);
    return palpate(folder_.path(), {"data", "c.csv"}).out;
  };
  std::string out = said("Extension (mm),Load (N)", true, 10.0);
  EXPECT_NE(out.find("--model neo_hookean --loading compression --height"), std::string::npos)
      << out;
  out = said("Extension (mm),Load (N)", false, 10.0);
  EXPECT_NE(out.find("--model hertz --radius"), std::string::npos) << out;
  out = said("strain (1),stress (kPa)", true, 1.0);
  EXPECT_NE(out.find("`--model ogden --loading compression`"), std::string::npos) << out;
}

}  // namespace
}  // namespace palpate::test
