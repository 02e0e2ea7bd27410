// `palpate fit` on tables of a user's: known answers, what is excluded, messages, no library's log.
#include <gtest/gtest.h>

#include <cmath>

#include "program.h"
#include "record/csv.h"

namespace palpate::test {
namespace {

class FitVerb : public testing::Test {
 protected:
  Ended fit(const std::string& csv, const std::string& model,
            const std::vector<std::string>& more = {}) {
    write_file(folder_ / "data.csv", csv);
    return palpate(folder_.path(),
                   {"fit", "data.csv", "--x", "depth_mm", "--y", "force_N", "--model", model},
                   more);
  }

  // The table on stdout.
  record::Table table(const Ended& ended) {
    EXPECT_EQ(ended.code, 0) << ended.err;
    write_file(folder_ / "fit.csv", ended.out);
    return record::read_csv((folder_ / "fit.csv").string());
  }

  static record::Cell cell(const record::Table& table, const std::string& parameter,
                           const std::string& column) {
    for (const auto& row : table.rows)
      if (row[static_cast<std::size_t>(table.find("parameter"))] == record::Cell(parameter))
        return row[static_cast<std::size_t>(table.find(column))];
    ADD_FAILURE() << "no parameter " << parameter;
    return std::monostate{};
  }
  static double number(const record::Table& table, const std::string& parameter,
                       const std::string& column) {
    const record::Cell found = cell(table, parameter, column);
    const double* value = std::get_if<double>(&found);
    return value != nullptr ? *value : std::nan("");
  }

  TemporaryFolder folder_;
};

// ln x = 0, 1, 2 against y = 0, 1, 1: b = 1/2, a = 1/6, residuals -1/6, 1/3, -1/6, their squares'
// sum 1/6, one degree of freedom, s^2(b) = (1/6) / 2, t(0.975, 1) = 12.7062047.
TEST_F(FitVerb, logarithmic_by_hand) {
  const record::Table fitted =
      table(fit("depth_mm,force_N\n1,0\n2.718281828459045,1\n7.38905609893065,1\n", "logarithmic"));
  EXPECT_NEAR(number(fitted, "a", "estimate"), 1.0 / 6.0, 1e-12);  // rounding
  EXPECT_NEAR(number(fitted, "b", "estimate"), 0.5, 1e-12);        // rounding
  const double error = std::sqrt(1.0 / 12.0);
  EXPECT_NEAR(number(fitted, "b", "std_error"), error, 1e-9);  // through a covariance
  EXPECT_NEAR(number(fitted, "b", "ci95_high"), 0.5 + 12.706204736432095 * error,
              1e-6);                                    // t's digits
  EXPECT_NEAR(number(fitted, "b", "r2"), 0.75, 1e-12);  // 1 - (1/6) / (2/3), rounding
  EXPECT_EQ(cell(fitted, "b", "unit"), record::Cell("N"));
  EXPECT_EQ(cell(fitted, "b", "n"), record::Cell(3.0));
  EXPECT_EQ(cell(fitted, "b", "range_low"), record::Cell(1.0));
  EXPECT_EQ(cell(fitted, "b", "curve"), record::Cell("force_N over depth_mm"));
}

TEST_F(FitVerb, power_of_a_parabola) {
  const record::Table fitted =
      table(fit("depth_mm,force_N\n1,3\n2,12\n3,27\n4,48\n", "power"));  // 3 x^2
  EXPECT_NEAR(number(fitted, "A", "estimate"), 3.0, 1e-7);               // the solver's own end
  EXPECT_NEAR(number(fitted, "n", "estimate"), 2.0, 1e-7);
  EXPECT_EQ(cell(fitted, "A", "unit"), record::Cell("N/mm^n"));
  EXPECT_EQ(cell(fitted, "n", "termination"), record::Cell("converged"));
}

TEST_F(FitVerb, kelvin_voigt_from_an_origin) {
  std::string csv = "depth_mm,force_N\n";
  for (int i = 0; i <= 20; ++i) {
    const double x = 0.1 * i;
    csv += std::to_string(x + 5.0) + "," + std::to_string(4.0 * (1.0 - std::exp(-x / 0.5))) + "\n";
  }
  const record::Table fitted = table(fit(csv, "kelvin_voigt", {"--origin", "5"}));
  EXPECT_NEAR(number(fitted, "y_inf", "estimate"), 4.0, 1e-5);  // six printed digits
  EXPECT_NEAR(number(fitted, "tau", "estimate"), 0.5, 1e-5);    // the same
  EXPECT_EQ(cell(fitted, "tau", "unit"), record::Cell("mm"));
}

TEST_F(FitVerb, what_has_no_logarithm_is_left_out_and_counted) {
  const Ended ended =
      fit("depth_mm,force_N\n-1,9\n0,9\n1,2\n2.718281828459045,5\n7.38905609893065,8\n,4\n",
          "logarithmic");
  const record::Table fitted = table(ended);
  EXPECT_NEAR(number(fitted, "a", "estimate"), 2.0, 1e-9);  // y = 2 + 3 ln x, rounding
  EXPECT_NEAR(number(fitted, "b", "estimate"), 3.0, 1e-9);
  EXPECT_EQ(cell(fitted, "a", "n"), record::Cell(3.0));
  EXPECT_EQ(ended.err,
            "note: the curve is met exact to rounding, so that the intervals are no errors of a "
            "measurement\n"
            "note: 3 points are excluded: not finite, or x <= 0 where its logarithm is needed\n");
}

TEST_F(FitVerb, one_case_of_a_result) {
  write_file(folder_ / "data.csv",
             "case,depth_mm,force_N\na,1,1\nb,1,5\na,2,4\nb,2,5\na,3,9\nb,3,5\n");
  const record::Table fitted =
      table(palpate(folder_.path(), {"fit", "data.csv", "--x", "depth_mm", "--y", "force_N",
                                     "--model", "power", "--case", "a"}));
  EXPECT_EQ(cell(fitted, "n", "case"), record::Cell("a"));
  EXPECT_NEAR(number(fitted, "n", "estimate"), 2.0, 1e-7);  // the solver's own end
}

TEST_F(FitVerb, messages) {
  const std::string csv = "depth_mm,force_N\n1,3\n2,12\n3,x\n";
  Ended ended = fit(csv, "powr");
  EXPECT_EQ(ended.code, 2);
  EXPECT_EQ(ended.err, "palpate: `--model` does not know `powr`; did you mean `power`?\n");
  ended = fit(csv, "zzzzzzzzzzzz");
  EXPECT_EQ(ended.code, 2);
  EXPECT_TRUE(says(ended, "does not know `zzzzzzzzzzzz`; it is one of logarithmic, power,"))
      << ended.err;
  ended = fit(csv, "power");
  EXPECT_EQ(ended.code, 2);
  EXPECT_EQ(ended.err,
            "data.csv:4:3: `force_N` holds `x`, which is no number; name a column of numbers\n");
  ended = palpate(folder_.path(),
                  {"fit", "data.csv", "--x", "dept_mm", "--y", "force_N", "--model", "power"});
  EXPECT_EQ(ended.code, 2);
  EXPECT_EQ(ended.err, "data.csv:1: has no column `dept_mm`; did you mean `depth_mm`?\n");
  ended =
      palpate(folder_.path(), {"fit", "nothing.csv", "--x", "a", "--y", "b", "--model", "power"});
  EXPECT_EQ(ended.code, 2);
  EXPECT_TRUE(says(ended, "nothing.csv: cannot be read: No such file or directory")) << ended.err;
}

TEST_F(FitVerb, too_few_points) {
  const Ended ended = fit("depth_mm,force_N\n1,3\n", "power");
  EXPECT_EQ(ended.code, 2);
  EXPECT_TRUE(says(ended, "data.csv: ")) << ended.err;
  EXPECT_EQ(ended.out, "");
}

// 4/3 E / (1 - nu^2) sqrt(R) (h - h_0)^(3/2) of E = 50 kPa, nu = 0.5, R = 9 mm, h_0 = 0.5 mm, in
// other units, with a load cell that reads compression negative.
TEST_F(FitVerb, hertz_of_a_machine_s_file) {
  std::string text = "Rate;1 mm/s\n\nWeg (mm);Kraft (mN)\n";
  for (int i = 0; i <= 30; ++i) {
    const double depth = std::max(0.0, 0.1 * i - 0.5);
    const double force =
        4.0 / 3.0 * 50e3 / 0.75 * std::sqrt(9e-3) * std::pow(1e-3 * depth, 1.5) * 1e3;
    text += std::to_string(0.1 * i) + ";" + std::to_string(-force) + "\n";
  }
  for (char& c : text)
    if (c == '.') c = ',';
  write_file(folder_ / "liver.txt", text);
  const Ended ended =
      palpate(folder_.path(), {"fit", "liver.txt", "--x", "weg", "--y", "kraft", "--model", "hertz",
                               "--radius", "9 mm", "--poisson", "0.5", "--compression", "auto"});
  const record::Table fitted = table(ended);
  EXPECT_NEAR(number(fitted, "E", "estimate"), 50.0, 1e-4);  // six decimals of mN and mm
  EXPECT_NEAR(number(fitted, "h_0", "estimate"), 0.5, 1e-5);
  EXPECT_EQ(cell(fitted, "E", "unit"), record::Cell("kPa"));
  EXPECT_EQ(cell(fitted, "h_0", "unit"), record::Cell("mm"));
  EXPECT_EQ(cell(fitted, "E", "model"), record::Cell("hertz"));
  EXPECT_EQ(cell(fitted, "E", "curve"), record::Cell("Kraft (mN) over Weg (mm)"));
  EXPECT_TRUE(says(ended, "note: `Kraft (mN)` is negative in compression; sign changed\n"));
  // sqrt(R h) with h = 2.5 mm against Sneddon's sphere of 9 mm: 2.9 %.
  EXPECT_TRUE(says(ended,
                   "Hertz's law of a paraboloid is 2.9 % stiffer than the exact law of a "
                   "sphere; give `--tip sphere`"))
      << ended.err;
  EXPECT_EQ(cell(fitted, "E", "law"),
            record::Cell("F = 4/3 E/(1-nu^2) sqrt(R) (h-h_0)^(3/2), Hertz 1881, Sneddon 1965, "
                         "with a force offset"));
  EXPECT_EQ(cell(fitted, "E", "excluded"), record::Cell(0.0));
}

TEST_F(FitVerb, prony_of_two_terms) {
  std::string csv = "t_s,stress_kPa\n";
  for (int i = 0; i <= 200; ++i) {
    const double t = 0.05 * i;
    csv += std::to_string(t) + "," +
           std::to_string(1e3 * (1 + 2 * std::exp(-t / 0.2) + std::exp(-t / 3.0))) + "\n";
  }
  write_file(folder_ / "data.csv", csv);
  const record::Table fitted =
      table(palpate(folder_.path(), {"fit", "data.csv", "--x", "t_s", "--y", "stress_kPa",
                                     "--model", "prony", "--terms", "2"}));
  EXPECT_NEAR(number(fitted, "tau_1", "estimate"), 0.2, 1e-6);  // nine printed digits
  EXPECT_NEAR(number(fitted, "tau_2", "estimate"), 3.0, 1e-5);
  EXPECT_NEAR(number(fitted, "y_inf", "estimate"), 1000.0, 1e-3);
  EXPECT_EQ(cell(fitted, "tau_1", "unit"), record::Cell("s"));
  EXPECT_EQ(cell(fitted, "tau_1", "model"), record::Cell("prony"));
}

TEST_F(FitVerb, options_of_the_models) {
  const std::string csv = "depth_mm,force_N\n1,3\n2,12\n3,27\n4,48\n";
  const auto refusal = [&](const std::string& model, const std::vector<std::string>& more) {
    const Ended ended = fit(csv, model, more);
    EXPECT_EQ(ended.code, 2);
    EXPECT_EQ(ended.out, "");
    return ended.err;
  };
  EXPECT_EQ(refusal("hertz", {}),
            "palpate: the model `hertz` wants `--poisson`; write it as `--poisson 0.45`\n");
  EXPECT_EQ(refusal("hertz", {"--poisson", "0.4"}),
            "palpate: the model `hertz` wants `--radius`; write it as `--radius \"11 mm\"`\n");
  EXPECT_EQ(refusal("layer", {"--radius", "11 mm", "--poisson", "0.4"}),
            "palpate: the model `layer` wants `--thickness`; write it as `--thickness \"5 mm\"`\n");
  EXPECT_EQ(refusal("prony", {}),
            "palpate: the model `prony` wants `--terms`; write it as `--terms 2`\n");
  EXPECT_EQ(refusal("power", {"--radius", "11 mm"}),
            "palpate: `--radius` is not used by the model `power`; leave it out\n");
  EXPECT_EQ(refusal("hertz", {"--radius", "11 kPa", "--poisson", "0.4"}),
            "palpate: `--radius` wants a length, got `11 kPa`, a pressure; write it as `11 mm`\n");
  EXPECT_EQ(refusal("hertz", {"--radius", "0 mm", "--poisson", "0.4"}),
            "palpate: `--radius` is `0 mm`; give a length above 0\n");
  EXPECT_EQ(refusal("layer", {"--radius", "11 mm", "--poisson", "0.4", "--thickness", "9 mm",
                              "--base", "glued"}),
            "palpate: `--base` does not know `glued`; it is one of bonded, frictionless\n");
  EXPECT_EQ(refusal("hertz", {"--tip", "conus", "--poisson", "0.4"}),
            "palpate: `--tip` does not know `conus`; did you mean `cone`?\n");
  EXPECT_EQ(
      refusal("hertz", {"--tip", "cone", "--poisson", "0.4"}),
      "palpate: the tip `cone` wants `--half-angle`; write it as `--half-angle \"20 deg\"`\n");
  EXPECT_EQ(refusal("hertz", {"--radius", "11 mm", "--poisson", "0.4", "--to", "2"}),
            "palpate: `--to` is `2`; give a share from 0 to 100 %, or a depth as `1 mm`\n");
  EXPECT_EQ(refusal("hertz", {"--radius", "11 mm", "--poisson", "0.4", "--y-unit", "kPa"}),
            "data.csv: `force_N` is a pressure, and this model wants a force; name another column "
            "with `--y`, or give `--y-unit N`\n");
  EXPECT_EQ(refusal("hertz", {"--radius", "11 mm", "--poisson", "0.4", "--origin", "1"}),
            "palpate: `--origin` is not used by the model `hertz`, which fits the contact "
            "point; leave it out\n");
}

// Curves that no model's parameters can follow: Ceres fails or stops, glog would say so. A search
// without a minimum is an error.
TEST_F(FitVerb, no_library_talks_even_where_a_fit_fails) {
  for (const char* model : {"logarithmic", "power", "exponential", "kelvin_voigt",
                            "kelvin_voigt_recovery", "standard_linear_solid"})
    for (const auto& [csv, refused] :
         {std::pair{"depth_mm,force_N\n1,1e308\n2,-1e308\n3,1e308\n4,-1e308\n", false},
          std::pair{"depth_mm,force_N\n1e300,1\n2e300,5\n3e300,-7\n4e300,1e-300\n", false},
          std::pair{"depth_mm,force_N\n1,0\n1,0\n1,0\n1,0\n", false},
          std::pair{"depth_mm,force_N\nnan,1\ninf,2\n1,nan\n2,-inf\n", true}}) {  // no point
      const Ended ended = fit(csv, model);
      EXPECT_TRUE(ended.code == 2 || (ended.code == 0 && !refused)) << model << ": " << ended.err;
      EXPECT_EQ(ended.code == 0, !ended.out.empty()) << model << ": " << ended.out;
      const bool ours = ended.err.empty() || ended.err.starts_with("data.csv: ") ||
                        ended.err.starts_with("note: ") || ended.err.starts_with("warning: ");
      EXPECT_TRUE(ours) << model << " on\n" << csv << "says\n" << ended.err;
      EXPECT_EQ(ended.err.find(".cc:"), std::string::npos) << "a line of glog:\n" << ended.err;
    }
}

}  // namespace
}  // namespace palpate::test
