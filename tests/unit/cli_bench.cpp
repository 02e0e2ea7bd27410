// `palpate chart --frames`: the shape of its table, and that the work it times is really done.
// Never a time.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "base/text.h"
#include "program.h"
#include "record/csv.h"
#include "run/bench.h"

namespace palpate::test {
namespace {

using Words = std::vector<std::string>;

std::string bench_press(const std::string& more) {
  return "[solver]\nmodel = \"mass_spring\"\n" + more +
         "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\nrate = \"20 mm/s\"\n";
}

class BenchVerb : public testing::Test {
 protected:
  Ended bench(const std::string& scenario, const Words& more) const {
    write_file(folder_ / "press.toml", scenario);
    return palpate(folder_.path(), {"chart", "press.toml"}, more);
  }
  // The only row.
  nlohmann::json measured(const std::string& scenario) const {
    const Ended ended = bench(scenario, {"--frames", "5", "--json"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(ended.err, "");
    return nlohmann::json::parse(ended.out);
  }
  void expect_refused(const std::string& scenario, int code, const std::string& sentence) const {
    const Ended ended = bench(scenario, {"--frames", "5"});
    EXPECT_EQ(ended.code, code) << ended.err;
    EXPECT_NE(ended.err.find(sentence), std::string::npos) << ended.err;
  }
  TemporaryFolder folder_;
};

TEST_F(BenchVerb, RowsAreWholeAndOrdered) {
  const auto row = measured(bench_press(""));
  EXPECT_EQ(row["model"], "press");
  EXPECT_EQ(row["nodes"], 140);
  EXPECT_EQ(row["tetrahedra"], 432);
  EXPECT_EQ(row["integrator"], "central_difference");
  EXPECT_EQ(row["rings"], "all");
  EXPECT_EQ(row["coupling"], "consistent");
  EXPECT_EQ(row["frames"], 5);
  for (const std::string stage : {"collision", "deformation", "sum", "frame"}) {
    EXPECT_GT(row[stage + "_p50_ms"], 0.0) << stage;
    EXPECT_GE(row[stage + "_p99_ms"], row[stage + "_p50_ms"]) << stage;
  }
  EXPECT_TRUE(row["paper_sum_ms"].is_null());
}

// The whole frame and the stages are timed apart: the page says both, and why they differ.
TEST_F(BenchVerb, ThePageNamesTheFrameAndTheSumOfItsStages) {
  const Ended ended =
      bench(bench_press(""), {"--frames", "5", "--csv", "--report", "frames/page.html"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  write_file(folder_ / "times.csv", ended.out);
  const record::Table times = record::read_csv((folder_ / "times.csv").string());
  const auto shown = [&](const char* column) {
    const auto at = static_cast<std::size_t>(times.find(column));
    return rounded_text(std::get<double>(times.rows.front()[at]), 3) + " ms";
  };
  const std::string headline = headline_of(folder_ / "frames/page.html");
  EXPECT_TRUE(headline.starts_with(shown("frame_p50_ms") + " for the slowest whole frame"))
      << headline;
  EXPECT_NE(headline.find("sum to " + shown("sum_p50_ms")), std::string::npos) << headline;
  const std::string page = read_file(folder_ / "frames/page.html");
  EXPECT_NE(page.find("on a second mesh"), std::string::npos);
  EXPECT_EQ(page.find("class=\"wide many\""), std::string::npos) << "more than eight columns";
}

TEST_F(BenchVerb, TheForceIsTheRunsForce) {
  // `consistent` and `one_way` follow the finger alone, so that the speed does not matter.
  for (const std::string more :
       {"", "integrator = \"modal\"\n", "rings = 2\n",
        "integrator = \"quasi_static\"\n[contact]\ncoupling = \"one_way\"\n"}) {
    const auto row = measured(bench_press(more));
    ASSERT_EQ(palpate(folder_.path(), {"run", "press.toml", "--force", "--quiet"}).code, 0);
    const record::Table table = record::read_csv(folder_ / "out/press/force_indentation.csv");
    const auto column = static_cast<std::size_t>(table.find("force_N"));
    const double force = std::get<double>(table.rows.back()[column]);
    EXPECT_GT(force, 0.1) << more;
    EXPECT_NEAR(row["force_N"], force, 1e-8 * force) << more;  // depths settle to 1e-12 radii
    EXPECT_GT(row["displacement_mm"], 0.005) << more << "the mesh of the deformation moves";
  }
}

TEST_F(BenchVerb, CentralDifferencesAndModesPressAsHard) {
  write_file(folder_ / "press.toml", bench_press(""));
  std::vector<double> forces;
  for (const std::string integrator : {"central_difference", "modal"}) {
    const Ended ended = palpate(folder_.path(), {"chart", "press.toml", "--frames", "5", "--json",
                                                 "--set", "solver.integrator=" + integrator});
    ASSERT_EQ(ended.code, 0) << ended.err;
    const auto row = nlohmann::json::parse(ended.out);
    EXPECT_EQ(row["integrator"], integrator);
    forces.push_back(row["force_N"]);
  }
  EXPECT_NEAR(forces[0], forces[1], 1e-6 * forces[0]);  // statics of the same springs
}

TEST_F(BenchVerb, SeriesReadsTheMovingMesh) {
  for (const std::string more : {"", "integrator = \"backward_difference\"\n"}) {
    const auto stiff = measured(bench_press(more));
    const auto soft = measured(bench_press(more + "[contact]\ncoupling = \"series\"\n"));
    EXPECT_EQ(soft["coupling"], "series");
    EXPECT_LT(soft["force_N"], stiff["force_N"]) << more;
    EXPECT_GT(soft["force_N"], 0.0) << more;
  }
}

TEST_F(BenchVerb, TheWorkIsTheSameTwice) {
  const auto first = measured(bench_press("rings = 2\n"));
  const auto second = measured(bench_press("rings = 2\n"));
  EXPECT_EQ(first["force_N"], second["force_N"]);
  EXPECT_EQ(first["displacement_mm"], second["displacement_mm"]);
}

TEST_F(BenchVerb, CasesOfASweepAreRows) {
  const Ended ended =
      bench(bench_press("") + "[sweep]\n\"tissue.material\" = [\"skin\", \"muscle\"]\n",
            {"--frames", "2"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(ended.err, "") << "the readable table is for terminals";
  const record::Table table = record::parse_csv(ended.out, "stdout");
  ASSERT_EQ(table.rows.size(), 2U);
  EXPECT_EQ(table.rows[0][0], record::Cell("press/skin"));
  EXPECT_EQ(table.rows[1][0], record::Cell("press/muscle"));
}

TEST_F(BenchVerb, RefusesWhatHasNoFrames) {
  expect_refused("[[step]]\nkind = \"creep\"\n", 2, "has no finger");
  expect_refused("[tissue]\nshape = { kind = \"half_space\" }\n[[step]]\nkind = \"indent\"\n", 2,
                 "a `half_space` has no mesh");
  EXPECT_EQ(bench(bench_press(""), {"--frames", "0"}).code, 2);
  // Above the stability limit in one step, and nothing that damps.
  expect_refused(bench_press("substeps = 1\nallow_unstable = true\n[tissue]\nviscosity = "
                             "\"none\"\nyoung_modulus = \"2000 kPa\"\n"),
                 4, "press, central_difference, rings all, frame ");
}

// The modes of the larger models take a minute to compute: here central differences alone.
TEST(Bench, ThePapersModelsAreTheDefault) {
  TemporaryFolder folder;
  const Ended ended = palpate(
      folder.path(), {"chart", "--frames", "1", "--set", "solver.integrator=central_difference"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const record::Table table = record::parse_csv(ended.out, "stdout");
  const auto number = [&](std::size_t row, const char* column) {
    return std::get<double>(table.rows[row][static_cast<std::size_t>(table.find(column))]);
  };
  ASSERT_EQ(table.rows.size(), 8U);  // four models, the whole and 3 rings
  const double counts[][3] = {
      {140, 432, 0.45}, {456, 1470, 0.80}, {601, 1900, 1.01}, {728, 2550, 1.17}};
  for (std::size_t row = 0; row < 8; ++row) {
    const auto& [nodes, tetrahedra, sum] = counts[row / 2];
    EXPECT_NEAR(number(row, "nodes"), nodes, 0.03 * nodes);  // as near as TetGen is asked to come
    EXPECT_NEAR(number(row, "tetrahedra"), tetrahedra, 0.03 * tetrahedra);  // likewise
    EXPECT_EQ(number(row, "paper_sum_ms"), sum);
    EXPECT_GT(number(row, "force_N"), 0.0);
    EXPECT_GT(number(row, "displacement_mm"), 0.0);
  }
}

TEST(Bench, PercentilesAreNearestRanks) {
  EXPECT_EQ(run::percentile({4, 1, 3, 2}, 0.5), 2);
  EXPECT_EQ(run::percentile({4, 1, 3, 2}, 0.99), 4);
  EXPECT_EQ(run::percentile({7}, 0.5), 7);
}

}  // namespace
}  // namespace palpate::test
