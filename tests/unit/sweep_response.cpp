// Maps, curves and points of sweeps: their tables, and scripts that gnuplot draws in silence.
#include "sweep/response.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "base/child_process.h"
#include "plot/gnuplot_text.h"
#include "record/csv.h"
#include "svg_text.h"
#include "sweep/columns.h"
#include "temporary_folder.h"

namespace palpate::sweep {
namespace {

namespace fs = std::filesystem;
using Kind = sweep::DesignKind;
using sweep::Scale;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

sweep::FactorColumn number_factor(const std::string& key, const std::string& unit, Scale scale) {
  return {.choice = {.name = key, .column = unit.empty() ? key : key + "_" + unit, .scale = scale}};
}

// Modulus by ratio, the last varying fastest, y = 10 E + nu; one case has failed.
sweep::SweepColumns grid() {
  sweep::SweepColumns columns{.kind = Kind::grid, .cases = 12};
  columns.factors = {number_factor("tissue.young_modulus", "kPa", Scale::logarithmic),
                     number_factor("tissue.poisson_ratio", "", Scale::linear)};
  columns.factors[0].choice.levels = 3;
  columns.factors[1].choice.levels = 4;
  columns.outputs.push_back({"force_at_1_mm_N", {}});
  for (const double modulus : {100.0, 1.0, 10.0})
    for (const double ratio : {0.1, 0.2, 0.3, 0.4}) {
      columns.factors[0].values.push_back(modulus);
      columns.factors[1].values.push_back(ratio);
      columns.outputs[0].values.push_back(modulus == 10.0 && ratio == 0.2 ? none
                                                                          : 10 * modulus + ratio);
    }
  return columns;
}

sweep::SweepColumns with_words() {
  sweep::SweepColumns columns{.kind = Kind::grid, .cases = 6};
  columns.factors = {
      {.choice = {.name = "tissue.material", .column = "tissue.material", .levels = 2},
       .values = {0, 0, 0, 1, 1, 1},
       .words = {"skin", "bone's"}},
      number_factor("step.1.rate", "mm_per_s", Scale::linear)};
  columns.factors[1].choice.levels = 3;
  columns.factors[1].values = {1, 2, 3, 1, 2, 3};
  columns.outputs.push_back({"peak_force_N", {1, none, 3, 4, 5, 6}});
  return columns;
}

sweep::SweepColumns sample(Kind kind) {
  sweep::SweepColumns columns{.kind = kind, .cases = 40};
  columns.factors = {number_factor("a", "mm", Scale::linear),
                     number_factor("b", "", Scale::linear)};
  columns.outputs.push_back({"peak_force_N", {}});
  for (int i = 0; i < 40; ++i) {
    const double a = std::fmod(0.37 * i, 1.0), b = std::fmod(0.61 * i, 1.0);
    columns.factors[0].values.push_back(a);
    columns.factors[1].values.push_back(b);
    columns.outputs[0].values.push_back(i == 7 ? none : a + 3.0 * b);
  }
  return columns;
}

TEST(Response, OfAGridIsSortedAndKeepsItsGap) {
  const auto columns = grid();
  const auto made = response(columns, columns.outputs[0], "Press");
  ASSERT_TRUE(made);
  EXPECT_TRUE(made->is_map());
  EXPECT_EQ(made->grid.x, (std::vector<double>{1, 10, 100}));
  EXPECT_EQ(made->grid.y, (std::vector<double>{0.1, 0.2, 0.3, 0.4}));
  EXPECT_EQ(made->grid.values[0], 10.1);
  EXPECT_EQ(made->grid.values[2], 1000.1);
  EXPECT_TRUE(std::isnan(made->grid.values[3 + 1]));
  EXPECT_TRUE(made->logarithmic);
  const record::Table table = response_table(*made);
  EXPECT_EQ(table.columns,
            (std::vector<std::string>{"tissue.young_modulus_kPa", "tissue.poisson_ratio",
                                      "low_tissue.young_modulus_kPa",
                                      "high_tissue.young_modulus_kPa", "low_tissue.poisson_ratio",
                                      "high_tissue.poisson_ratio", "force_at_1_mm_N"}));
  // Halfway to the neighbours, on the axis of logarithms by the root of ten, and not beyond 0.1.
  const std::vector<double> wanted{10,   0.1,  std::sqrt(10.0), 10 * std::sqrt(10.0), 0.1,
                                   0.15, 100.1};
  for (std::size_t i = 0; i < wanted.size(); ++i)
    EXPECT_DOUBLE_EQ(std::get<double>(table.rows[1][i]), wanted[i]) << i;
  EXPECT_EQ(table.rows[4].back(), record::Cell());
  const std::string script = response_sheet(*made).script;
  EXPECT_NE(script.find("set xrange [1:100]"), std::string::npos) << script;
  EXPECT_NE(script.find("set yrange [0.1:0.4]"), std::string::npos) << script;
  EXPECT_EQ(table.rows.size(), 12u);
}

TEST(Response, OfWordsHasACurveForEach) {
  const auto columns = with_words();
  const auto made = response(columns, columns.outputs[0], "Press");
  ASSERT_TRUE(made);
  EXPECT_FALSE(made->is_map());
  EXPECT_EQ(record::csv_text(response_table(*made)),
            "step.1.rate_mm_per_s,tissue.material,peak_force_N\n"
            "1,skin,1\n2,skin,\n3,skin,3\n1,bone's,4\n2,bone's,5\n3,bone's,6\n");
}

// The legend beside the curves has the unit of its factor, on a line of its own if the name is
// long.
TEST(Response, TheLegendOfTheSecondPanelHasItsUnit) {
  sweep::SweepColumns columns = grid();
  std::swap(columns.factors[0], columns.factors[1]);
  columns.factors[0].choice.levels = 3;  // of twelve cases, sorted by the new first factor
  columns.factors[1].choice.levels = 4;
  for (std::size_t i = 0; i < 12; ++i) {
    columns.factors[0].values[i] = 0.1 * static_cast<double>(i / 4 + 1);
    columns.factors[1].values[i] = 10.0 * static_cast<double>(i % 4 + 1);
  }
  const auto made = response(columns, columns.outputs[0], "A sweep");
  ASSERT_TRUE(made && made->along);
  EXPECT_NE(
      response_sheet(*made).script.find("set key title 'Young''s modulus'.\"\\n\".'(kPa)' left"),
      std::string::npos)
      << response_sheet(*made).script;
  columns.factors[1] = number_factor("step.1.to", "mm", Scale::linear);
  columns.factors[1].choice.levels = 4;
  columns.factors[1].values = {1, 2, 3, 4, 1, 2, 3, 4, 1, 2, 3, 4};
  const auto short_one = response(columns, columns.outputs[0], "A sweep");
  ASSERT_TRUE(short_one);
  EXPECT_NE(response_sheet(*short_one).script.find("set key title 'Step 1 to (mm)' left"),
            std::string::npos)
      << response_sheet(*short_one).script;
}

TEST(Response, OfThreeFactorsTakesTheMiddleOfTheThirdAndSaysSo) {
  auto columns = grid();
  // The same again for a third factor that varies slowest, each level 1000 higher.
  sweep::FactorColumn third = number_factor("finger.radius", "mm", Scale::linear);
  third.choice.levels = 3;
  const auto once = columns;
  columns.cases = 36;
  for (auto* values :
       {&columns.factors[0].values, &columns.factors[1].values, &columns.outputs[0].values})
    values->clear();
  for (int level = 0; level < 3; ++level)
    for (std::size_t i = 0; i < 12; ++i) {
      third.values.push_back(8.0 + level);
      columns.factors[0].values.push_back(once.factors[0].values[i]);
      columns.factors[1].values.push_back(once.factors[1].values[i]);
      columns.outputs[0].values.push_back(once.outputs[0].values[i] + 1000.0 * level);
    }
  third.choice.name = "finger.radius";
  columns.factors.insert(columns.factors.begin(), third);
  const auto made = response(columns, columns.outputs[0], "Press");
  ASSERT_TRUE(made);
  // The first two numbers make the map: here the radius and the modulus, at the third ratio.
  EXPECT_EQ(made->title, "Press: Force at 1 mm (N), tissue.poisson_ratio = 0.3");
  EXPECT_EQ(made->grid.x, (std::vector<double>{8, 9, 10}));
  EXPECT_EQ(made->grid.y, (std::vector<double>{1, 10, 100}));
  EXPECT_EQ(made->grid.values[1], 1000.0 + 10.3);
}

TEST(Response, ThinsWhatNoPictureCouldShow) {
  sweep::SweepColumns columns{.kind = Kind::grid, .cases = 250};
  columns.factors = {number_factor("a", "mm", Scale::linear)};
  columns.factors[0].choice.levels = 250;
  columns.outputs.push_back({"peak_force_N", {}});
  for (int i = 0; i < 250; ++i) {
    columns.factors[0].values.push_back(i);
    columns.outputs[0].values.push_back(2.0 * i);
  }
  const auto made = response(columns, columns.outputs[0], "Press");
  EXPECT_EQ(made->title, "Press: Peak force (N), one level in 7 of a");
  EXPECT_EQ(made->grid.x.size(), 36u);
  EXPECT_EQ(made->grid.values[35], 2.0 * 245);
}

TEST(Response, PointsOfManyCasesAreThinnedEvenly) {
  sweep::SweepColumns columns = sample(Kind::lhs);
  EXPECT_EQ(scatter_table(columns).rows.size(), 40u);
  EXPECT_EQ(scatter_table(columns).rows[7].back(), record::Cell());
  columns.cases = 7000;
  columns.factors.clear();
  columns.outputs = {{"peak_force_N", std::vector<double>(7000, 1.0)}};
  const record::Table table = scatter_table(columns);
  EXPECT_EQ(table.rows.size(), 2334u);
  EXPECT_EQ(std::get<double>(table.rows[1][0]), 4.0);  // numbers count from 1
}

// The files of a folder, none of which is empty.
std::vector<std::string> names_in(const WholeFolder& folder) {
  std::vector<std::string> names;
  for (const HashedFile& file : folder.files()) {
    EXPECT_GT(fs::file_size(folder.file(file.path)), 20u) << file.path;
    names.push_back(file.path);
    if (file.path.ends_with(".svg")) {
      EXPECT_EQ(test::SvgPicture(read_text(folder.file(file.path))).faults(),
                std::vector<std::string>{})
          << file.path;
    }
  }
  return names;
}

// The files that draw_sweep() makes; gnuplot must have nothing to say.
std::vector<std::string> drawn(const sweep::SweepColumns& columns) {
  const test::TemporaryFolder place;
  WholeFolder folder((place / "drawn").string(), "sweep", Replace::incomplete);
  folder.open();
  for (const std::string& warning :
       draw_sweep(columns, sensitivity(columns), "It's a sweep", folder))
    EXPECT_EQ(warning.find("gnuplot"), std::string::npos) << warning;
  return names_in(folder);
}

bool gnuplot_is_there() {
  return run_process({.argv = {"gnuplot", "--version"}, .folder = ".", .limit = 10.0}).end ==
         ChildResult::End::exited;
}

TEST(Response, EveryDesignIsDrawnInSilence) {
  if (!gnuplot_is_there()) GTEST_SKIP() << "gnuplot is not installed";
  using Files = std::vector<std::string>;
  const std::string force = "response_force_at_1_mm_N";
  const std::string peak = "response_peak_force_N";
  EXPECT_EQ(drawn(grid()), (Files{force + ".csv", force + ".gp", force + ".svg"}));
  EXPECT_EQ(drawn(with_words()), (Files{peak + ".csv", peak + ".gp", peak + ".svg"}));
  EXPECT_EQ(drawn(sample(Kind::lhs)),
            (Files{"correlation.csv", "sweep_points.csv", peak + ".gp", peak + ".svg"}));
  EXPECT_EQ(drawn(sample(Kind::saltelli)),
            (Files{"sensitivity.csv", "sweep_points.csv", peak + ".gp", peak + ".svg",
                   "sensitivity.gp", "sensitivity.svg"}));
  auto wide = grid();  // with labels such as 0.005
  for (double& value : wide.outputs[0].values) value *= 5e-4;
  EXPECT_EQ(drawn(wide).size(), 3u);
  auto whole = grid();
  whole.outputs[0].values[9] = 100.2;
  EXPECT_EQ(drawn(whole), (Files{"sensitivity.csv", force + ".csv", force + ".gp", force + ".svg",
                                 "sensitivity.gp", "sensitivity.svg"}));
}

// A part of a sweep may omit whole curves, or all cases of the figure.
TEST(Response, OfAPartIsDrawnInSilence) {
  if (!gnuplot_is_there()) GTEST_SKIP() << "gnuplot is not installed";
  const std::string name = "response_force_at_1_mm_N";
  const std::vector<std::string> files{name + ".csv", name + ".gp", name + ".svg"};
  auto part = grid();
  std::vector<double>& values = part.outputs[0].values;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (i % 4 != 2) values[i] = none;
  EXPECT_EQ(drawn(part), files) << "one level of the ratio";
  values[2] = values[6] = none;
  EXPECT_EQ(drawn(part), files) << "one case";
  values[10] = none;
  EXPECT_EQ(drawn(part), std::vector<std::string>()) << "no case";
}

TEST(Response, WithoutOptionsOnlyTablesAreWritten) {
  const test::TemporaryFolder place;
  WholeFolder folder((place / "drawn").string(), "sweep", Replace::incomplete);
  folder.open();
  (void)draw_sweep(sample(Kind::sobol), sensitivity(sample(Kind::sobol)), "Sweep", folder,
                   std::nullopt);
  EXPECT_EQ(names_in(folder), (std::vector<std::string>{"correlation.csv", "sweep_points.csv"}));
}

TEST(Response, AScriptIsTheSameTwice) {
  const auto columns = grid();
  const auto made = response(columns, columns.outputs[0], "Press");
  EXPECT_EQ(response_sheet(*made).script, response_sheet(*made).script);
  const std::string script = response_sheet(*made).script;
  EXPECT_NE(script.find("set logscale x"), std::string::npos);
  EXPECT_NE(script.find("set logscale cb"), std::string::npos);
  EXPECT_NE(script.find("linecolor rgb '#" + plot::palette_colour(plot::brightest_line)),
            std::string::npos)
      << "the last curve has a contrast of 3 to white";
  EXPECT_NE(script.find("set xlabel 'Young''s modulus (kPa)'"), std::string::npos);
  EXPECT_NE(script.find("$contours << EOD\nx0,y0,x1,y1\n"), std::string::npos)
      << "gnuplot takes the first row for a head";
}

TEST(SweepLabels, NameOutputsAndFactorsWithTheirUnits) {
  EXPECT_EQ(output_label("force_at_1.5_mm_N"), "Force at 1.5 mm (N)");
  EXPECT_EQ(output_label("peak_strain"), "Peak strain");
  EXPECT_EQ(output_label("force_indentation_logarithmic_a_N"), "a, logarithmic fit (N)");
  EXPECT_EQ(output_label("creep_kelvin_voigt_tau_s"), "tau, kelvin_voigt fit, creep (s)");
  EXPECT_EQ(factor_label({.name = "tissue.density", .column = "tissue.density_kg_per_m3"}),
            "Density (kg/m3)");
  EXPECT_EQ(factor_label({.name = "tissue.drag", .column = "tissue.drag_per_s"}), "Drag (1/s)");
  EXPECT_EQ(factor_label({.name = "a.b + c.d", .column = "a.b_kPa"}), "A b + c d (kPa)");
  EXPECT_EQ(plot::key_label("tissue.poisson_ratio"), "Poisson's ratio");
  EXPECT_EQ(plot::key_label("region.1.young_modulus"), "Region 1 Young's modulus");
  EXPECT_EQ(plot::key_label("step.1.to"), "Step 1 to");
  EXPECT_EQ(file_word("a b/c_1.5"), "a_b_c_1_5");
  EXPECT_EQ(plot::palette_colour(0.0), "440154");
  EXPECT_EQ(plot::palette_colour(1.0), "fde725");
}

}  // namespace
}  // namespace palpate::sweep
