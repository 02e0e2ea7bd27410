// What a chart says of its measurements: the front, the knee, sentences, columns.
#include "chart/table.h"

#include <gtest/gtest.h>

namespace palpate::chart {
namespace {

// A measured variant that costs `cost` us per ms: 1 s of programme, no set-up.
Measurement measured(const std::string& name, double cost, double error) {
  Measurement one;
  one.variant = {0, "model x mesh", name, {"solver.model=" + name}};
  one.status = Status::measured;
  one.model = name;
  one.simulated = 1.0;
  one.error = Deviation{error, 0.5 * error, 0.25 * error};
  one.timings = {{0.5, 0.0, 1e-3 * cost}};
  return one;
}

CaseChart chart_of(const std::vector<Measurement>& rows, double own = 0.001) {
  CaseChart chart;
  chart.name = "case";
  chart.tolerance = 0.05;
  chart.truth = {"refined", "some sentence", {{1, 1.0, 10.0, 10.0 * own}}};
  chart.reference_error = own;
  chart.rows = rows;
  return chart;
}

CaseChart model_table() {
  CaseChart chart = chart_of({measured("cheap", 1, 0.2), measured("knee", 2, 0.02),
                              measured("dear", 100, 0.005), measured("beaten", 200, 0.1)});
  chart.rows[1].variant.name = "auto";
  return chart;
}

TEST(ChartTable, CostsAreDifferencesWithoutSetUp) {
  Measurement one;
  one.simulated = 0.4;
  one.first_simulated = 0.1;
  one.timings = {{1.0, 0.2, 0.5}};
  EXPECT_DOUBLE_EQ(one.costs()[0], 1e3 * 0.3 / 0.3);  // us per ms
  EXPECT_DOUBLE_EQ(one.setups()[0], 1.2);
  EXPECT_DOUBLE_EQ(one.totals()[0], 1.5);
  // Nothing follows the first row of a programme of one row.
  one.first_simulated = 0.4;
  EXPECT_DOUBLE_EQ(one.costs()[0], 1e3 * 0.5 / 0.4);
}

TEST(ChartTable, Judgement) {
  const Verdict verdict = judge(model_table());
  EXPECT_EQ(verdict.front, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(verdict.knee, 1U);
  EXPECT_EQ(verdict.taken, 1U);
  EXPECT_EQ(verdict.cheapest_within, 1U);
  EXPECT_EQ(verdict.nearest, 2U);
  EXPECT_DOUBLE_EQ(verdict.cost[2], 100.0);
}

TEST(ChartTable, NoErrorBelowTheReferencesOwnIsClaimed) {
  const CaseChart chart = chart_of({measured("a", 1, 0.0), measured("b", 2, 0.001)}, 0.01);
  const Verdict verdict = judge(chart);
  EXPECT_DOUBLE_EQ(verdict.floor, 0.01);
  EXPECT_DOUBLE_EQ(verdict.error[0], 0.01);
  EXPECT_EQ(verdict.front, std::vector<std::size_t>{0}) << "b is no righter";
  EXPECT_NE(chart_text({chart}).find("`a` (at most 1 %, 1 µs per ms)"), std::string::npos);
  EXPECT_DOUBLE_EQ(judge(chart_of({measured("a", 1, 0.0)}, 0.0)).floor, comparison_error);
}

TEST(ChartTable, WhatWasNotMeasuredTakesNoPart) {
  CaseChart chart = model_table();
  chart.rows[0].status = Status::diverged;
  chart.rows[1].error.reset();
  chart.rows[2].timings.clear();
  const Verdict verdict = judge(chart);
  EXPECT_EQ(verdict.front, std::vector<std::size_t>{3});
  EXPECT_EQ(verdict.taken, std::nullopt);
  EXPECT_EQ(verdict.cheapest_within, std::nullopt);
  EXPECT_EQ(verdict.nearest, 3U);
  EXPECT_NE(chart_text({chart}).find("No configuration is within the tolerance of 5 %; nearest is "
                                     "`beaten` (10 %, 200 µs per ms)"),
            std::string::npos);
}

TEST(ChartTable, SpringsOfOneForceAreToldApartByTheirDisplacedSurface) {
  CaseChart chart =
      chart_of({measured("mass_spring", 1, 0.012), measured("coupled_springs", 2, 0.012)});
  EXPECT_EQ(chart_text({chart}).find("displaced surface within"), std::string::npos);
  chart.rows[0].surface_error = 0.21;
  chart.rows[1].surface_error = 0.03;
  chart.surface.error = 0.004;
  const std::string text = chart_text({chart});
  EXPECT_NE(text.find(" `mass_spring` and `coupled_springs` have the same force, an error of 1.2 "
                      "%; the displaced surface within four contact radii is off by 21 % with "
                      "`mass_spring` and by 3 % with `coupled_springs` (root mean square over the "
                      "largest displacement, compared with `solid`, whose own error there is 0.4 "
                      "%).\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("| `mass_spring` | 1.2 % | 21 % |"), std::string::npos) << text;
  const record::Table table = chart_table({chart});
  const auto cell = [&](const char* column) {
    return table.rows[1][static_cast<std::size_t>(table.find(column))];
  };
  EXPECT_EQ(cell("surface_error"), record::Cell(0.03));
  EXPECT_EQ(cell("surface_reference_error"), record::Cell(0.004));
  chart.rows[0].error->greatest = 0.02;  // another force
  EXPECT_EQ(chart_text({chart}).find("displaced surface within"), std::string::npos);
}

TEST(ChartTable, MediansAndSpreads) {
  Measurement one = measured("a", 1, 0.1);
  one.timings = {{0, 0, 3e-3}, {0, 0, 1e-3}, {0, 0, 2e-3}, {0, 0, 9e-3}};
  const record::Table table = chart_table({chart_of({one})});
  const auto number = [&](const char* column) {
    return std::get<double>(table.rows[0][static_cast<std::size_t>(table.find(column))]);
  };
  EXPECT_EQ(number("cost_us_per_ms"), 2.0);
  EXPECT_EQ(number("cost_min_us_per_ms"), 1.0);
  EXPECT_EQ(number("cost_max_us_per_ms"), 9.0);
  EXPECT_EQ(number("timings"), 4.0);
  EXPECT_EQ(number("greatest_error"), 0.1);
  EXPECT_EQ(number("end_error"), 0.05);
  EXPECT_EQ(number("rms_error"), 0.025);
  EXPECT_EQ(number("within_tolerance"), 0.0);
}

TEST(ChartTable, AReasonIsSaidOnce) {
  CaseChart chart = model_table();
  for (int i = 0; i < 5; ++i) {
    Measurement one;
    one.variant.name = "mesh " + std::to_string(i);
    one.status = Status::cannot;
    one.note = "no mesh";
    chart.rows.push_back(one);
  }
  chart.rows[0].status = Status::cannot;
  chart.rows[0].note = "no layer";
  const std::string text = chart_text({chart});
  EXPECT_NE(text.find("6 cannot be computed:\n\n- `cheap`: no layer\n"
                      "- `mesh 0` and 4 more configurations (chart.csv): no mesh\n"),
            std::string::npos)
      << text;
}

TEST(ChartTable, EveryRowHasEveryColumn) {
  CaseChart chart = model_table();
  chart.rows[0].status = Status::cannot;
  chart.rows[0].note = "it cannot";
  chart.rows[2].time_error = Deviation{0.1, 0.1, 0.1};
  const record::Table table = chart_table({chart});
  ASSERT_EQ(table.rows.size(), 4U);
  for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.columns.size());
  const auto at = [&](std::size_t row, const char* column) {
    return table.rows[row][static_cast<std::size_t>(table.find(column))];
  };
  EXPECT_EQ(at(0, "status"), record::Cell("cannot"));
  EXPECT_EQ(at(0, "note"), record::Cell("it cannot"));
  EXPECT_EQ(at(0, "cost_us_per_ms"), record::Cell());
  EXPECT_EQ(at(1, "auto"), record::Cell(1.0));
  EXPECT_EQ(at(1, "settings"), record::Cell("solver.model=knee"));
  EXPECT_EQ(at(2, "pareto"), record::Cell(1.0));
  EXPECT_EQ(at(3, "pareto"), record::Cell(0.0));
}

TEST(ChartTable, SentencesToActOn) {
  CaseChart chart = model_table();
  std::string text = chart_text({chart});
  EXPECT_NE(text.find("Reference: some sentence."), std::string::npos);
  EXPECT_NE(text.find("Within the tolerance of 5 %, the cheapest is `auto` (2 %, 2 µs per ms): "
                      "`--set solver.model=knee`; `auto` took it."),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("The knee is `auto` (2 %, 2 µs per ms): `--set solver.model=knee`; to halve "
                      "its error costs 50 times as much: `dear`, `--set solver.model=dear`."),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("In real time (1000 µs per ms) the most accurate is `dear` (0.5 %"),
            std::string::npos);
  // `auto` elsewhere.
  chart.rows[1].variant.name = "knee";
  chart.rows[2].variant.name = "auto";
  text = chart_text({chart});
  EXPECT_NE(text.find("; `auto` took `auto` (0.5 %, 100 µs per ms), at 50 times the cost."),
            std::string::npos)
      << text;
  chart.rows[2].variant.group = "base";
  chart.rows[2].model = "coupled_springs";
  text = chart_text({chart});
  EXPECT_NE(text.find("; `auto` took `coupled_springs` (0.5 %"), std::string::npos) << text;
  chart.rows[2].variant.group.clear();
  chart.rows[3].variant.name = "auto";
  chart.rows[2].variant.name = "dear";
  EXPECT_NE(chart_text({chart}).find("(10 %, 200 µs per ms), which is outside."),
            std::string::npos);
}

// A page's headline has the configuration already, and its table what the lists say.
TEST(ChartTable, SentencesOfAPage) {
  const ChartSentences said = chart_sentences(model_table());
  EXPECT_EQ(said.reference, "Reference: some sentence.");
  EXPECT_EQ(said.result,
            "Within the tolerance of 5 %, the cheapest is `auto` (2 %, 2 µs per ms): `--set "
            "solver.model=knee`; `auto` took it.");
  EXPECT_EQ(said.settings, "Its settings: `--set solver.model=knee`; `auto` took it.");
  ASSERT_EQ(said.more.size(), 2U);
  EXPECT_TRUE(said.more[0].starts_with("The knee is `auto`")) << said.more[0];
  EXPECT_TRUE(said.more[1].starts_with("In real time")) << said.more[1];
  CaseChart none = model_table();
  none.tolerance = 1e-4;
  EXPECT_EQ(chart_sentences(none).settings, "");
}

TEST(ChartTable, InTimeAlone) {
  CaseChart chart = model_table();
  chart.rows[0].time_error = Deviation{0.0, 0.0, 0.0};
  EXPECT_NE(chart_text({chart}).find("all integrators and steps give the same"), std::string::npos);
  chart.rows[2].time_error = Deviation{0.3, 0.3, 0.3};
  const std::string text = chart_text({chart});
  EXPECT_NE(text.find("Time integration alone, compared with `modal` (0.01 %):\n- `cheap`, 0.01 "
                      "%, 1 µs per ms\n\n"),
            std::string::npos)
      << text;
}

TEST(ChartTable, SettingsAsAShellTakesThem) {
  EXPECT_EQ(set_line({}), "as the scenario stands");
  EXPECT_EQ(set_line({"solver.model=layer", "solver.time_step=1 ms",
                      "tissue.mesh={kind='tetgen',nodes=9}"}),
            "`--set solver.model=layer --set \"solver.time_step=1 ms\" --set "
            "\"tissue.mesh={kind='tetgen',nodes=9}\"`");
}

}  // namespace
}  // namespace palpate::chart
