// How often the intervals of `palpate fit` contain the truth: AR(1) noise, 1/f noise (rho = -1) and
// forces rounded to steps of 2 % of the largest (rho = -2). No test: it prints
// the table of docs/identify.md. `palpate-fit-coverage [REPEATS [SEED [RHO]]]`
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "fit/contact_model.h"
#include "fit/regression.h"

int main(int count, char** words) {
  using namespace palpate;
  const int repeats = count > 1 ? std::atoi(words[1]) : 1000;
  const auto seed = static_cast<std::uint64_t>(count > 2 ? std::atoi(words[2]) : 23);
  std::printf("| curve | points | rho | contained, first | second |\n|---|---|---|---|---|\n");
  for (const bool press : {true, false})
    for (const int points : {100, 400, 1600})
      for (const double rho : {0.0, 0.5, 0.9, -1.0, -2.0}) {
        if (count > 3 && rho != std::atof(words[3])) continue;
        std::mt19937_64 random(seed);
        std::normal_distribution<double> normal(0.0, 1.0);
        int first = 0, second = 0;
        for (int k = 0; k < repeats; ++k) {
          std::vector<double> x, y;
          double error = normal(random);
          // 1/f noise: a sum of first-order processes whose corners are spaced by a factor of four.
          std::vector<double> parts;
          std::vector<double> keep;
          for (double corner = 0.5; corner > 0.05 / points; corner /= 4.0) {
            keep.push_back(std::exp(-corner));
            parts.push_back(normal(random));
          }
          for (int i = 0; i < points; ++i) {
            const double t = static_cast<double>(i) / (points - 1);
            const double h = 4e-3 * t - 1e-3;
            x.push_back(press ? h : 10.0 * t);
            y.push_back(press ? 4.0 / 3.0 * 60e3 / 0.75 * std::sqrt(0.011) *
                                    std::pow(std::max(h, 0.0), 1.5)
                              : 1.0 + std::exp(-10.0 * t / 2.0));
            if (rho == -1.0) {
              error = 0.0;
              for (std::size_t m = 0; m < parts.size(); ++m) {
                error += parts[m] / std::sqrt(static_cast<double>(parts.size()));
                parts[m] = keep[m] * parts[m] + std::sqrt(1.0 - keep[m] * keep[m]) * normal(random);
              }
            }
            const double most = press ? 1.5 : 2.0;
            y.back() += (rho == -2.0 ? 0.002 : 0.01) * most * error;
            if (rho == -2.0) y.back() = 0.02 * most * std::round(y.back() / (0.02 * most));
            const double next = std::max(rho, 0.0);
            error = next * error + std::sqrt(1.0 - next * next) * normal(random);
          }
          fit::ContactTest test{0.011, 0.5};
          test.residuals = fit::Residuals::correlated;
          const fit::Fit fit = press ? fit::fit_contact(x, y, test)
                                     : fit::regress(x, y, fit::Model::standard_linear_solid,
                                                    {.residuals = fit::Residuals::correlated});
          const auto holds = [&](std::size_t i, double truth) {
            return fit.parameters[i].ci95_low < truth && truth < fit.parameters[i].ci95_high ? 1
                                                                                             : 0;
          };
          first += press ? holds(0, 60.0) : holds(1, 2.0);
          second += press ? holds(1, 0.0) : holds(2, 2.0);
        }
        std::printf("| %s | %d | %.1f | %d | %d |\n",
                    press ? "press: `E`, `h_0`" : "relaxation: `y_0`, `tau`", points, rho, first,
                    second);
        std::fflush(stdout);
      }
  return 0;
}
