// `palpate identify` as a program: its streams, its folder, its refusals.
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "program.h"
#include "record/csv.h"
#include "svg_text.h"

namespace palpate::test {
namespace {

const std::string scenario =
    "[tissue]\nshape = { kind = \"half_space\" }\npoisson_ratio = 0.45\n[finger]\nmaterial = "
    "\"rigid\"\n[contact]\ndepth = \"hertz\"\n[[step]]\nkind = \"indent\"\nto = \"2 mm\"\nrate = "
    "\"5 mm/s\"\n[output]\ninterval "
    "= \"10 ms\"\nfigures = false\nfits = false\npressure_maps = false\n";

// 4/3 E / (1 - nu^2) sqrt(R) h^(3/2) of 60 kPa, 0.45 and 11 mm, in mm and mN, with a ripple.
std::string measurement() {
  std::string text = "Displacement (mm);Load (mN)\n";
  for (int i = 0; i <= 40; ++i) {
    const double h = 0.05e-3 * i;
    const double force =
        4.0 / 3.0 * 60e3 / (1.0 - 0.45 * 0.45) * std::sqrt(0.011) * h * std::sqrt(h);
    text += std::to_string(1e3 * h) + ";" +
            std::to_string(1e3 * force + (i % 2 == 0 ? 2.0 : -2.0)) + "\n";
  }
  return text;
}

class IdentifyVerb : public testing::Test {
 protected:
  IdentifyVerb() {
    write_file(folder_ / "press.toml", scenario);
    write_file(folder_ / "measured.csv", measurement());
  }
  [[nodiscard]] Ended identify(const std::vector<std::string>& more) const {
    return palpate(folder_.path(), {"identify", "measured.csv", "press.toml"}, more);
  }
  TemporaryFolder folder_;
};

TEST_F(IdentifyVerb, ReadsTheCurveOfARunAsItIs) {
  ASSERT_EQ(palpate(folder_.path(), {"run", "press.toml", "--out", "ran"}).code, 0);
  const Ended done =
      palpate(folder_.path(), {"identify", "ran/press/force_indentation.csv", "press.toml",
                               "--unknown", "tissue.young_modulus=1..500 kPa"});
  ASSERT_EQ(done.code, 0) << done.err;
  const record::Table table =
      record::read_csv((folder_ / "out/press_identified/identified.csv").string());
  const auto estimate = static_cast<std::size_t>(table.find("estimate"));
  EXPECT_NEAR(std::get<double>(table.rows.at(0)[estimate]), 72.4,
              1e-6);  // skin, which `press.toml` has
  // Nothing is left of which the figure of a profile could tell.
  EXPECT_TRUE(std::filesystem::exists(folder_ / "out/press_identified/profile.csv"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/press_identified/profile.svg"));
}

TEST_F(IdentifyVerb, SaysThatTheFilesAreInTheWrongOrder) {
  const Ended done = palpate(folder_.path(), {"identify", "press.toml", "measured.csv", "--unknown",
                                              "tissue.young_modulus=1..500 kPa"});
  EXPECT_EQ(done.code, 2);
  EXPECT_EQ(done.err,
            "press.toml: is a scenario, and the measurement comes first; write `palpate identify "
            "measured.csv press.toml`\n");
}

TEST_F(IdentifyVerb, WritesAFolderWhoseScenarioRepeatsTheCurve) {
  const auto done = identify({"--unknown", "tissue.young_modulus=1..500 kPa"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_NE(done.out.find("tissue.young_modulus"), std::string::npos);
  EXPECT_NE(done.out.find("by `hertz`"), std::string::npos);
  EXPECT_NE(done.out.find("A contact point 0.05 mm earlier or later"), std::string::npos);
  EXPECT_TRUE(std::regex_search(
      done.out, std::regex("later changes `tissue.young_modulus` by -[1-9](\\.[0-9])? % or \\+")))
      << "two digits: " << done.out;
  const auto result = folder_ / "out/press_identified";
  const record::Table table = record::read_csv((result / "identified.csv").string());
  ASSERT_EQ(table.rows.size(), 1U);
  const double estimate =
      std::get<double>(table.rows[0][static_cast<std::size_t>(table.find("estimate"))]);
  EXPECT_NEAR(estimate, 60.0, 0.5);  // a ripple of 2 of 400 mN
  for (const char* name : {"residuals.csv", "profile.csv", "correlation.csv", "curve.gp",
                           "profile.gp", "scenario.toml", "run.json"})
    EXPECT_TRUE(std::filesystem::exists(result / name)) << name;

  for (const char* name : {"curve.svg", "profile.svg"})
    EXPECT_EQ(SvgPicture(read_file(result / name)).faults(), std::vector<std::string>{}) << name;
  EXPECT_NE(read_file(result / "curve.svg").find(">Measured - model ("), std::string::npos)
      << "gnuplot omits a label that has no place";

  EXPECT_NE(read_file(result / "report.html").find("Young&#39;s modulus "), std::string::npos);
  EXPECT_NE(read_page(result / "report.html").find("<p>Tissue: skin, nu 0.45; "),
            std::string::npos);
  EXPECT_NE(read_file(result / "report.html")
                .find("palpate identify measured.csv press.toml --unknown &#39;tissue.young_modulus"
                      "=1..500 kPa&#39;<"),
            std::string::npos);
  write_file(folder_ / "again.toml", read_file(result / "scenario.toml"));
  const auto run = palpate(folder_.path(), {"run", "again.toml"});
  ASSERT_EQ(run.code, 0) << run.err;
  const record::Table rows =
      record::read_csv((folder_ / "out/again/force_indentation.csv").string());
  const record::Table fitted = record::read_csv((result / "residuals.csv").string());
  const auto number = [](const record::Table& of, std::size_t row, const char* name) {
    return std::get<double>(of.rows[row][static_cast<std::size_t>(of.find(name))]);
  };
  ASSERT_EQ(rows.rows.size(), fitted.rows.size());
  for (std::size_t i = 0; i < rows.rows.size(); ++i)
    EXPECT_NEAR(number(rows, i, "force_N"), number(fitted, i, "model_N"),
                1e-6);  // six decimals of x
}

// One press knows E / (1 - nu^2) alone. Shell, JSON, table and page agree that E and nu have no
// numbers, and the exit code says that something asked for is missing.
TEST_F(IdentifyVerb, InseparableUnknownsAreNoSuccess) {
  const std::vector<std::string> words{"--unknown", "tissue.young_modulus=1..500 kPa", "--unknown",
                                       "tissue.poisson_ratio=0.2..0.49"};
  const Ended done = identify(words);
  EXPECT_EQ(done.code, 7) << done.err;
  EXPECT_NE(done.err.find("`tissue.young_modulus` and `tissue.poisson_ratio` have no numbers"),
            std::string::npos)
      << done.err;
  EXPECT_NE(done.out.find("tissue.young_modulus  not determined by itself\n"), std::string::npos);
  EXPECT_NE(done.out.find("tissue.poisson_ratio  not determined by itself\n"), std::string::npos);
  EXPECT_NE(done.out.find("tissue.young_modulus / (1 - tissue.poisson_ratio^2) = 75.2"),
            std::string::npos)
      << done.out;  // 60 / (1 - 0.45^2) = 75.24
  const auto result = folder_ / "out/press_identified";
  const record::Table table = record::read_csv((result / "identified.csv").string());
  ASSERT_EQ(table.rows.size(), 3U);
  for (const char* column : {"estimate", "std_error", "ci95_low", "ci95_high", "profile_low"})
    for (std::size_t row = 0; row < 2; ++row)
      EXPECT_FALSE(std::holds_alternative<double>(
          table.rows[row][static_cast<std::size_t>(table.find(column))]))
          << column;
  EXPECT_NE(read_file(result / "report.html").find("have no numbers"), std::string::npos);
  EXPECT_TRUE(headline_of(result / "report.html")
                  .starts_with("tissue.young_modulus / (1 - tissue.poisson_ratio^2) = "
                               "75.2"))
      << headline_of(result / "report.html");
  std::vector<std::string> machine = words;
  machine.insert(machine.end(), {"--json", "--force"});
  const Ended json = identify(machine);
  EXPECT_EQ(json.code, 7);
  EXPECT_NE(
      json.out.find("\"unknown\":\"tissue.young_modulus\",\"unit\":\"kPa\",\"estimate\":null"),
      std::string::npos)
      << json.out;
}

TEST_F(IdentifyVerb, DoesNotReplaceUnasked) {
  const std::vector<std::string> words{"--unknown", "tissue.young_modulus=1..500 kPa"};
  ASSERT_EQ(identify(words).code, 0);
  const auto other = identify({"--unknown", "tissue.young_modulus=1..400 kPa"});
  EXPECT_EQ(other.code, 2);
  EXPECT_NE(other.err.find("holds a finished identification"), std::string::npos);
  EXPECT_EQ(identify({"--unknown", "tissue.young_modulus=1..500 kPa", "--force"}).code, 0);
  EXPECT_EQ(identify(words).code, 0) << "the same call as the first";
}

// Two levels and a step at 12 s of the machine's clock: sigma = 0.02 E (1 + e^(-t/0.5 s)) of 8 kPa.
TEST_F(IdentifyVerb, FindsTheStepOfARelaxation) {
  write_file(
      folder_ / "relax.toml",
      "[tissue]\nyoung_modulus = \"20 kPa\"\nshape = { kind = \"cuboid\", size = [\"30 mm\", "
      "\"30 mm\", \"30 mm\"] }\nviscosity = \"standard_linear_solid\"\nrelaxation_time = \"1 s\"\n"
      "instantaneous_ratio = 2\n[[step]]\nkind = \"relax\"\nstrain = 0.02\ntime = \"1.5 s\"\n");
  std::string text = "Time (s),Stress (Pa)\n";
  for (int i = 0; i < 120; ++i) {
    const double t = 0.025 * (i - 60);
    text += std::to_string(12.0 + t) + "," +
            std::to_string((t < 0.0 ? 0.0 : 160.0 * (1.0 + std::exp(-t / 0.5))) +
                           (i % 2 == 0 ? 1.0 : -1.0)) +
            "\n";
  }
  write_file(folder_ / "relax.csv", text);
  const Ended done = palpate(folder_.path(), {"identify", "relax.csv", "relax.toml", "--unknown",
                                              "tissue.young_modulus=1..100 kPa", "--unknown",
                                              "tissue.relaxation_time=0.05..5 s"});
  ASSERT_EQ(done.code, 0) << done.err;
  EXPECT_NE(done.err.find("note: the step is taken at 12, where the curve is largest"),
            std::string::npos)
      << done.err;
  const record::Table table =
      record::read_csv((folder_ / "out/relax_identified/identified.csv").string());
  const auto estimate = static_cast<std::size_t>(table.find("estimate"));
  EXPECT_NEAR(std::get<double>(table.rows.at(0)[estimate]), 8.0, 0.03);  // of the ripple
  EXPECT_NEAR(std::get<double>(table.rows.at(1)[estimate]), 0.5, 0.01);
}

TEST_F(IdentifyVerb, RefusesInSentences) {
  const auto nothing = identify({"--unknown", "contact.friction=0.1..1"});
  EXPECT_EQ(nothing.code, 2);
  EXPECT_NE(nothing.err.find("changes nothing in what `hertz` computes"), std::string::npos);
  EXPECT_EQ(nothing.err.find("note: "), std::string::npos) << nothing.err;
  const auto typo = identify({"--unknown", "tissue.young_modulos=1..2 kPa"});
  EXPECT_EQ(typo.code, 2);
  EXPECT_NE(typo.err.find("did you mean `tissue.young_modulus`?"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out/press_identified"));
}

// P = E/3 (L^-2 - L) of an incompressible block, in the ways in which laboratories write its
// compression.
TEST_F(IdentifyVerb, CompressionIsNegativeInManyFiles) {
  write_file(folder_ / "compress.toml",
             "[tissue]\npoisson_ratio = 0.4999\nviscosity = \"none\"\nbase = \"frictionless\"\n"
             "shape = { kind = \"cuboid\", size = [\"20 mm\", \"20 mm\", \"10 mm\"] }\n"
             "[[step]]\nkind = \"compress\"\nstrain = 0.02\nrate = \"0.01 1/s\"\n");
  const auto identified = [&](const std::string& head, double from, double to, double shift) {
    std::string text = head + "\n";
    for (int i = 0; i <= 80; ++i) {
      const double strain = from + (to - from) * i / 80.0;
      text += number_text(strain + shift) + "," +
              number_text(12.0 * strain + (i % 2 == 0 ? 1e-3 : -1e-3)) + "\n";
    }
    write_file(folder_ / "negative.csv", text);
    return palpate(folder_.path(), {"identify", "negative.csv", "compress.toml", "--force",
                                    "--unknown", "tissue.young_modulus=1..100 kPa"});
  };
  const std::string strain = "strain (-),stress (kPa)", stretch = "stretch,stress (kPa)";
  for (const Ended& done :
       {identified(strain, 0.0, -0.02, 0.0), identified(strain, -0.02, 0.0, 0.0),
        identified("strain,stress (kPa)", -0.02, 0.0, 0.0), identified(stretch, 0.0, -0.02, 1.0),
        identified(stretch, -0.02, 0.0, 1.0), identified(stretch, -0.02, 0.02, 1.0)}) {
    EXPECT_EQ(done.code, 0) << done.err;
    EXPECT_NE(done.out.find("tissue.young_modulus  12"), std::string::npos) << done.out << done.err;
  }
  EXPECT_EQ(identified(stretch, 0.0, 0.02, 1.0).err,
            "negative.csv: `stretch` is a stretch above 1, which is tension, and the scenario "
            "compresses; fit it by `palpate fit --model ogden`\n");
}

}  // namespace
}  // namespace palpate::test
