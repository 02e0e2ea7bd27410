// Which figures a family gets, and what their legends call the fits.
#include <gtest/gtest.h>

#include "plot/gnuplot.h"
#include "report/family_figures.h"

namespace palpate {
namespace {

plot::Figure only_figure(const std::string& text) {
  const auto family = scenario::parse(text, "test.toml", {});
  record::CaseRecord record;
  record.name = "test";
  const auto figures = report::family_figures(family, {record}, {});
  EXPECT_EQ(figures.size(), 1U);
  return figures.at(0);
}

TEST(FamilyFigures, NameTheFitThatIsDrawn) {
  const std::string creep = "[[step]]\nkind = \"creep\"\n";
  const std::string solid = "[tissue]\nviscosity = \"standard_linear_solid\"\n";
  EXPECT_EQ(only_figure("schema = 1\n" + creep).fit_label, "Kelvin-Voigt fit");
  EXPECT_EQ(only_figure("schema = 1\n" + solid + creep).fit_label, "Standard linear solid fit");
  const auto relax = only_figure("schema = 1\n" + solid + "[[step]]\nkind = \"relax\"\n");
  EXPECT_EQ(relax.name, "figure_stress_time");
  EXPECT_EQ(relax.fit_label, "Standard linear solid fit");
  EXPECT_EQ(relax.series.at(0).y_column, "stress_kPa");
}

const std::string indent = "[[step]]\nkind = \"indent\"\n";

TEST(FamilyFigures, ASlideIsDrawnAlongItsWay) {
  const auto drawn = [](const std::string& keep) {
    const auto family = scenario::parse(
        "schema = 1\n" + indent + "[[step]]\nkind = \"slide\"\nkeep = \"" + keep + "\"\n",
        "test.toml", {});
    record::CaseRecord record;
    record.name = "test";
    return report::family_figures(family, {record}, {});
  };
  const auto force = drawn("displacement");
  ASSERT_EQ(force.size(), 2U);
  EXPECT_EQ(force[1].series.at(0).step, 1);  // the slide is no indentation
  EXPECT_EQ(force[0].name, "figure_force_slide") << "what is asked for comes first";
  EXPECT_EQ(force[0].series.at(0).x_column, "slide_mm");
  EXPECT_EQ(force[0].series.at(0).y_column, "force_N");
  EXPECT_EQ(force[0].series.at(0).step, 2);
  // Where the force stays, the travel is what is felt.
  const auto travel = drawn("force");
  ASSERT_EQ(travel.size(), 2U);
  EXPECT_EQ(travel[0].name, "figure_displacement_slide");
  EXPECT_EQ(travel[0].series.at(0).y_column, "travel_mm");
}

TEST(FamilyFigures, AHoldIsDrawnOverTime) {
  const auto family =
      scenario::parse("schema = 1\n" + indent + "[[step]]\nkind = \"hold\"\n", "test.toml", {});
  record::CaseRecord record;
  record.name = "test";
  const auto figures = report::family_figures(family, {record}, {});
  ASSERT_EQ(figures.size(), 2U);
  EXPECT_EQ(figures[1].name, "figure_force_time");
  EXPECT_EQ(figures[1].series.at(0).x_column, "time_s");
}

TEST(FamilyFigures, TheDeviceIsDrawnBesideTheModel) {
  const auto family = scenario::parse("schema = 1\n" + indent, "test.toml", {});
  record::CaseRecord record;
  record.name = "test";
  record.contact.resize(1);
  record.measured.resize(1);
  EXPECT_EQ(report::family_figures(family, {record}, {}).size(), 1U) << "no force was measured";
  record.measured[0].force = 1.0;
  const auto figures = report::family_figures(family, {record}, {});
  ASSERT_EQ(figures.size(), 2U);
  EXPECT_EQ(figures[1].name, "figure_live_force");
  EXPECT_EQ(figures[1].series.at(0).y_column, "force_N");
  EXPECT_EQ(figures[1].series.at(1).y_column, "measured_force_N");
}

// The way to the surface, which may be twenty times as long, leaves the curve no room.
TEST(FamilyFigures, ALiveCurveBeginsAtTheContact) {
  const auto family =
      scenario::parse("schema = 1\n" + indent + "[[step]]\nkind = \"hold\"\n", "test.toml", {});
  record::CaseRecord record;
  record.name = "test";
  record.contact.resize(2);
  record.contact[0].travel = -20e-3;
  record.contact[1].travel = 2e-3;
  EXPECT_FALSE(report::family_figures(family, {record}, {}).at(0).series.at(0).x_from);
  record.measured.resize(2);
  record.measured[1].sent = {0.0, 0.0, 1.0};
  const auto figures = report::family_figures(family, {record}, {});
  ASSERT_EQ(figures.size(), 2U) << "force over time stands with what was sent, and once";
  EXPECT_DOUBLE_EQ(figures[0].series.at(0).x_from.value(), -0.1);  // mm, a twentieth
  EXPECT_NE(plot::gnuplot_script(figures[0]).find("column('travel_mm') >= -0.1 ?"),
            std::string::npos);
  EXPECT_EQ(figures[1].name, "figure_live_force");
  EXPECT_TRUE(figures[1].series.at(1).dashed) << "it lies on the model's line";
}

TEST(FamilyFigures, RegressionsAreDrawnWhereTheyAreAskedFor) {
  fit::Fit fit{.model = fit::Model::logarithmic, .r2 = 0.671};
  fit.parameters = {{.name = "a", .estimate = 0.5}, {.name = "b", .estimate = 0.25}};
  record::CaseRecord record;
  record.name = "test";
  const auto drawn = [&](const std::string& more) {
    const auto family = scenario::parse("schema = 1\n" + indent + more, "test.toml", {});
    return report::family_figures(family, {record}, {{"test", "force_indentation", fit}}).at(0);
  };
  EXPECT_TRUE(drawn("").series.at(0).fits.empty());
  // A modulus read off the effective depth of a mesh would be wrong; fits are of it, though.
  EXPECT_EQ(drawn("").series.at(0).x_column, "travel_mm");
  const auto asked = drawn("[output]\nregression = \"logarithmic\"\n");
  EXPECT_EQ(asked.series.at(0).fits.size(), 1U);
  EXPECT_EQ(asked.series.at(0).x_column, "indentation_mm");
  EXPECT_EQ(asked.fit_label, "a + b ln h, R² 0.67");
}

TEST(FamilyFigures, DecadesStandOnLogarithmicAxesBesideTheLinearOnes) {
  const auto drawn = [](double ratio) {
    const auto family = scenario::parse("schema = 1\n" + indent, "test.toml", {});
    std::vector<record::CaseRecord> records(2);
    for (auto& record : records) record.contact.resize(1);
    for (auto& record : records) record.contact[0].travel = 3e-3;
    records[0].contact[0].force = 1.0;
    records[1].contact[0].force = ratio;
    return report::family_figures(family, records, {});
  };
  EXPECT_EQ(drawn(29.0).size(), 1U);
  EXPECT_EQ(drawn(31.0).size(), 2U);
  EXPECT_EQ(drawn(31.0).at(0).y_axis, plot::Axis::linear);
  EXPECT_TRUE(drawn(31.0).at(0).from_zero);
  const plot::Figure decades = drawn(31.0).at(1);
  EXPECT_EQ(decades.x_axis, plot::Axis::logarithmic);
  EXPECT_EQ(decades.x_high, 3.0);
  EXPECT_EQ(decades.y_axis, plot::Axis::logarithmic);
  EXPECT_EQ(decades.y_low, 0.01);
  EXPECT_EQ(decades.y_high, 46.5);
}

TEST(FamilyFigures, ATissueHasItsColourAndTheLegendItsKey) {
  const auto family = scenario::parse(
      "schema = 1\n" + indent + "[sweep]\n\"tissue.material\" = [\"bone\", \"skin\"]\n",
      "test.toml", {});
  std::vector<record::CaseRecord> records(2);
  for (std::size_t i = 0; i < 2; ++i) records[i].name = family.cases[i].name;
  const plot::Figure figure = report::family_figures(family, records, {}).at(0);
  EXPECT_EQ(figure.legend, "Material");
  EXPECT_EQ(figure.series.at(0).colour, 3U);
  EXPECT_EQ(figure.series.at(1).colour, 0U);
}

TEST(FamilyFigures, ManyCasesAreColouredByTheSweptNumber) {
  const auto drawn = [](const std::string& depths) {
    const auto family =
        scenario::parse("schema = 1\n" + indent +
                            "[sweep]\n\"tissue.material\" = [\"skin\", \"muscle\"]\n"
                            "\"step.1.to\" = [" +
                            depths + "]\n",
                        "test.toml", {});
    std::vector<record::CaseRecord> records;
    for (const auto& one : family.cases) {
      records.emplace_back();
      records.back().name = one.name;
    }
    return report::family_figures(family, records, {}).at(0);
  };
  EXPECT_FALSE(drawn("\"1 mm\", \"2 mm\", \"3 mm\", \"4 mm\"").bar) << "eight have a legend";
  const auto many = drawn("\"1 mm\", \"2 mm\", \"3 mm\", \"4 mm\", \"5 mm\"");
  ASSERT_TRUE(many.bar);
  EXPECT_EQ(many.bar->label, "Step 1 to (mm)");
  EXPECT_EQ(many.bar->high, 5.0);
  EXPECT_EQ(many.series.at(1).shade, 2.0);
  EXPECT_EQ(many.series.at(9).label, "muscle");
}

// The curves of hundreds of cases are a surface, and their drawing took minutes.
TEST(FamilyFigures, OfHundredsOfCasesSomeAreDrawn) {
  const auto family = scenario::parse("schema = 1\ntitle = \"T\"\n" + indent +
                                          "[sweep]\n\"tissue.young_modulus\" = { from = \"1 kPa\", "
                                          "to = \"9 kPa\", points = 300 }\n",
                                      "test.toml", {});
  std::vector<record::CaseRecord> records(family.cases.size());
  for (std::size_t i = 0; i < records.size(); ++i) records[i].name = family.cases[i].name;
  const plot::Figure figure = report::family_figures(family, records, {}).at(0);
  ASSERT_EQ(figure.series.size(), 64U);
  EXPECT_EQ(figure.series.front().case_name, records.front().name);
  EXPECT_EQ(figure.series.back().case_name, records.back().name);
  EXPECT_EQ(figure.title, "T (64 of 300 cases)");
}

TEST(FamilyFigures, CurvaturesAreDrawnWhereThreeDiffer) {
  const auto family = scenario::parse(
      "schema = 1\n" + indent + "[sweep]\n\"tissue.material\" = [\"skin\", \"muscle\"]\n",
      "test.toml", {});
  const auto drawn = [&](const std::vector<double>& curvatures) {
    std::vector<record::CaseRecord> records;
    for (const double curvature : curvatures) {
      record::CaseRecord record;
      record.findings.push_back({"local_curvature_per_m", curvature});
      records.push_back(record);
    }
    return report::family_figures(family, records, {});
  };
  EXPECT_EQ(drawn({1.0, 2.0, 1.0}).size(), 1U);
  const auto figures = drawn({1.0, 2.0, 3.0});
  ASSERT_EQ(figures.size(), 2U);
  EXPECT_EQ(figures[1].name, "figure_force_curvature");
  ASSERT_EQ(figures[1].series.size(), 2U);  // a curve a tissue
  EXPECT_EQ(figures[1].series[1].case_name, "muscle");
  EXPECT_EQ(figures[1].series[1].column, "tissue.material");
}

}  // namespace
}  // namespace palpate
