// The loading history reaches the last row of the measurement, and nothing is shortened.
#include "identify/scenario_curve.h"

#include <gtest/gtest.h>

#include <cmath>

#include "scenario/scenario.h"

namespace palpate::identify {
namespace {

using scenario::Compress;
using scenario::Creep;
using scenario::Hold;
using scenario::Indent;
using scenario::Relax;
using scenario::Retract;
using scenario::Slide;

scenario::Scenario with(const std::string& steps) {
  return scenario::parse(steps, "test.toml", {}).cases.front().scenario;
}
const std::string indent = "[[step]]\nkind = \"indent\"\nto = \"2 mm\"\nrate = \"1 mm/s\"\n";
const std::string to_force = "[[step]]\nkind = \"indent\"\nto = \"1 N\"\nrate = \"1 mm/s\"\n";
const std::string retract = "[[step]]\nkind = \"retract\"\nto = \"0.5 mm\"\nrate = \"3 mm/s\"\n";
const std::string hold = "[[step]]\nkind = \"hold\"\ntime = \"4 s\"\n";
const std::string slide = "[[step]]\nkind = \"slide\"\nby = \"3 mm\"\nrate = \"2 mm/s\"\n";

TEST(Lengthen, DurationsAddUp) {
  EXPECT_NEAR(*duration(with(indent + hold + slide + retract)), 2.0 + 4.0 + 1.5 + 0.5, 1e-12);
  EXPECT_NEAR(*duration(with(indent + retract + indent)), 2.0 + 0.5 + 1.5, 1e-12);
  EXPECT_FALSE(duration(with(to_force + hold)));
  EXPECT_NEAR(*duration(with("[[step]]\nkind = \"creep\"\nload_time = \"2 s\"\nrecovery_time = "
                             "\"0.5 s\"\n")),
              2.5, 1e-12);
  EXPECT_NEAR(*duration(with("[[step]]\nkind = \"relax\"\ntime = \"7 s\"\n")), 7.0, 1e-12);
  EXPECT_NEAR(*duration(with("[[step]]\nkind = \"compress\"\nstrain = 0.1\nrate = \"0.05 1/s\"\n"
                             "hold_time = \"3 s\"\n")),
              5.0, 1e-12);
}

template <class Step>
const Step& step(const scenario::Scenario& scenario, std::size_t i) {
  return std::get<Step>(scenario.steps.at(i));
}

TEST(Lengthen, TheFirstIndentOfATravel) {
  scenario::Scenario press = with(indent + retract + indent);
  EXPECT_FALSE(lengthen(CurveKind::force_travel, press, 2e-3));
  EXPECT_TRUE(lengthen(CurveKind::force_travel, press, 2.5e-3));
  EXPECT_NEAR(step<Indent>(press, 0).to.value, 2.5e-3, 1e-8);
  EXPECT_GT(step<Indent>(press, 0).to.value, 2.5e-3);  // the last row lies within
  EXPECT_EQ(step<Indent>(press, 2).to.value, 2e-3);
  scenario::Scenario force = with(to_force);
  EXPECT_FALSE(lengthen(CurveKind::force_travel, force, 2.0));
}

TEST(Lengthen, ASlide) {
  scenario::Scenario press = with(indent + slide);
  EXPECT_FALSE(lengthen(CurveKind::tangential_slide, press, 3e-3));
  EXPECT_TRUE(lengthen(CurveKind::tangential_slide, press, 4e-3));
  EXPECT_NEAR(step<Slide>(press, 1).by, 4e-3, 1e-8);
  scenario::Scenario none = with(indent);
  EXPECT_FALSE(lengthen(CurveKind::tangential_slide, none, 4e-3));
}

TEST(Lengthen, ACompressionOverStrain) {
  scenario::Scenario test = with("[[step]]\nkind = \"compress\"\nstrain = 0.1\n");
  EXPECT_FALSE(lengthen(CurveKind::stress_strain, test, 0.1));
  EXPECT_TRUE(lengthen(CurveKind::stress_strain, test, 0.2));
  EXPECT_NEAR(step<Compress>(test, 0).strain, 0.2, 1e-6);
  scenario::Scenario other = with("[[step]]\nkind = \"relax\"\n");
  EXPECT_FALSE(lengthen(CurveKind::stress_strain, other, 1.0));
}

TEST(Lengthen, TheLastStepOverTime) {
  scenario::Scenario press = with(indent + hold);
  EXPECT_FALSE(lengthen(CurveKind::force_time, press, 6.0 * (1.0 + 1e-10)));  // rounding of a clock
  EXPECT_TRUE(lengthen(CurveKind::force_time, press, 9.0));
  EXPECT_NEAR(step<Hold>(press, 1).time, 7.0, 1e-4);
  EXPECT_GT(*duration(press), 9.0);
  press = with(indent);
  EXPECT_TRUE(lengthen(CurveKind::force_time, press, 3.0));
  EXPECT_NEAR(step<Indent>(press, 0).to.value, 3e-3, 1e-7);
  press = with(indent + retract);
  EXPECT_FALSE(lengthen(CurveKind::force_time, press, 30.0));
  press = with(indent + slide);
  EXPECT_FALSE(lengthen(CurveKind::force_time, press, 30.0));
  press = with(to_force + hold);
  EXPECT_FALSE(lengthen(CurveKind::force_time, press, 30.0));
  scenario::Scenario creep =
      with("[[step]]\nkind = \"creep\"\nload_time = \"2 s\"\nrecovery_time = \"1 s\"\n");
  EXPECT_TRUE(lengthen(CurveKind::strain_time, creep, 5.0));
  EXPECT_NEAR(step<Creep>(creep, 0).recovery_time, 3.0, 1e-4);
  EXPECT_EQ(step<Creep>(creep, 0).load_time, 2.0);
  scenario::Scenario relax = with("[[step]]\nkind = \"relax\"\ntime = \"7 s\"\n");
  EXPECT_TRUE(lengthen(CurveKind::stress_time, relax, 8.0));
  EXPECT_NEAR(step<Relax>(relax, 0).time, 8.0, 1e-4);
  scenario::Scenario ramp = with(
      "[[step]]\nkind = \"compress\"\nstrain = 0.1\nrate = \"0.05 1/s\"\nhold_time = \"3 s\"\n");
  EXPECT_TRUE(lengthen(CurveKind::stress_time, ramp, 6.0));
  EXPECT_NEAR(step<Compress>(ramp, 0).hold_time, 4.0, 1e-4);
}

}  // namespace
}  // namespace palpate::identify
