// Scripts and the pictures that come of them.
#include "report/family_figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "base/child_process.h"
#include "base/files.h"
#include "plot/gnuplot.h"
#include "plot/gnuplot_text.h"
#include "record/csv.h"

namespace palpate::report {
namespace {

namespace fs = std::filesystem;

// PALPATE_KEEP_FIGURES=FOLDER keeps the pictures there, to be looked at.
class Gnuplot : public testing::Test {
 protected:
  void SetUp() override {
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    const char* kept = std::getenv("PALPATE_KEEP_FIGURES");
    folder_ = kept == nullptr ? testing::TempDir() + "palpate_gnuplot_" + name
                              : std::string(kept) + "/" + name;
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override {
    if (std::getenv("PALPATE_KEEP_FIGURES") == nullptr) fs::remove_all(folder_);
  }

  [[nodiscard]] std::string read(const std::string& file) const {
    return read_text(folder_ + "/" + file);
  }

  [[nodiscard]] long files_in_folder() const {
    return std::distance(fs::directory_iterator(folder_), fs::directory_iterator());
  }

  std::string folder_;
};

// Hertz curves of the paper's five tissues: F(1 mm) in N from PHYSICS.md, times h^1.5.
plot::Figure force_figure(const std::string& folder) {
  const std::vector<std::pair<std::string, double>> tissues{{"skin", 0.3489},
                                                            {"muscle", 0.0315},
                                                            {"ligament", 0.1808},
                                                            {"bone", 12.09},
                                                            {"upper_leg", 0.00389}};
  record::Table table{{"case", "step", "indentation_mm", "force_N"}, {}};
  std::vector<plot::Series> series;
  for (const auto& [name, force] : tissues) {
    std::vector<double> x, y;
    for (int i = 0; i <= 300; ++i) {
      x.push_back(i / 100.0);
      y.push_back(force * std::pow(x.back(), 1.5));
      table.rows.push_back({name, 1.0, x.back(), y.back()});
    }
    plot::Series each{.case_name = name, .scale = name == "bone" ? 0.1 : 1.0};
    each.fits.push_back(*fitted_curve(fit::regress(x, y, fit::Model::logarithmic)));
    series.push_back(each);
  }
  write_atomically(folder + "/force_indentation.csv", record::csv_text(table));
  plot::Figure figure = figure_of(Kind::force_depth, series);
  figure.fit_label = "a + b ln h";
  return figure;
}

plot::Figure strain_figure(const std::string& folder) {
  record::Table table{{"case", "step", "time_s", "stress_kPa", "strain"}, {}};
  std::vector<plot::Series> series;
  const std::vector<std::tuple<std::string, double, double>> tissues{
      {"muscle", 0.16, 0.5}, {"skin", 0.08, 0.9}, {"ligament", 0.12, 0.3}};
  for (const auto& [name, strain, tau] : tissues) {
    plot::Series each{.case_name = name};
    std::vector<double> x, up, down;
    for (int i = 0; i <= 400; ++i) {
      x.push_back(0.01 * i);
      up.push_back(strain * (1 - std::exp(-x.back() / tau)));
      table.rows.push_back({name, 1.0, x.back(), 1.0, up.back()});
    }
    std::vector<double> later;
    for (const double t : x) {
      later.push_back(t + 4.0);
      down.push_back(up.back() * std::exp(-t / tau));
      table.rows.push_back({name, 2.0, later.back(), 0.0, down.back()});
    }
    each.fits.push_back(*fitted_curve(fit::regress(x, up, fit::Model::kelvin_voigt)));
    each.fits.push_back(*fitted_curve(
        fit::regress(later, down, fit::Model::kelvin_voigt_recovery, {.x_origin = 4.0})));
    series.push_back(each);
  }
  write_atomically(folder + "/strain_time.csv", record::csv_text(table));
  return figure_of(Kind::strain_time, series);
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++found;
  return found;
}

TEST_F(Gnuplot, DrawsForceAgainstIndentation) {
  const plot::Drawing drawing = plot::draw(plot::sheet_of(force_figure(folder_)), folder_);
  EXPECT_EQ(drawing.warning, "");
  EXPECT_EQ(drawing.files, (std::vector<std::string>{"figure_force_indentation.gp",
                                                     "figure_force_indentation.svg"}));
  const std::string svg = read("figure_force_indentation.svg");
  for (const char* text : {">skin<", ">upper_leg<", ">bone × 0.1<", ">Effective depth h (mm)<",
                           ">Force F (N)<", ">a + b ln h<"})
    EXPECT_NE(svg.find(text), std::string::npos) << text;
  EXPECT_EQ(count(svg, "stroke-dasharray"), 6U);  // five fits and their line in the legend
}

TEST_F(Gnuplot, TheLegendNamesWhatItsEntriesAre) {
  plot::Figure figure = force_figure(folder_);
  figure.legend = "tissue.material";
  static_cast<void>(plot::draw(plot::sheet_of(figure), folder_));
  EXPECT_NE(read("figure_force_indentation.svg").find(">tissue.material<"), std::string::npos);
}

// gnuplot takes two apostrophes at the start of a text for an empty one; in double quotes it would
// run what stands between backquotes.
TEST_F(Gnuplot, DrawsTitlesWithAnyCharacter) {
  plot::Figure figure = force_figure(folder_);
  figure.title = "''tis \"it's\" `touch pwned` \\ \x1b";
  const plot::Drawing drawing = plot::draw(plot::sheet_of(figure), folder_);
  EXPECT_EQ(drawing.warning, "");
  const std::string svg = read("figure_force_indentation.svg");
  EXPECT_NE(svg.find("tis "), std::string::npos);
  EXPECT_NE(svg.find("`touch pwned`"), std::string::npos);
  EXPECT_EQ(svg.find('\x1b'), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ + "/pwned"));
}

TEST_F(Gnuplot, DrawsStrainAgainstTimeAsPdfToo) {
  const plot::Drawing drawing =
      plot::draw(plot::sheet_of(strain_figure(folder_)), folder_, {.formats = {"svg", "pdf"}});
  EXPECT_EQ(drawing.warning, "");
  ASSERT_EQ(drawing.files.size(), 3U);
  EXPECT_EQ(count(read("figure_strain_time.svg"), "stroke-dasharray"), 7U);  // three twice, legend
  EXPECT_TRUE(read("figure_strain_time.pdf").starts_with("%PDF"));
}

TEST_F(Gnuplot, SameFigureSameBytes) {
  plot::Figure figure = force_figure(folder_);
  static_cast<void>(plot::draw(plot::sheet_of(figure), folder_));
  const std::string first = read("figure_force_indentation.svg");
  static_cast<void>(plot::draw(plot::sheet_of(figure), folder_));
  EXPECT_TRUE(read("figure_force_indentation.svg") == first);
  figure.y_axis = plot::Axis::logarithmic;
  figure.y_low = 1e-4;
  figure.y_high = 100.0;
  static_cast<void>(plot::draw(plot::sheet_of(figure), folder_));
  EXPECT_TRUE(read("figure_force_indentation.svg") != first);
}

TEST_F(Gnuplot, ScriptRunsByItself) {
  write_atomically(folder_ + "/figure_force_indentation.gp", gnuplot_script(force_figure(folder_)));
  const ChildResult result =
      run_process({.argv = {"gnuplot", "figure_force_indentation.gp"}, .folder = folder_});
  EXPECT_EQ(result.output, "");
  EXPECT_TRUE(fs::exists(folder_ + "/figure_force_indentation.svg"));
}

// The file of many cases is read once, and with the same curves as where each case reads it.
TEST_F(Gnuplot, ReadsTheFileOfManyCasesOnce) {
  const auto drawn = [&](const std::string& mark) {
    record::Table table{{"case", "step", "indentation_mm", "force_N"}, {}};
    std::vector<plot::Series> series;
    for (int k = 1; k <= 12; ++k) {
      const std::string name = "E" + mark + std::to_string(k);  // one begins another
      for (int i = 0; i <= 20; ++i) table.rows.push_back({name, 1.0, 0.1 * i, 0.25 * k * i});
      series.push_back({.case_name = name, .label = "case " + std::to_string(k)});
    }
    table.rows.push_back({"not drawn", 1.0, 1.0, 1e6});
    write_atomically(folder_ + "/force_indentation.csv", record::csv_text(table));
    const plot::Drawing drawing =
        plot::draw(plot::sheet_of(figure_of(Kind::force_depth, series)), folder_);
    EXPECT_EQ(drawing.warning, "");
    return read("figure_force_indentation.svg");
  };
  const std::string once = drawn(" ");
  EXPECT_EQ(count(read("figure_force_indentation.gp"), "'force_indentation.csv'"), 1U);
  EXPECT_EQ(count(read("figure_force_indentation.gp"), " ? $2 : NaN):3 with "), 12U);
  const std::string each = drawn("|");
  EXPECT_EQ(count(read("figure_force_indentation.gp"), "'force_indentation.csv'"), 12U);
  EXPECT_EQ(once, each);
}

TEST_F(Gnuplot, StrangeNamesAreOnlyNames) {
  plot::Figure figure = force_figure(folder_);
  figure.series.resize(1);
  figure.series[0].label = "it's `echo x` \\ {a}_b %d\n\"quoted\" <&>";
  const plot::Drawing drawing = plot::draw(plot::sheet_of(figure), folder_);
  EXPECT_EQ(drawing.warning, "");
  // backquotes and format letters stay letters, and the XML is escaped
  EXPECT_NE(read("figure_force_indentation.svg")
                .find(">it's `echo x` \\ {a}_b %d \"quoted\" &lt;&amp;><"),
            std::string::npos);
}

TEST_F(Gnuplot, MissingProgramLeavesTheScript) {
  const plot::Drawing drawing =
      plot::draw(plot::sheet_of(force_figure(folder_)), folder_, {.program = "palpate-no-gnuplot"});
  EXPECT_EQ(drawing.files, std::vector<std::string>{"figure_force_indentation.gp"});
  EXPECT_TRUE(fs::exists(folder_ + "/figure_force_indentation.gp"));
  EXPECT_EQ(drawing.warning,
            "figure_force_indentation.svg was not drawn in " + folder_ +
                ": `palpate-no-gnuplot` is not installed; install gnuplot (Debian: gnuplot-nox) "
                "and run `gnuplot figure_force_indentation.gp` there");
}

TEST_F(Gnuplot, FailureIsAWarningAndKeepsTheOldPicture) {
  const plot::Figure figure = force_figure(folder_);
  static_cast<void>(plot::draw(plot::sheet_of(figure), folder_));
  const std::string before = read("figure_force_indentation.svg");
  plot::Figure broken = figure;
  broken.series[0].fits[0].formula = "no_such_function(x)";
  const plot::Drawing drawing = plot::draw(plot::sheet_of(broken), folder_);
  EXPECT_NE(drawing.warning.find("`gnuplot` failed ("), std::string::npos) << drawing.warning;
  EXPECT_NE(drawing.warning.find("no_such_function"), std::string::npos) << drawing.warning;
  EXPECT_EQ(drawing.warning.find('\n'), std::string::npos) << drawing.warning;
  EXPECT_TRUE(read("figure_force_indentation.svg") == before);
  EXPECT_EQ(files_in_folder(), 3);  // data, script, picture: nothing half written
  fs::remove(folder_ + "/force_indentation.csv");
  EXPECT_EQ(plot::draw(plot::sheet_of(figure), folder_).warning,
            "figure_force_indentation.svg was not drawn in " + folder_ +
                ": `force_indentation.csv` is missing; run the scenario again");
  EXPECT_TRUE(read("figure_force_indentation.svg") == before);
}

TEST_F(Gnuplot, APictureThatCannotTakeItsPlaceIsAnError) {
  fs::create_directories(folder_ + "/figure_force_indentation.svg/in_the_way");
  EXPECT_THROW(plot::draw(plot::sheet_of(force_figure(folder_)), folder_), SystemError);
}

TEST_F(Gnuplot, WhatGnuplotSaysIsPassedOn) {
  plot::Figure figure = force_figure(folder_);
  figure.series[1].y_column = "no_such_column";
  const plot::Drawing drawing = plot::draw(plot::sheet_of(figure), folder_);
  EXPECT_EQ(drawing.files.size(), 2U);
  EXPECT_NE(drawing.warning.find("may not be complete; gnuplot said"), std::string::npos)
      << drawing.warning;
}

// A curve of one value is complete: that gnuplot widens its range is nothing to warn of.
TEST_F(Gnuplot, AFlatCurveIsDrawnWithoutAWarning) {
  write_atomically(folder_ + "/flat.csv", "x_mm,force_N\n1,0\n2,0\n3,0\n");
  write_atomically(folder_ + "/one.csv", "x_mm,force_N\n1,0.84\n");
  for (const char* file : {"flat.csv", "one.csv"})
    for (const bool zero : {true, false}) {
      const plot::Figure figure{
          .name = "flat",
          .x_label = "x",
          .y_label = "y",
          .from_zero = zero,
          .series = {{.csv_file = file, .x_column = "x_mm", .y_column = "force_N"}}};
      const plot::Drawing drawing = plot::draw(plot::sheet_of(figure), folder_);
      EXPECT_EQ(drawing.warning, "") << file;
      EXPECT_TRUE(fs::exists(folder_ + "/flat.svg"));
    }
}

TEST_F(Gnuplot, TimeLimit) {
  const plot::Drawing drawing = plot::draw(plot::sheet_of(force_figure(folder_)), folder_,
                                           {.program = "gnuplot", .limit = 0});
  EXPECT_NE(drawing.warning.find("`gnuplot` took longer than 0 s"), std::string::npos)
      << drawing.warning;
}

TEST(FittedCurve, IsWhatTheFitSays) {
  fit::Fit fit{.model = fit::Model::logarithmic};
  fit.parameters = {{.name = "a", .estimate = 0.5}, {.name = "b", .estimate = -0.25}};
  fit.range_low = 0.1;
  fit.range_high = 3;
  EXPECT_EQ(fitted_curve(fit)->formula, "0.5 + (-0.25)*log(x)");
  EXPECT_EQ(fitted_curve(fit)->from, 0.1);
  fit.parameters[0].estimate = fit::Estimate::unknown;
  EXPECT_FALSE(fitted_curve(fit).has_value());
}

// Sixty letters fit a picture of the width of a telephone; more of them are smaller.
TEST(GnuplotTitle, FitsWhereItIsLong) {
  EXPECT_EQ(plot::gnuplot_title("Skin"), "'Skin'");
  const std::string title(90, 'a');
  EXPECT_EQ(plot::gnuplot_title(title), "'" + title + "' font ',10'");
}

}  // namespace
}  // namespace palpate::report
