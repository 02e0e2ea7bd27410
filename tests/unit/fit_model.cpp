// The table of models: names, units, slopes.
#include "fit/regression.h"

#include <gtest/gtest.h>

#include <cmath>

namespace palpate::fit {
namespace {

TEST(Model, NamesFindTheirModels) {
  for (const ModelInfo& row : models()) {
    EXPECT_EQ(find_model(row.name), row.model);
    EXPECT_EQ(info(row.model).name, row.name);
  }
  EXPECT_FALSE(find_model("linear").has_value());
}

TEST(Model, UnitsFollowTheColumns) {
  EXPECT_EQ(column_unit("force_N"), "N");
  EXPECT_EQ(column_unit("indentation_mm"), "mm");
  EXPECT_EQ(column_unit("strain"), "");
  EXPECT_EQ(column_unit("bulk_ratio"), "");
  EXPECT_EQ(unit_text(UnitRule::y_per_x_to_n, "mm", "N"), "N/mm^n");
  EXPECT_EQ(unit_text(UnitRule::y_per_x_to_n, "mm", ""), "1/mm^n");
  EXPECT_EQ(unit_text(UnitRule::per_x, "mm", "N"), "1/mm");
  EXPECT_EQ(unit_text(UnitRule::of_x, "s", ""), "s");
  EXPECT_EQ(unit_text(UnitRule::none, "mm", "N"), "");
}

TEST(Model, SlopesAreTheDerivatives) {
  for (const ModelInfo& row : models()) {
    if (!has_shape(row.model)) continue;
    for (const double x : {0.1, 1.0, 2.7})
      for (const double shape : {0.4, 1.3}) {
        const double step = 1e-5;
        const auto up = terms(row.model, x, shape + step);
        const auto down = terms(row.model, x, shape - step);
        for (std::size_t k = 0; k < 2; ++k)  // step^2 f'''/6, f''' up to 1e3
          EXPECT_NEAR(slopes(row.model, x, shape)[k], (up[k] - down[k]) / (2 * step), 2e-7)
              << row.name;
      }
  }
}

TEST(Model, ValuesAtKnownPlaces) {
  const double e = std::exp(1.0);
  const auto at = [](Model model, std::vector<double> parameters, double x) {
    return value(model, parameters, x);
  };
  EXPECT_DOUBLE_EQ(at(Model::logarithmic, {2, 3}, e), 5);
  EXPECT_DOUBLE_EQ(at(Model::power, {2, 1.5}, 4), 16);
  EXPECT_DOUBLE_EQ(at(Model::exponential, {2, 0.5}, 2), 2 * (e - 1));
  EXPECT_DOUBLE_EQ(at(Model::kelvin_voigt, {2, 0.5}, 0.5), 2 * (1 - 1 / e));
  EXPECT_DOUBLE_EQ(at(Model::kelvin_voigt_recovery, {2, 0.5}, 0.5), 2 / e);
  EXPECT_DOUBLE_EQ(at(Model::standard_linear_solid, {1, 3, 0.5}, 0.5), 1 + 2 / e);
}

}  // namespace
}  // namespace palpate::fit
