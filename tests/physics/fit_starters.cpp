// The scenarios of `palpate new` with a specimen between platens: within 0.1 % of their closed
// forms, which are written here from the textbook, and their own fits return what was set.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "fit/case_fits.h"
#include "run_text.h"
#include "scenario/schema.h"

namespace palpate {
namespace {

struct Result {
  scene::Scene scene;
  record::CaseRecord record;
};

Result run_starter(const std::string& kind, const test::Settings& settings = {}) {
  for (const scenario::Starter& starter : scenario::starters())
    if (kind == starter.word.word) {
      scene::Scene scene = test::scene_of(std::string(starter.text), settings);
      record::CaseRecord record = test::run_scene(scene);
      return {std::move(scene), std::move(record)};
    }
  ADD_FAILURE() << "no starter " << kind;
  return {};
}

constexpr double within = 1e-3;

// A standard linear solid of E, r E and tau: J(t) = (1 - (1 - 1/r) exp(-t / (r tau))) / E.
TEST(Starters, CreepIsThatOfTheSolidAndItsFitsReturnTheCreepTime) {
  const auto [scene, record] = run_starter("creep");
  ASSERT_EQ(record.outcome, record::Outcome::completed) << record.reason;
  const double modulus = scene.scenario.tissue.young_modulus;
  const double ratio = 2.0;
  const double creep_time = 1.0;  // s: 2 times 0.5 s
  const auto compliance = [&](double t) {
    return (1.0 - (1.0 - 1.0 / ratio) * std::exp(-t / creep_time)) / modulus;
  };
  ASSERT_EQ(record.strain.size(), 121U);
  for (const auto& row : record.strain) {
    double want = 500.0 * compliance(row.time);
    if (row.time > 3.0 + 1e-9) want -= 500.0 * compliance(row.time - 3.0);
    EXPECT_NEAR(row.strain, want, within * want) << row.time;
  }
  for (const fit::NamedFit& one : fit::case_fits(scene.scenario, record))
    EXPECT_NEAR(one.fit.parameters.back().estimate, creep_time, within) << one.curve;
  ASSERT_TRUE(scene.choice.taken());
  EXPECT_LE(scene.choice.taken()->error, 0.0011);
  EXPECT_TRUE(record.answer.effects.empty());
}

// E (1 + sum b_k exp(-t / tau_k)) of muscle.
TEST(Starters, RelaxationIsThatOfTheSeries) {
  const auto [scene, record] = run_starter("relax");
  ASSERT_EQ(record.outcome, record::Outcome::completed) << record.reason;
  const double modulus = scene.scenario.tissue.young_modulus;
  for (const auto& row : record.strain) {
    const double want =
        0.02 * modulus * (1.0 + 0.8 * std::exp(-row.time / 0.2) + 0.4 * std::exp(-row.time / 2.0));
    EXPECT_NEAR(row.stress, want, within * want) << row.time;
  }
  // With one branch the fit of the curve is its law.
  std::string text;
  for (const scenario::Starter& starter : scenario::starters())
    if (std::string(starter.word.word) == "relax") text = starter.text;
  const std::size_t branches = text.find("[[tissue.branch]]");
  text.replace(branches, text.find("[[step]]") - branches,
               "relaxation_time = \"0.7 s\"\ninstantaneous_ratio = 1.8\n");
  text.replace(text.find("\"prony\""), 7, "\"standard_linear_solid\"");
  const scene::Scene other = test::scene_of(text);
  const record::CaseRecord one = test::run_scene(other);
  const auto fits = fit::case_fits(other.scenario, one);
  ASSERT_EQ(fits.size(), 1U);
  const auto& fitted = fits.front().fit.parameters;
  EXPECT_NEAR(fitted.back().estimate, 0.7, within * 0.7);
  EXPECT_NEAR(fitted[1].estimate / fitted[0].estimate, 1.8, within * 1.8);
}

// Of a strain at 0.05 1/s for 2 s: E r (t + b tau (1 - exp(-t / tau))), then the branch decays.
TEST(Starters, CompressionIsThatOfTheSolid) {
  const auto [scene, record] = run_starter("compress");
  ASSERT_EQ(record.outcome, record::Outcome::completed) << record.reason;
  for (const auto& row : record.strain) {
    const double grown = std::min(row.time, 2.0);
    const double branch =
        0.4 * 2.0 * (1.0 - std::exp(-grown / 2.0)) * std::exp(-(row.time - grown) / 2.0);
    const double want = 15e3 * 0.05 * (grown + branch);
    EXPECT_NEAR(row.stress, want, within * want) << row.time;
  }
}

// With inertia the same block rings, which is stated, and rows of 50 ms do not show it.
TEST(Starters, InertiaIsStatedWithItsRinging) {
  const auto [scene, record] = run_starter("creep", {"solver.integrator=central_difference"});
  ASSERT_TRUE(scene.choice.taken());
  EXPECT_GE(scene.choice.taken()->error, 0.5);  // E_inf / E_0
  bool said = false;
  for (const std::string& warning : record.warnings)
    said = said || warning.find("vibrates with a period") != std::string::npos;
  EXPECT_TRUE(said);
  double largest = 0.0;
  for (const auto& row : record.strain)
    if (row.time < 3.0) {
      const double want =
          500.0 / scene.scenario.tissue.young_modulus * (1.0 - 0.5 * std::exp(-row.time));
      largest = std::max(largest, std::abs(row.strain - want) / 0.0069);
    }
  EXPECT_LE(largest, scene.choice.taken()->error);
  EXPECT_GT(largest, 0.01);
}

}  // namespace
}  // namespace palpate
