// Which figures a family gets, and what their legends call the fits.
#include <gtest/gtest.h>

#include "report/family_figures.h"

namespace palpate {
namespace {

report::Figure only_figure(const std::string& text) {
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

}  // namespace
}  // namespace palpate
