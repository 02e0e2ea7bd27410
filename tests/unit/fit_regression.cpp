// Fits against closed forms: the normal equations, exact data, the intervals' coverage.
#include "fit/regression.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "base/error.h"
#include "fitted_value.h"

namespace palpate::fit {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Skin under the finger at h = 0.1, 0.2 ... 3.0 mm: F = 4/3 E* sqrt(R) h^(3/2) with the E* of case
// hertz-01 and R = 11 mm; h in mm, F in N.
constexpr double contact_modulus = 78902.531;  // Pa
struct Samples {
  std::vector<double> x;
  std::vector<double> y;
};
Samples skin() {
  Samples curve;
  for (int i = 1; i <= 30; ++i) {
    const double depth = i * 1e-4;  // m
    curve.x.push_back(i / 10.0);
    curve.y.push_back(4.0 / 3.0 * contact_modulus * std::sqrt(0.011) * depth * std::sqrt(depth));
  }
  return curve;
}

Samples noisy(Samples curve, double size, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> noise(0.0, size);
  for (double& y : curve.y) y += noise(generator);
  return curve;
}

Samples sampled(Model model, const std::vector<double>& parameters, double to) {
  Samples curve;
  for (int i = 1; i <= 40; ++i) {
    curve.x.push_back(to * i / 40.0);
    curve.y.push_back(value(model, parameters, curve.x.back()));
  }
  return curve;
}

// Straight-line least squares of y on z by the normal equations in centred sums.
struct Line {
  double a, b, var_a, var_b, cov_ab;
};
Line normal_equations(const std::vector<double>& z, const std::vector<double>& y) {
  const auto n = static_cast<double>(z.size());
  double zm = 0, ym = 0;
  for (std::size_t i = 0; i < z.size(); ++i) zm += z[i] / n, ym += y[i] / n;
  double szz = 0, szy = 0, sse = 0;
  for (std::size_t i = 0; i < z.size(); ++i) {
    szz += (z[i] - zm) * (z[i] - zm);
    szy += (z[i] - zm) * (y[i] - ym);
  }
  const double b = szy / szz, a = ym - b * zm;
  for (std::size_t i = 0; i < z.size(); ++i) sse += std::pow(y[i] - a - b * z[i], 2);
  const double s2 = sse / (n - 2);
  return {a, b, s2 * (1 / n + zm * zm / szz), s2 / szz, -s2 * zm / szz};
}

// a + b ln x is the one model linear in all its parameters, so that it has a closed form.
TEST(Regression, LogarithmicIsTheNormalEquations) {
  const Samples curve = noisy(skin(), 0.02, 5);
  std::vector<double> z;
  for (const double x : curve.x) z.push_back(std::log(x));
  const Line line = normal_equations(z, curve.y);
  const Fit fit = regress(curve.x, curve.y, Model::logarithmic);
  const auto near = [](double got, double want) {
    EXPECT_NEAR(got, want, 1e-10 * std::abs(want));  // rounding of 30 terms, and Ceres' own stop
  };
  near(fit.parameters[0].estimate, line.a);
  near(fit.parameters[1].estimate, line.b);
  near(fit.parameters[0].std_error, std::sqrt(line.var_a));
  near(fit.parameters[1].std_error, std::sqrt(line.var_b));
  near(fit.covariance(0, 0), line.var_a);
  near(fit.covariance(0, 1), line.cov_ab);
  near(fit.covariance(1, 1), line.var_b);
  const double t = 2.048407141795244;  // t_0.975 at 28 degrees
  near(fit.parameters[1].ci95_high, line.b + t * std::sqrt(line.var_b));
}

// Power's linearisation ln y = ln A + n ln x is linear too, and is what log-05 speaks of: with
// ln y as the data of the logarithmic model, a is ln A and b is n.
TEST(Regression, LinearisedPowerIsTheNormalEquations) {
  const Samples curve = noisy(skin(), 0.001, 6);
  std::vector<double> z, log_y;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    z.push_back(std::log(curve.x[i]));
    log_y.push_back(std::log(curve.y[i]));
  }
  const Line line = normal_equations(z, log_y);
  const Fit fit = regress(curve.x, log_y, Model::logarithmic);
  EXPECT_NEAR(fit.parameters[0].estimate, line.a, 1e-10 * std::abs(line.a));      // rounding
  EXPECT_NEAR(fit.parameters[1].estimate, line.b, 1e-10 * line.b);                // rounding
  EXPECT_NEAR(fit.covariance(0, 1), line.cov_ab, 1e-10 * std::abs(line.cov_ab));  // rounding
}

TEST(Regression, NonLinearFitIsAMinimumWithTheRightCovariance) {
  // At a least-squares fit the residuals stand at right angles on every column of J, and the
  // covariance is (J^T J)^-1 s^2; J here by central differences of the formula.
  for (const ModelInfo& row : models()) {
    const Samples curve =
        noisy(row.parameters.size() == 3 ? sampled(row.model, {0.5, 2.0, 0.8}, 3.0)
                                         : sampled(row.model, {1.2, 0.7}, 3.0),
              0.03, 7);
    const Fit fit = regress(curve.x, curve.y, row.model);
    ASSERT_EQ(fit.termination, Termination::converged) << row.name;
    const std::size_t count = fit.parameters.size();
    std::vector<double> at;
    for (const Estimate& parameter : fit.parameters) at.push_back(parameter.estimate);
    std::vector<std::vector<double>> slope(count);
    for (std::size_t k = 0; k < count; ++k)
      for (const double x : curve.x) {
        std::vector<double> up = at, down = at;
        up[k] += 1e-5 * at[k];
        down[k] -= 1e-5 * at[k];
        slope[k].push_back((value(row.model, up, x) - value(row.model, down, x)) / (2e-5 * at[k]));
      }
    double sse = 0;
    for (std::size_t i = 0; i < curve.x.size(); ++i)
      sse += std::pow(curve.y[i] - test::value(fit, curve.x[i]), 2);
    EXPECT_NEAR(fit.rmse, std::sqrt(sse / fit.n), 1e-12 * fit.rmse) << row.name;  // rounding
    const double s2 = sse / (fit.n - static_cast<double>(count));
    for (std::size_t k = 0; k < count; ++k) {
      double dot = 0, size = 0;
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        dot += slope[k][i] * (curve.y[i] - test::value(fit, curve.x[i]));
        size += slope[k][i] * slope[k][i];
      }
      // central differences are exact to 1e-10 of the slope
      EXPECT_LT(std::abs(dot), 1e-8 * std::sqrt(size * sse)) << row.name << " " << k;
      for (std::size_t l = 0; l < count; ++l) {  // (J^T J) C = s^2 1
        double product = 0, largest = 0;
        for (std::size_t m = 0; m < count; ++m) {
          double normal = 0;
          for (std::size_t i = 0; i < curve.x.size(); ++i) normal += slope[k][i] * slope[m][i];
          const double one = normal * fit.covariance(Eigen::Index(m), Eigen::Index(l));
          product += one;
          largest = std::max(largest, std::abs(one));
        }
        EXPECT_NEAR(product, k == l ? s2 : 0.0, 1e-7 * largest) << row.name;  // the differences'
      }
    }
  }
}

TEST(Regression, ExactDataGiveTheParametersBack) {
  const std::vector<std::pair<Model, std::vector<double>>> truths{
      {Model::logarithmic, {0.6, 0.5}},
      {Model::power, {0.35, 1.5}},
      {Model::power, {2e-9, 7.3}},
      {Model::exponential, {0.09, 2.1}},
      {Model::exponential, {-0.4, -0.3}},
      {Model::kelvin_voigt, {0.14, 0.62}},
      {Model::kelvin_voigt, {0.14, 0.03}},
      {Model::exponential, {1e-6, 6.0}},
      {Model::kelvin_voigt_recovery, {0.14, 3.0}},
      {Model::standard_linear_solid, {2e4, 7e4, 1.4}}};
  for (const auto& [model, parameters] : truths) {
    const Samples curve = sampled(model, parameters, 3.0);
    const Fit fit = regress(curve.x, curve.y, model);
    EXPECT_EQ(fit.termination, Termination::converged) << info(model).name;
    EXPECT_NEAR(fit.r2, 1.0, 1e-12) << info(model).name;  // rounding
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const double size = std::abs(parameters[i]);
      EXPECT_NEAR(fit.parameters[i].estimate, parameters[i], 1e-9 * size)
          << info(model).name;  // condition 1e3
      EXPECT_LT(fit.parameters[i].std_error, 1e-9 * size) << info(model).name;
    }
  }
}

TEST(Regression, ScaleOfTheDataDoesNotMatter) {
  const Samples curve = noisy(sampled(Model::kelvin_voigt, {0.14, 0.62}, 3.0), 0.003, 9);
  const Fit fit = regress(curve.x, curve.y, Model::kelvin_voigt);
  Samples scaled = curve;
  for (double& x : scaled.x) x *= 1e6;
  for (double& y : scaled.y) y *= 1e-7;
  const Fit other = regress(scaled.x, scaled.y, Model::kelvin_voigt);
  const auto near = [](double got, double want) {
    EXPECT_NEAR(got, want, 1e-9 * want);  // both stop at 1e-14, times a condition below 1e3
  };
  near(other.parameters[0].estimate, fit.parameters[0].estimate * 1e-7);
  near(other.parameters[1].estimate, fit.parameters[1].estimate * 1e6);
  near(other.parameters[1].std_error, fit.parameters[1].std_error * 1e6);
  near(other.r2, fit.r2);
}

TEST(Regression, IntervalsCoverTheTruth) {
  // 1000 fits of 12 points: a 95 % interval misses 50 +- 6.9 times. Four standard deviations for
  // the linear model; the non-linear one is only asymptotically right and gets six.
  const std::vector<std::tuple<Model, std::vector<double>, int>> models{
      {Model::logarithmic, {0.6, 0.5}, 28}, {Model::kelvin_voigt, {0.14, 0.62}, 42}};
  for (const auto& [model, parameters, bound] : models) {
    std::mt19937 generator(2007);
    std::normal_distribution<double> noise(0.0, 0.01);
    std::vector<int> missed(parameters.size());
    for (int trial = 0; trial < 1000; ++trial) {
      std::vector<double> x, y;
      for (int i = 1; i <= 12; ++i) {
        x.push_back(0.25 * i);
        y.push_back(value(model, parameters, x.back()) + noise(generator));
      }
      const Fit fit = regress(x, y, model);
      for (std::size_t i = 0; i < parameters.size(); ++i)
        missed[i] += parameters[i] < fit.parameters[i].ci95_low ||
                     parameters[i] > fit.parameters[i].ci95_high;
    }
    for (const int count : missed) EXPECT_NEAR(count, 50, bound) << info(model).name;
  }
}

TEST(Regression, PointsThatCannotBeUsedAreCounted) {
  Samples curve = skin();
  curve.x.insert(curve.x.begin(), {0.0, -0.2, 1.0, nan, 2.0});
  curve.y.insert(curve.y.begin(), {0.0, 0.0, nan, 1.0, std::numeric_limits<double>::infinity()});
  const Fit fit = regress(curve.x, curve.y, Model::logarithmic, {.x_unit = "mm", .y_unit = "N"});
  EXPECT_EQ(fit.n, 30);
  EXPECT_EQ(fit.excluded, 5);
  EXPECT_EQ(fit.range_low, 0.1);
  EXPECT_EQ(fit.range_high, 3.0);
  const Fit alone = regress(skin().x, skin().y, Model::logarithmic);
  EXPECT_EQ(fit.parameters[0].estimate, alone.parameters[0].estimate);
  EXPECT_EQ(regress(curve.x, curve.y, Model::exponential).excluded, 3);  // takes x <= 0
}

TEST(Regression, TimeCountsFromTheLoad) {
  Samples curve = sampled(Model::kelvin_voigt, {0.14, 0.62}, 3.0);
  for (double& x : curve.x) x += 10.0;
  const Fit fit = regress(curve.x, curve.y, Model::kelvin_voigt, {.x_unit = "s", .x_origin = 10.0});
  EXPECT_NEAR(fit.parameters[1].estimate, 0.62, 1e-9);  // 10 + x is rounded to 1e-15
  EXPECT_EQ(fit.range_high, 13.0);
  EXPECT_NEAR(test::value(fit, 10.62), 0.14 * (1 - std::exp(-1.0)), 1e-9);  // at t = tau
}

TEST(Regression, RefusesTooFewPoints) {
  const std::vector<double> x{0.0, 1.0, 2.0}, y{1.0, 2.0, nan};
  try {
    static_cast<void>(regress(x, y, Model::power));
    FAIL() << "nothing was refused";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "the model `power` needs at least 3 points, and 1 is usable (2 excluded: not "
                 "finite, or x not above 0); record more points, or fit a model with fewer "
                 "parameters");
  }
  const std::vector<double> nothing(10, nan);
  EXPECT_THROW(static_cast<void>(regress(nothing, nothing, Model::exponential)), InputError);
}

TEST(Regression, DataThatDoNotFixAParameterSaySo) {
  const std::vector<double> same_x(5, 2.0), y{1.0, 1.1, 0.9, 1.0, 1.2};
  const Fit fit = regress(same_x, y, Model::logarithmic);
  EXPECT_EQ(word(fit.termination), "undetermined");
  EXPECT_TRUE(std::isnan(fit.parameters[0].std_error));
  const std::vector<double> x{1, 2, 3, 4, 5}, zero(5, 0.0);
  EXPECT_EQ(word(regress(x, zero, Model::power).termination), "undetermined");
}

TEST(Regression, OutOfIterationsIsAResult) {
  const Samples curve = noisy(sampled(Model::exponential, {0.09, 2.1}, 3.0), 0.5, 3);
  const Fit fit = regress(curve.x, curve.y, Model::exponential, {.max_iterations = 1});
  EXPECT_EQ(word(fit.termination), "not_converged");
  EXPECT_TRUE(std::isfinite(fit.parameters[0].estimate));
  EXPECT_TRUE(std::isnan(fit.parameters[0].ci95_low));
}

// Everything written to file descriptor `number` while `work` runs.
template <class Work>
std::string written_to(int number, const Work& work) {
  const std::string path =
      testing::TempDir() + "palpate_fd" + std::to_string(number) + "_" + std::to_string(::getpid());
  const int saved = ::dup(number);
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_TRUNC, 0600);
  ::dup2(file, number);
  work();
  ::dup2(saved, number);
  ::close(saved);
  ::close(file);
  std::ifstream stream(path);
  std::ostringstream text;
  text << stream.rdbuf();
  std::filesystem::remove(path);
  return text.str();
}

int log_files() {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/tmp"))
    count += entry.path().filename().string().starts_with("palpate.");
  return count;
}

TEST(Regression, FailingFitIsSilent) {
  // tau^2 is below every double, the slope x/tau^2 above: Ceres cannot even begin.
  std::vector<double> x, y;
  for (int i = 1; i <= 10; ++i) {
    x.push_back(1e-200 * i);
    y.push_back(1 - std::exp(-i / 3.0));
  }
  const int files = log_files();
  Fit fit;
  const auto fail = [&] { fit = regress(x, y, Model::kelvin_voigt); };
  std::string out;
  const std::string err = written_to(2, [&] { out = written_to(1, fail); });
  EXPECT_EQ(word(fit.termination), "failed");
  EXPECT_TRUE(std::isnan(fit.parameters[1].estimate));
  EXPECT_EQ(err, "");
  EXPECT_EQ(out, "");
  EXPECT_EQ(log_files(), files);
}

TEST(Regression, SameTwice) {
  const Samples curve = noisy(skin(), 0.01, 1);
  for (const ModelInfo& row : models()) {
    const Fit one = regress(curve.x, curve.y, row.model);
    const Fit two = regress(curve.x, curve.y, row.model);
    for (std::size_t i = 0; i < one.parameters.size(); ++i) {
      EXPECT_EQ(one.parameters[i].estimate, two.parameters[i].estimate) << row.name;
      if (one.termination != Termination::converged) continue;
      EXPECT_EQ(one.parameters[i].std_error, two.parameters[i].std_error) << row.name;
    }
  }
}

}  // namespace
}  // namespace palpate::fit
