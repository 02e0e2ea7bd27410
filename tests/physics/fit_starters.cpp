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

Result run(const std::string& text, const test::Settings& settings = {}) {
  scene::Scene scene = test::scene_of(text, settings);
  record::CaseRecord record = test::run_scene(scene);
  return {std::move(scene), std::move(record)};
}

std::string text_of(const std::string& kind) {
  for (const scenario::Starter& starter : scenario::starters())
    if (kind == starter.word.word) return std::string(starter.text);
  ADD_FAILURE() << "no starter " << kind;
  return {};
}

Result run_starter(const std::string& kind, const test::Settings& settings = {}) {
  return run(text_of(kind), settings);
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

// E (1 + (r - 1) exp(-t / tau)) of a standard linear solid.
TEST(Starters, RelaxationIsThatOfTheSolidAndItsFitReturnsWhatWasSet) {
  const auto [scene, record] = run_starter("relax");
  ASSERT_EQ(record.outcome, record::Outcome::completed) << record.reason;
  const double relaxed = 0.02 * scene.scenario.tissue.young_modulus;
  const double ratio = 1.8;
  const double time = 0.7;  // s
  for (const auto& row : record.strain) {
    const double want = relaxed * (1.0 + (ratio - 1.0) * std::exp(-row.time / time));
    EXPECT_NEAR(row.stress, want, within * want) << row.time;
  }
  const auto fits = fit::case_fits(scene.scenario, record);
  ASSERT_EQ(fits.size(), 1U);
  const auto& fitted = fits.front().fit.parameters;  // y_inf and y_0 in kPa, tau
  EXPECT_NEAR(1e3 * fitted.at(0).estimate, relaxed, within * relaxed);
  EXPECT_NEAR(1e3 * fitted.at(1).estimate, ratio * relaxed, within * ratio * relaxed);
  EXPECT_NEAR(fitted.at(2).estimate, time, within * time);
}

// E (1 + sum b_k exp(-t / tau_k)).
TEST(Starters, RelaxationWithBranchesIsThatOfTheSeries) {
  std::string text = text_of("relax");
  const std::size_t law = text.find("viscosity ");
  text.replace(law, text.find("[[step]]") - law,
               "viscosity = \"prony\"\n"
               "[[tissue.branch]]\nrelaxation_time = \"0.2 s\"\nratio = 0.8\n"
               "[[tissue.branch]]\nrelaxation_time = \"2 s\"\nratio = 0.4\n");
  const auto [scene, record] = run(text);
  ASSERT_EQ(record.outcome, record::Outcome::completed) << record.reason;
  const double modulus = scene.scenario.tissue.young_modulus;
  for (const auto& row : record.strain) {
    const double want =
        0.02 * modulus * (1.0 + 0.8 * std::exp(-row.time / 0.2) + 0.4 * std::exp(-row.time / 2.0));
    EXPECT_NEAR(row.stress, want, within * want) << row.time;
  }
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
