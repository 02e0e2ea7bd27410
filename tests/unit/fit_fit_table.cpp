// fits.csv: the columns of the manual, and nothing where nothing is known.
#include "fit/case_fits.h"

#include <gtest/gtest.h>

#include <cmath>

#include "record/csv.h"

namespace palpate::fit {
namespace {

TEST(FitTable, HasTheManualsColumns) {
  EXPECT_EQ(record::csv_text(fit_table({})),
            "case,curve,model,parameter,unit,estimate,std_error,ci95_low,ci95_high,r2,rmse,n,"
            "range_low,range_high,termination\n");
}

TEST(FitTable, OneRowAParameter) {
  Fit fit{.model = Model::power};
  fit.parameters = {{.name = "A",
                     .unit = "N/mm^n",
                     .estimate = 0.5,
                     .std_error = 0.25,
                     .ci95_low = -0.5,
                     .ci95_high = 1.5},
                    {.name = "n", .estimate = 1.5}};
  fit.r2 = 0.75;
  fit.rmse = 0.125;
  fit.n = 30;
  fit.range_low = 0.1;
  fit.range_high = 3;
  fit.termination = Termination::not_converged;
  const std::vector<NamedFit> fits{{"skin", "force_indentation", fit}};
  const std::string text = record::csv_text(fit_table(fits));
  EXPECT_EQ(text.substr(text.find('\n') + 1),
            "skin,force_indentation,power,A,N/mm^n,0.5,0.25,-0.5,1.5,0.75,0.125,30,0.1,3,"
            "not_converged\n"
            "skin,force_indentation,power,n,,1.5,,,,0.75,0.125,30,0.1,3,not_converged\n");
}

}  // namespace
}  // namespace palpate::fit
