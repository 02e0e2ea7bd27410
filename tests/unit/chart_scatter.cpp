// The scatter's script runs without a word, and its picture shows what the table says.
#include "chart/table.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "record/csv.h"
#include "scenario/integrators.h"
#include "scenario/model_traits.h"

namespace palpate::chart {
namespace {

namespace fs = std::filesystem;

// A row with timings of these costs, us per simulated ms.
Measurement measured(const std::string& name, const std::string& model,
                     const std::string& integrator, double error,
                     const std::vector<double>& costs) {
  Measurement one;
  one.variant.name = name;
  one.variant.settings = {"solver.model=" + model, "x={a=[3,4]}"};
  one.status = Status::measured;
  one.model = model;
  one.integrator = integrator;
  one.simulated = one.first_simulated = 1e3;
  one.error = Deviation{.greatest = error};
  for (const double cost : costs) one.timings.push_back({.whole = cost});
  return one;
}

class ScatterDrawn : public testing::Test {
 protected:
  fs::path folder_ = fs::temp_directory_path() / ("palpate-scatter-" + std::to_string(::getpid()));
  CaseChart chart_;

  ScatterDrawn() {
    fs::create_directories(folder_);
    chart_.name = "a";
    chart_.reference_error = 0.005;
    chart_.rows = {measured("hertz", "hertz", "", 0.2, {0.9, 1.0, 1.2}),
                   measured("auto", "layer", "", 0.02, {1.9, 2.0, 2.2}),
                   measured("modal", "mass_spring", "modal", 0.01, {250.0, 300.0, 450.0}),
                   Measurement()};  // one that cannot be computed
  }
  ~ScatterDrawn() override { fs::remove_all(folder_); }

  [[nodiscard]] plot::Sheet sheet() const {
    return scatter_sheet(chart_, "chart", "It's \"a\" title").value();
  }
  // Beside the table of this case and of another one.
  [[nodiscard]] plot::Drawing drawn() const {
    CaseChart other = chart_;
    other.name = "b";
    other.rows = {measured("modal", "coupled_springs", "modal", 0.01, {4000.0, 5000.0, 6000.0})};
    std::ofstream(folder_ / "chart.csv") << record::csv_text(chart_table({chart_, other}));
    return plot::draw(sheet(), folder_.string());
  }
  [[nodiscard]] std::string picture() const {
    std::ifstream stream(folder_ / "chart.svg");
    return {std::istreambuf_iterator<char>(stream), {}};
  }
};

TEST_F(ScatterDrawn, DrawsWithoutAWord) {
  const plot::Drawing drawing = drawn();
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
  std::vector<std::string> entries{"Pareto front", "knee", "taken by auto", "no mesh"};
  for (const scenario::ModelTraits& model : scenario::model_table) {
    entries.emplace_back(model.word);
    chart_.rows.push_back(measured(model.word, model.word, "", 0.3, {500.0}));
  }
  for (const auto& integrator : scenario::integrator_table) {
    entries.emplace_back(integrator.word);
    chart_.rows.push_back(measured(integrator.word, "mass_spring", integrator.word, 0.3, {500.0}));
  }
  EXPECT_EQ(drawn().warning, "");
  const std::string svg = picture();
  for (const std::string& entry : entries)
    EXPECT_NE(svg.find(">" + entry + "<"), std::string::npos) << entry;
}

TEST_F(ScatterDrawn, TheFrontsLineIsNotBrokenByOtherRows) {
  EXPECT_NE(sheet().script.find("set datafile missing NaN"), std::string::npos);
}

TEST_F(ScatterDrawn, OnlyWhatARowHasIsMarked) {
  chart_.rows.resize(1);
  EXPECT_EQ(drawn().warning, "");
  EXPECT_EQ(picture().find("knee"), std::string::npos);
  EXPECT_EQ(picture().find("taken by auto"), std::string::npos);
  chart_.rows.clear();
  EXPECT_FALSE(scatter_sheet(chart_, "chart", "nothing to compare"));
}

TEST_F(ScatterDrawn, TheHapticFrameIsAlwaysInSight) {
  EXPECT_NE(sheet().script.find("set xrange [0.45:2000]"), std::string::npos);
  // Nor does the floor or the tolerance leave the picture: 0.5 % and 20 %, with an octave.
  EXPECT_NE(sheet().script.find("set yrange [0.25:40]"), std::string::npos);
}

TEST_F(ScatterDrawn, IntegratorsKeepTheirMarkers) {
  const auto shape = [this](const std::string& title) {
    const std::string script = sheet().script;
    const std::string line = script.substr(0, script.find(" title '" + title + "'"));
    return line.substr(line.rfind("pointtype"));
  };
  const std::string alone = shape("modal");
  for (const char* integrator : {"central_difference", "quasi_static"})
    chart_.rows.insert(chart_.rows.begin(),
                       measured(integrator, "mass_spring", integrator, 0.3, {500.0}));
  EXPECT_EQ(shape("modal"), alone);
  EXPECT_NE(shape("modal"), shape("quasi_static"));
}

TEST_F(ScatterDrawn, AMissingTableIsAWarning) {
  const plot::Drawing drawing = plot::draw(sheet(), folder_.string());
  EXPECT_NE(drawing.warning.find("`chart.csv` is missing"), std::string::npos);
  EXPECT_EQ(drawing.files, std::vector<std::string>{"chart.gp"});
}

}  // namespace
}  // namespace palpate::chart
