// Scenes whose properties are known, measured with noise: is the truth inside the 95 % interval?
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "identify/identify.h"
#include "identify/tables.h"
#include "run/family.h"
#include "run_text.h"

namespace palpate::test {

// splitmix64 (Steele, Lea, Flood 2014) and Box and Muller's transform: the same noise everywhere.
class Noise {
 public:
  // Mixed once, so that the streams of two seeds are not one stream, a little shifted.
  explicit Noise(std::uint64_t seed) : state_(mixed(seed)) {}
  double uniform() {
    state_ += 0x9E3779B97F4A7C15ULL;
    return (static_cast<double>(mixed(state_) >> 11) + 0.5) / 9007199254740992.0;
  }
  double normal() {
    const double size = std::sqrt(-2.0 * std::log(uniform()));
    return size * std::cos(2.0 * std::numbers::pi * uniform());
  }

 private:
  static std::uint64_t mixed(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

struct IdentifyScene {
  const char* name;
  std::string text;                   // of the scenario that is fitted
  std::vector<std::string> truth;     // settings
  std::vector<std::string> unknowns;  // `KEY=LOW..HIGH`
  std::vector<double> true_values;    // SI, of the unknowns
  identify::CurveKind kind;
  double contact_point = 0.0;  // m, that the measured travel is shifted by
};

inline const std::string half_space =
    "[tissue]\nshape = { kind = \"half_space\" }\npoisson_ratio = 0.45\n";
inline const std::string rigid = "[finger]\nmaterial = \"rigid\"\n";
inline const std::string press_2mm =
    "[[step]]\nkind = \"indent\"\nto = \"2 mm\"\nrate = \"5 mm/s\"\n";
inline const std::string rows_10ms = "[output]\ninterval = \"10 ms\"\n";
inline const std::string small_block =
    "[tissue]\nviscosity = \"none\"\nshape = { kind = \"cuboid\", size = [\"40 mm\", \"40 mm\", "
    "\"20 mm\"] }\nmesh = { kind = \"mirrored\", cells = [4, 4, 2] }\n" +
    rigid +
    "[[step]]\nkind = \"indent\"\nto = \"0.5 mm\"\nrate = \"1 mm/s\"\n[output]\ninterval = \"25 "
    "ms\"\n[solver]\nintegrator = \"quasi_static\"\n";
inline std::string column(const std::string& law, const std::string& step) {
  return "[tissue]\nmaterial = \"muscle\"\nshape = { kind = \"cuboid\", size = [\"30 mm\", \"30 "
         "mm\", \"30 mm\"] }\nmesh = { kind = \"kuhn\", cells = [1, 1, 2] }\nviscosity = \"" +
         law + "\"\n" + step + "[output]\ninterval = \"20 ms\"\n";
}
inline const std::string creep =
    "[[step]]\nkind = \"creep\"\nstress = \"100 Pa\"\nload_time = \"1 s\"\nrecovery_time = \"0.6 "
    "s\"\n";
inline const std::string compress =
    "[[step]]\nkind = \"compress\"\nstrain = 0.1\nrate = \"0.2 1/s\"\nhold_time = \"1 s\"\n";
inline const std::string relax = "[[step]]\nkind = \"relax\"\nstrain = 0.02\ntime = \"1.5 s\"\n";

inline const std::vector<IdentifyScene>& identify_scenes() {
  using identify::CurveKind;
  const std::string modulus = "tissue.young_modulus=1..500 kPa";
  static const std::vector<IdentifyScene> scenes{
      {"hertz",
       half_space + rigid + press_2mm + rows_10ms,
       {"tissue.young_modulus=60 kPa"},
       {modulus, "contact_point=-0.1..0.6 mm"},
       {60e3, 0.2e-3},
       CurveKind::force_travel,
       0.2e-3},
      {"layer",
       "[tissue]\nviscosity = \"none\"\nshape = { kind = \"cuboid\", size = [\"80 mm\", \"80 "
       "mm\", \"10 mm\"] }\n" +
           rigid + "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n[output]\ninterval = \"2 ms\"\n",
       {"tissue.young_modulus=60 kPa"},
       {modulus},
       {60e3},
       CurveKind::force_travel},
      {"viscous branch",
       half_space +
           "viscosity = \"standard_linear_solid\"\nrelaxation_time = \"0.3 "
           "s\"\ninstantaneous_ratio = 2\n" +
           rigid +
           "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\nrate = \"10 mm/s\"\n[[step]]\nkind = "
           "\"hold\"\ntime = \"1 s\"\n[output]\ninterval = \"20 ms\"\n",
       {"tissue.young_modulus=60 kPa"},
       {modulus, "tissue.relaxation_time=0.02..5 s", "tissue.instantaneous_ratio=1.1..6"},
       {60e3, 0.3, 2.0},
       CurveKind::force_time},
      {"slide",
       half_space + rigid +
           "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n[[step]]\nkind = \"slide\"\nby = \"2 "
           "mm\"\nrate = \"5 mm/s\"\n" +
           rows_10ms,
       {"contact.friction=0.4"},
       {"contact.friction=0.05..1.5"},
       {0.4},
       CurveKind::tangential_slide},
      {"creep",
       column("kelvin_voigt", creep),
       {"tissue.young_modulus=8 kPa", "tissue.retardation_time=0.3 s"},
       {modulus, "tissue.retardation_time=0.02..5 s"},
       {8e3, 0.3},
       CurveKind::strain_time},
      {"relaxation",
       column("standard_linear_solid", relax),
       {"tissue.young_modulus=8 kPa", "tissue.relaxation_time=0.3 s",
        "tissue.instantaneous_ratio=2"},
       {modulus, "tissue.relaxation_time=0.02..5 s", "tissue.instantaneous_ratio=1.1..6"},
       {8e3, 0.3, 2.0},
       CurveKind::stress_time},
      {"compression",
       column("standard_linear_solid", compress),
       {"tissue.young_modulus=8 kPa", "tissue.relaxation_time=0.3 s",
        "tissue.instantaneous_ratio=2"},
       {modulus, "tissue.relaxation_time=0.02..5 s", "tissue.instantaneous_ratio=1.1..6"},
       {8e3, 0.3, 2.0},
       CurveKind::stress_time},
      {"compression over strain",
       column("standard_linear_solid", compress),
       {"tissue.young_modulus=8 kPa"},
       {modulus},
       {8e3},
       CurveKind::stress_strain},
      {"mass_spring",
       small_block + "model = \"mass_spring\"\n",
       {"tissue.young_modulus=60 kPa"},
       {modulus},
       {60e3},
       CurveKind::force_travel},
      {"coupled_springs",
       small_block + "model = \"coupled_springs\"\n",
       {"tissue.young_modulus=60 kPa"},
       {modulus},
       {60e3},
       CurveKind::force_travel},
      {"creep of springs",
       column("kelvin_voigt", creep) +
           "[solver]\nmodel = \"mass_spring\"\nintegrator = \"quasi_static\"\n",
       {"tissue.young_modulus=8 kPa", "tissue.retardation_time=0.3 s"},
       {modulus, "tissue.retardation_time=0.02..5 s"},
       {8e3, 0.3},
       CurveKind::strain_time},
  };
  return scenes;
}

inline const IdentifyScene& identify_scene(const std::string& name) {
  for (const IdentifyScene& scene : identify_scenes())
    if (scene.name == name) return scene;
  throw std::out_of_range(name);
}

// What would have been measured without noise: the rows of a run with the true values.
inline identify::Measurement clean_curve(const IdentifyScene& scene) {
  std::vector<std::string> settings = scene.truth;
  settings.emplace_back("output.pressure_maps=false");
  if (scene.kind == identify::CurveKind::strain_time ||
      scene.kind == identify::CurveKind::stress_time ||
      scene.kind == identify::CurveKind::stress_strain)
    settings.emplace_back("solver.integrator=quasi_static");
  const record::CaseRecord record = run_text(scene.text, settings);
  identify::Measurement curve;
  const identify::CurveWords& words = identify::words_of(scene.kind);
  curve.x_name = words.x_column;
  curve.y_name = words.y_column;
  curve.x_dimension = words.x.dimension;
  curve.y_dimension = words.y.dimension;
  const auto add = [&](double x, double y) {
    curve.x.push_back(x);
    curve.y.push_back(y);
  };
  double start = 0.0;
  for (const record::ContactRow& row : record.contact) {
    if (row.step == 1) start = row.slide;
    if (scene.kind == identify::CurveKind::force_travel)
      add(row.travel + scene.contact_point, row.force);
    else if (scene.kind == identify::CurveKind::force_time)
      add(row.time, row.force);
    else if (row.step == 2)
      add(row.slide - start, row.tangential);
  }
  const bool over_strain = scene.kind == identify::CurveKind::stress_strain;
  for (const record::StrainRow& row : record.strain)
    add(over_strain ? row.strain : row.time,
        scene.kind == identify::CurveKind::strain_time ? row.strain : row.stress);
  return curve;
}

// With noise of a share of the largest value.
// Noise of so much of the largest value, e_i = rho e_(i-1) + sqrt(1 - rho^2) z_i.
inline identify::Measurement noisy(identify::Measurement curve, double share, std::uint64_t seed,
                                   double rho = 0.0) {
  double largest = 0.0;
  for (const double y : curve.y) largest = std::max(largest, std::abs(y));
  Noise noise(seed);
  double error = noise.normal();
  for (double& y : curve.y) {
    y += share * largest * error;
    error = rho * error + std::sqrt(1.0 - rho * rho) * noise.normal();
  }
  return curve;
}

inline identify::Identification identified(const IdentifyScene& scene,
                                           const identify::Measurement& curve,
                                           const identify::IdentifyOptions& options = {},
                                           const std::vector<std::string>& settings = {}) {
  const auto family = scenario::parse(scene.text, "test.toml", settings);
  const auto unknowns = identify::read_unknowns(scene.unknowns, family.cases.front().scenario);
  return identify::identify(curve, family, unknowns, options);
}

// Of so many repeats with noise of 1 %: how often the truth of an unknown lies inside its interval,
// and the interval's mean width (in the unknown's unit; infinite where one is open).
struct Covered {
  int inside = 0;
  double width = 0.0;
};
inline constexpr double noise_share = 0.01;

inline std::vector<Covered> covered(const IdentifyScene& scene, int repeats,
                                    const identify::IdentifyOptions& options =
                                        {.searches = 1, .model_error = false, .profiles = false},
                                    double rho = 0.0) {
  const identify::Measurement clean = clean_curve(scene);
  std::vector<Covered> all(scene.unknowns.size());
  for (int k = 0; k < repeats; ++k) {
    const auto found = identified(
        scene, noisy(clean, noise_share, static_cast<std::uint64_t>(k) + 1, rho), options);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const identify::Identified& one = found.unknowns[i];
      const identify::Interval interval = identify::trusted(one);
      const double truth = one.unknown.shown(scene.true_values[i]);
      constexpr double open = std::numeric_limits<double>::infinity();
      const double low = interval.low.value_or(-open);
      const double high = interval.high.value_or(open);
      if (interval.low && interval.high && low <= truth && truth <= high) ++all[i].inside;
      all[i].width += (high - low) / repeats;
    }
  }
  return all;
}

}  // namespace palpate::test
