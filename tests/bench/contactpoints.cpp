// Errors of three ways to find the contact point, over random curves. No test: it prints the table
// of docs/data.md. `palpate-contact-points [REPEATS]`
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include "fit/contact_model.h"

namespace {

struct Curve {
  std::vector<double> depth, force;
};

struct Kind {
  const char* name;
  double noise;   // standard deviation, of the largest force
  double tilt;    // rise of the baseline over the curve, of the largest force
  double before;  // part of the rows before contact
};

constexpr double radius = 5e-6, young = 2e3, deepest = 1.2e-6;  // m, Pa, m
constexpr int rows = 600;

Curve curve_of(const Kind& kind, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0.0, 1.0);
  const auto hertz = [](double h) {
    return h <= 0.0 ? 0.0 : 4.0 / 3.0 * young / 0.75 * std::sqrt(radius) * h * std::sqrt(h);
  };
  const double length = deepest / (1.0 - kind.before);
  const double most = hertz(deepest);
  const double offset = most * normal(random);
  Curve curve;
  for (int i = 0; i < rows; ++i) {
    const double h = length * (static_cast<double>(i) / (rows - 1) - kind.before);
    curve.depth.push_back(h);
    curve.force.push_back(hertz(h) + offset + kind.tilt * most * i / rows +
                          kind.noise * most * normal(random));
  }
  return curve;
}

// Deviation from the baseline: the last row before the force stays above the line through the first
// tenth of the rows by five of its standard deviations.
double by_threshold(const Curve& curve) {
  const std::size_t n = curve.depth.size() / 10;
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    sx += curve.depth[i];
    sy += curve.force[i];
    sxx += curve.depth[i] * curve.depth[i];
    sxy += curve.depth[i] * curve.force[i];
  }
  const auto count = static_cast<double>(n);
  const double slope = (count * sxy - sx * sy) / (count * sxx - sx * sx);
  const double start = (sy - slope * sx) / count;
  const auto above = [&](std::size_t i) { return curve.force[i] - start - slope * curve.depth[i]; };
  double squares = 0.0;
  for (std::size_t i = 0; i < n; ++i) squares += above(i) * above(i);
  const double limit = 5.0 * std::sqrt(squares / (count - 2.0));
  std::size_t last = curve.depth.size() - 1;
  while (last > 0 && above(last) > limit) --last;
  return curve.depth[last];
}

// Ratio of variances: the largest quotient of the variances of the 40 rows after and before a row
// (Gavara 2016, Sci. Rep. 6).
double by_variances(const Curve& curve) {
  constexpr std::size_t window = 40;
  const auto variance = [&](std::size_t from) {
    double sum = 0.0, squares = 0.0;
    for (std::size_t i = from; i < from + window; ++i) {
      sum += curve.force[i];
      squares += curve.force[i] * curve.force[i];
    }
    return squares - sum * sum / static_cast<double>(window);
  };
  double best = 0.0, at = curve.depth.front();
  for (std::size_t i = window; i + window < curve.depth.size(); ++i)
    if (const double ratio = variance(i) / std::max(variance(i - window), 1e-300); ratio > best) {
      best = ratio;
      at = curve.depth[i];
    }
  return at;
}

// Median and 95th percentile of |error|, nm.
void print(const char* name, std::vector<double> errors, int refused) {
  if (errors.empty()) {
    std::printf(" %s none (%d refused) |", name, refused);
    return;
  }
  for (double& each : errors) each = std::abs(each);
  std::sort(errors.begin(), errors.end());
  std::printf(" %s%.0f, %.0f", name, 1e9 * errors[errors.size() / 2],
              1e9 * errors[errors.size() * 95 / 100]);
  if (refused > 0) std::printf(" (%d refused)", refused);
  std::printf(" |");
}

}  // namespace

int main(int count, char** words) {
  using namespace palpate;
  const int repeats = count > 1 ? std::atoi(words[1]) : 200;
  std::printf("| curve | whole approach | baseline | variances | E: median error, 95 %% below |\n");
  std::printf("|---|---|---|---|---|\n");
  for (const Kind& kind :
       {Kind{"noise 0.1 %", 0.001, 0.0, 0.5}, Kind{"noise 1 %", 0.01, 0.0, 0.5},
        Kind{"noise 5 %", 0.05, 0.0, 0.5}, Kind{"noise 1 %, tilt 50 %", 0.01, 0.5, 0.5},
        Kind{"noise 1 %, 5 % of the rows before contact", 0.01, 0.0, 0.05},
        Kind{"noise 1 %, 98 % before contact", 0.01, 0.0, 0.98}}) {
    std::mt19937_64 random(17);
    std::vector<double> whole, threshold, variances, moduli;
    int refused = 0;
    for (int k = 0; k < repeats; ++k) {
      const Curve curve = curve_of(kind, random);
      threshold.push_back(by_threshold(curve));
      variances.push_back(by_variances(curve));
      try {
        const fit::Fit fit = fit::fit_contact(curve.depth, curve.force, {radius, 0.5});
        whole.push_back(1e-3 * fit.parameters[1].estimate);
        moduli.push_back(std::abs(1e3 * fit.parameters[0].estimate / young - 1.0));
      } catch (const std::exception&) {
        ++refused;
      }
    }
    std::printf("| %s |", kind.name);
    print("", whole, refused);
    print("", threshold, 0);
    print("", variances, 0);
    std::sort(moduli.begin(), moduli.end());
    if (!moduli.empty())
      std::printf(" %.2g %%, %.2g %% |", 100.0 * moduli[moduli.size() / 2],
                  100.0 * moduli[moduli.size() * 95 / 100]);
    std::printf("\n");
    std::fflush(stdout);
  }
  return 0;
}
