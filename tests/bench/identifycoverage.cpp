// How often the intervals of `palpate fit` and `palpate identify` contain the truth, for the same
// presses and relaxations with white, AR(1) and 1/f noise and with rounding. No test: it prints the
// table of docs/identify.md. `palpate-identify-coverage [REPEATS [SEED [NOISE]]]`
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

#include "fit/contact_model.h"
#include "fit/regression.h"
#include "identify/identify.h"
#include "identify/tables.h"

namespace {

using namespace palpate;

struct Noise {
  const char* name;
  double rho = 0.0;      // of neighbours
  bool flicker = false;  // a sum of first-order processes whose corners are a factor of four apart
  double step = 0.0;     // of the largest value, to which values are rounded
};
constexpr std::array noises{Noise{"white"}, Noise{"AR(1), rho = 0.5", 0.5},
                            Noise{"AR(1), rho = 0.9", 0.9}, Noise{"1/f", 0.0, true},
                            Noise{"rounded to steps of 2 %", 0.0, false, 0.02}};

// Noise of 1 % of the largest value, or of a tenth of a step.
std::vector<double> noisy(std::vector<double> y, double most, const Noise& noise,
                          std::mt19937_64& random) {
  std::normal_distribution<double> normal(0.0, 1.0);
  std::vector<double> keep{noise.rho};
  if (noise.flicker) {
    keep.clear();
    for (double corner = 0.5; corner > 0.05 / static_cast<double>(y.size()); corner /= 4.0)
      keep.push_back(std::exp(-corner));
  }
  std::vector<double> parts;
  for (std::size_t m = 0; m < keep.size(); ++m) parts.push_back(normal(random));
  for (double& each : y) {
    double error = 0.0;
    for (std::size_t m = 0; m < keep.size(); ++m) {
      error += parts[m] / std::sqrt(static_cast<double>(keep.size()));
      parts[m] = keep[m] * parts[m] + std::sqrt(1.0 - keep[m] * keep[m]) * normal(random);
    }
    each += (noise.step > 0.0 ? 0.1 * noise.step : 0.01) * most * error;
    if (noise.step > 0.0) each = noise.step * most * std::round(each / (noise.step * most));
  }
  return y;
}

struct Scene {
  scenario::Family family;
  std::vector<identify::Unknown> unknowns;

  Scene(const char* text, const std::vector<std::string>& asked)
      : family(scenario::parse(text, "coverage.toml", {})),
        unknowns(identify::read_unknowns(asked, family.cases.front().scenario)) {}

  // Whether the interval of unknown i contains its truth, both as shown.
  [[nodiscard]] std::vector<int> inside(const identify::Measurement& curve,
                                        const std::vector<double>& truth) const {
    const auto found = identify::identify(curve, family, unknowns,
                                          {.searches = 1, .model_error = false, .profiles = false});
    std::vector<int> held;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const identify::Interval interval = identify::trusted(found.unknowns[i]);
      held.push_back(interval.low && interval.high && *interval.low <= truth[i] &&
                             truth[i] <= *interval.high
                         ? 1
                         : 0);
    }
    return held;
  }
};

}  // namespace

int main(int count, char** words) {
  const int repeats = count > 1 ? std::atoi(words[1]) : 300;
  const auto seed = static_cast<std::uint64_t>(count > 2 ? std::atoi(words[2]) : 23);
  const Scene press(
      "[tissue]\nshape = { kind = \"half_space\" }\npoisson_ratio = 0.45\n[finger]\n"
      "material = \"rigid\"\nradius = \"11 mm\"\n[contact]\ndepth = \"hertz\"\n[solver]\n"
      "model = \"hertz\"\n[[step]]\nkind = \"indent\"\nto = \"3 mm\"\nrate = \"1 mm/s\"\n",
      {"tissue.young_modulus=5..500 kPa", "contact_point=-0.9..0.9 mm"});
  const Scene relaxation(
      "[tissue]\nmaterial = \"muscle\"\nshape = { kind = \"cuboid\", size = [\"30 mm\", \"30 mm\", "
      "\"30 mm\"] }\nviscosity = \"standard_linear_solid\"\n[[step]]\nkind = \"relax\"\n"
      "strain = 0.02\ntime = \"10 s\"\n",
      {"tissue.young_modulus=5..500 kPa", "tissue.relaxation_time=0.2..20 s",
       "tissue.instantaneous_ratio=1.1..6"});
  std::printf(
      "| noise | points | `E` | `h_0` | `y_0` | `tau` | `young_modulus` | `contact_point` "
      "| `young_modulus` | `relaxation_time` |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Noise& noise : noises)
    for (const int points : {100, 400, 1600}) {
      if (count > 3 && std::string(words[3]) != noise.name) continue;
      std::mt19937_64 random(seed);
      std::array<int, 8> held{};
      identify::Measurement pressed{.x = {},
                                    .y = {},
                                    .x_name = "travel",
                                    .y_name = "force",
                                    .x_dimension = {1, 0, 0},
                                    .y_dimension = {1, 1, -2}};
      identify::Measurement relaxed{.x = {},
                                    .y = {},
                                    .x_name = "time",
                                    .y_name = "stress",
                                    .x_dimension = {0, 0, 1},
                                    .y_dimension = {-1, 1, -2}};
      std::vector<double> force, stress;
      for (int i = 0; i < points; ++i) {
        const double t = static_cast<double>(i) / (points - 1);
        pressed.x.push_back(4e-3 * t - 1e-3);
        force.push_back(4.0 / 3.0 * 60e3 / (1.0 - 0.45 * 0.45) * std::sqrt(0.011) *
                        std::pow(std::max(pressed.x.back(), 0.0), 1.5));
        relaxed.x.push_back(10.0 * t);
        stress.push_back(1e3 + 1e3 * std::exp(-10.0 * t / 2.0));
      }
      for (int k = 0; k < repeats; ++k) {
        pressed.y = noisy(force, force.back(), noise, random);
        relaxed.y = noisy(stress, stress.front(), noise, random);
        fit::ContactTest test{0.011, 0.45};
        test.residuals = fit::Residuals::correlated;
        const auto holds = [](const fit::Estimate& one, double truth) {
          return one.ci95_low < truth && truth < one.ci95_high ? 1 : 0;
        };
        const fit::Fit contact = fit::fit_contact(pressed.x, pressed.y, test);
        held[0] += holds(contact.parameters[0], 60.0);
        held[1] += holds(contact.parameters[1], 0.0);
        const fit::Fit solid = fit::regress(relaxed.x, relaxed.y, fit::Model::standard_linear_solid,
                                            {.residuals = fit::Residuals::correlated});
        held[2] += holds(solid.parameters[1], 2e3);
        held[3] += holds(solid.parameters[2], 2.0);
        const std::vector<int> by_press = press.inside(pressed, {60.0, 0.0});
        held[4] += by_press[0];
        held[5] += by_press[1];
        const std::vector<int> by_relaxation = relaxation.inside(relaxed, {50.0, 2.0});
        held[6] += by_relaxation[0];
        held[7] += by_relaxation[1];
      }
      std::printf("| %s | %d |", noise.name, points);
      for (const int each : held) std::printf(" %d |", each);
      std::printf("\n");
      std::fflush(stdout);
    }
  return 0;
}
