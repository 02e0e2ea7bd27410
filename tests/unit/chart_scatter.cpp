// The scatter's script runs without a word, and its picture shows what the table says.
#include "chart/table.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "scenario/integrators.h"
#include "scenario/model_traits.h"

namespace palpate::chart {
namespace {

namespace fs = std::filesystem;

const char* const csv =
    "case,model,integrator,status,shown_error,cost_us_per_ms,cost_min_us_per_ms,"
    "cost_max_us_per_ms,pareto,knee,auto,settings,note\n"
    "a,hertz,,measured,0.2,1,0.9,1.2,1,0,0,solver.model=hertz,\n"
    "a,layer,,measured,0.02,2,1.9,2.2,1,1,1,,\n"
    "a,mass_spring,modal,measured,0.01,300,250,450,1,0,0,\"tissue.mesh={cells=[3,4,6]}; x\",\n"
    "a,mass_spring,quasi_static,cannot,,,,,0,0,0,,\"no, it cannot\"\n"
    "b,coupled_springs,modal,measured,0.01,5000,4000,6000,1,0,0,,\n";

class ScatterDrawn : public testing::Test {
 protected:
  fs::path folder_ = fs::temp_directory_path() / ("palpate-scatter-" + std::to_string(::getpid()));
  ScatterDrawn() {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "chart.csv") << csv;
  }
  ~ScatterDrawn() override { fs::remove_all(folder_); }

  static Scatter scatter() {
    return {.name = "chart",
            .title = "It's \"a\" title",
            .csv_file = "chart.csv",
            .case_name = "a",
            .models = {"hertz", "layer", "mass_spring"},
            .integrators = {"", "modal"},
            .series = {{"hertz", ""}, {"layer", ""}, {"mass_spring", "modal"}},
            .marks = {"knee", "auto"},
            .floor = 0.005,
            .tolerance = 0.05,
            .least_cost = 0.9,
            .most_cost = 450.0,
            .least_error = 0.01,
            .most_error = 0.2};
  }
  [[nodiscard]] std::string picture() const {
    std::ifstream stream(folder_ / "chart.svg");
    return {std::istreambuf_iterator<char>(stream), {}};
  }
};

TEST_F(ScatterDrawn, DrawsWithoutAWord) {
  const plot::Drawing drawing = plot::draw(scatter_sheet(scatter()), folder_.string());
  EXPECT_EQ(drawing.warning, "");
  EXPECT_EQ(drawing.files, (std::vector<std::string>{"chart.gp", "chart.svg"}));
  const std::string svg = picture();
  for (const char* shown : {"It's", "Pareto front", "knee", "taken by auto", "real time",
                            "tolerance", "own error", "mass_spring", "no mesh", "modal"})
    EXPECT_NE(svg.find(shown), std::string::npos) << shown;
  EXPECT_EQ(svg.find("coupled_springs"), std::string::npos) << "of the other case";
}

// gnuplot drops the entries for which it has no room.
TEST_F(ScatterDrawn, TheKeyHasEveryModelAndIntegrator) {
  Scatter many = scatter();
  for (const scenario::ModelTraits& model : scenario::model_table)
    if (std::find(many.models.begin(), many.models.end(), model.word) == many.models.end())
      many.models.emplace_back(model.word);
  many.integrators = {""};
  for (const auto& integrator : scenario::integrator_table)
    many.integrators.emplace_back(integrator.word);
  EXPECT_EQ(plot::draw(scatter_sheet(many), folder_.string()).warning, "");
  const std::string svg = picture();
  std::vector<std::string> entries{"Pareto front", "knee", "taken by auto", "no mesh"};
  entries.insert(entries.end(), many.models.begin(), many.models.end());
  entries.insert(entries.end(), many.integrators.begin() + 1, many.integrators.end());
  for (const std::string& entry : entries)
    EXPECT_NE(svg.find(">" + entry + "<"), std::string::npos) << entry;
}

TEST_F(ScatterDrawn, TheFrontsLineIsNotBrokenByOtherRows) {
  EXPECT_NE(scatter_sheet(scatter()).script.find("set datafile missing NaN"), std::string::npos);
}

TEST_F(ScatterDrawn, OnlyWhatARowHasIsMarked) {
  Scatter plain = scatter();
  plain.marks.clear();
  EXPECT_EQ(plot::draw(scatter_sheet(plain), folder_.string()).warning, "");
  EXPECT_EQ(picture().find("knee"), std::string::npos);
}

TEST_F(ScatterDrawn, TheHapticFrameIsAlwaysInSight) {
  EXPECT_NE(scatter_sheet(scatter()).script.find("set xrange [0.45:2000]"), std::string::npos);
  // Nor does the floor or the tolerance leave the picture: 0.5 % and 20 %, with an octave.
  EXPECT_NE(scatter_sheet(scatter()).script.find("set yrange [0.25:40]"), std::string::npos);
}

TEST_F(ScatterDrawn, IntegratorsKeepTheirMarkers) {
  const auto shape = [](const Scatter& one, const std::string& title) {
    const std::string script = scatter_sheet(one).script;
    const std::string line = script.substr(0, script.find(" title '" + title + "'"));
    return line.substr(line.rfind("pointtype"));
  };
  Scatter more = scatter();
  more.integrators = {"", "central_difference", "quasi_static", "modal"};
  EXPECT_EQ(shape(more, "modal"), shape(scatter(), "modal"));
  EXPECT_NE(shape(more, "modal"), shape(more, "quasi_static"));
}

TEST_F(ScatterDrawn, AMissingTableIsAWarning) {
  fs::remove(folder_ / "chart.csv");
  const plot::Drawing drawing = plot::draw(scatter_sheet(scatter()), folder_.string());
  EXPECT_NE(drawing.warning.find("`chart.csv` is missing"), std::string::npos);
  EXPECT_EQ(drawing.files, std::vector<std::string>{"chart.gp"});
}

}  // namespace
}  // namespace palpate::chart
