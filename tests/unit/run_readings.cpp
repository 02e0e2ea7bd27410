// Numbers read off curves: the force at an indentation, half of the creep.
#include "run/findings.h"

#include <gtest/gtest.h>

#include <cmath>

#include "run/family.h"
#include "run_text.h"
#include "scenario_text.h"
#include "scene/scene.h"

namespace palpate::run {
namespace {

using test::finding;
using test::run_text;

record::CaseRecord press_rows(const std::vector<std::array<double, 3>>& rows) {
  record::CaseRecord record;
  for (const auto& [step, indentation, force] : rows)
    record.contact.push_back(
        {.step = static_cast<int>(step), .indentation = indentation, .force = force});
  return record;
}

TEST(Readings, TheForceIsThatOfTheFirstIndentOnItsWayDown) {
  scenario::Scenario scenario;
  scenario.steps = {scenario::Hold{}, scenario::Indent{}, scenario::Retract{}, scenario::Indent{}};
  // A hold that is deep already does not count, nor does the way back or the second press.
  const auto record = press_rows(
      {{1, 5, 50}, {1, 1, 9}, {2, 2, 10}, {2, 4, 30}, {3, 3, 12}, {4, 3, 99}, {4, 8, 200}});
  EXPECT_EQ(force_at_indentation(scenario, record, 3.0), 20.0);
  EXPECT_EQ(force_at_indentation(scenario, record, 4.0), 30.0);
  EXPECT_EQ(force_at_indentation(scenario, record, 1.5), 9.5);
  EXPECT_EQ(force_at_indentation(scenario, record, 4.1), std::nullopt);
  EXPECT_EQ(force_at_indentation(scenario, press_rows({}), 1.0), std::nullopt);
  scenario.steps.assign(4, scenario::Hold{});
  EXPECT_EQ(force_at_indentation(scenario, record, 3.0), std::nullopt);
}

TEST(Readings, HalfTheCreepIsTimedFromTheLoadOfTheFirstTest) {
  record::CaseRecord record;
  for (const auto& [step, time, stress, strain] :
       std::vector<std::array<double, 4>>{{1, 0, 0, 0},
                                          {2, 2, 5, 0.00},
                                          {2, 3, 5, 0.02},
                                          {2, 4, 5, 0.06},
                                          {2, 5, 0, 0.07},
                                          {3, 6, 5, 0.00},
                                          {3, 7, 5, 0.50}})
    record.strain.push_back({static_cast<int>(step), time, stress, strain});
  EXPECT_DOUBLE_EQ(*creep_half_time(record, 0.08), 1.5);
  EXPECT_EQ(creep_half_time(record, 0.13), std::nullopt);  // the load was off by then
  EXPECT_EQ(creep_half_time({}, 0.1), std::nullopt);
  record.strain[1].strain = 0.05;  // more than half at once
  EXPECT_EQ(creep_half_time(record, 0.08), 0.0);
  record.strain[1].strain = std::nextafter(0.04, 0.0);  // half, but for rounding
  EXPECT_EQ(creep_half_time(record, 0.08), 0.0);
}

TEST(Readings, FindingsHaveTheForceOfHertzAtEveryIndentationThatIsAskedFor) {
  const auto record = run_text(
      "[[step]]\nkind = \"indent\"\nto = \"2 mm\"\n[[step]]\nkind = \"retract\"\n"
      "[tissue]\nyoung_modulus = \"20 kPa\"\npoisson_ratio = 0.4\n"
      "shape = { kind = \"half_space\" }\n[finger]\nmaterial = \"rigid\"\n"
      "[contact]\nviscosity = \"none\"\ndepth = \"hertz\"\n"
      "[solver]\nmodel = \"hertz\"\n"
      "[output]\nforce_at = [\"0.5 mm\", \"1.5033 mm\", \"3 mm\"]\npressure_maps = false\n");
  for (const auto& [name, depth] :
       {std::pair{"force_at_0.5_mm_N", 0.5e-3}, std::pair{"force_at_1.5033_mm_N", 1.5033e-3}}) {
    const double hertz = 4.0 / 3.0 * 20e3 / (1.0 - 0.16) * std::sqrt(0.011 * depth) * depth;
    // Rows are 5 um apart: 3/32 (dh / h)^2 at 0.5 mm, and the fingertip's rounding.
    EXPECT_NEAR(std::get<double>(finding(record, name)), hertz, 1e-5 * hertz) << name;
  }
  EXPECT_TRUE(std::holds_alternative<std::monostate>(finding(record, "force_at_3_mm_N")));
  std::string warnings;
  for (const std::string& warning : record.warnings) warnings += warning + "\n";
  EXPECT_NE(warnings.find("did not reach the indentation of 3 mm that `output.force_at` asks for"),
            std::string::npos)
      << warnings;
}

TEST(Readings, AKelvinVoigtSolidHasHalfOfItsCreepAtTauLnTwo) {
  const auto record = run_text(
      "[[step]]\nkind = \"creep\"\nstress = \"1 kPa\"\nload_time = \"1 s\"\n"
      "[tissue]\nretardation_time = \"0.2 s\"\nmesh = { cells = [2, 2, 2] }\n"
      "[solver]\nmodel = \"coupled_springs\"\nintegrator = \"quasi_static\"\n"
      "[output]\ninterval = \"2 ms\"\n");
  // The way of the step's error: order 1 or 2 at 2 ms of 200 ms.
  EXPECT_NEAR(std::get<double>(finding(record, "creep_half_time_s")), 0.2 * std::log(2.0), 1e-3);
}

}  // namespace
}  // namespace palpate::run
