// Live runs against the emulator: they agree with offline ones, they look before they move, they
// keep what they have.
#include <gtest/gtest.h>

#include <algorithm>

#include "live_session.h"

namespace palpate {
namespace {

using test::has;
using test::Played;
using test::Session;

// An offline run of the same scenario, in the session's folder.
test::Rows offline(const Played& live, const std::string& scenario,
                   const std::vector<std::string>& more = {}) {
  std::vector<std::string> call{"run",   test::project_file("scenarios/" + scenario + ".toml"),
                                "--out", "offline",
                                "--set", "output.figures=false"};
  call.insert(call.end(), more.begin(), more.end());
  EXPECT_EQ(test::palpate(live.folder(), call).code, 0);
  return test::Rows(
      record::read_csv((live.folder() / "offline" / scenario / "force_indentation.csv").string()));
}

// Options that make a scenario's half-space a mesh.
const std::vector<std::string> mesh{
    "--set", R"(tissue.shape={kind="cuboid",size=["40 mm","40 mm","20 mm"]})",
    "--set", R"(tissue.mesh={kind="kuhn",cells=[3,4,6]})",
    "--set", "solver.model=mass_spring",
    "--set", "solver.integrator=quasi_static",
    "--set", R"(solver.time_step="1 ms")"};

std::vector<std::string> joined(std::vector<std::string> options,
                                const std::vector<std::string>& more) {
  options.insert(options.end(), more.begin(), more.end());
  return options;
}

// The programme through the stand and back is the programme as planned, but for the stand's
// resolution and the times its line takes: the tube of the shipped file, by a virtual clock
// narrower, for nobody is late there.
class StandModel : public testing::TestWithParam<std::vector<std::string>> {};

TEST_P(StandModel, AgreesWithOfflineInATubeOfTheStandsResolution) {
  const Played live(Session{.options = joined({"--arm"}, GetParam())});
  ASSERT_EQ(live.ended.code, 0) << live.ended.err;
  (void)offline(live, "device_stand", GetParam());
  const auto compare = [&](const std::string& tolerances) {
    test::write_file(live.folder() / "tube.toml", tolerances);
    return test::palpate(
        live.folder(), {"compare", "out/device_stand/force_indentation.csv",
                        "offline/device_stand/force_indentation.csv", "--tolerances", "tube.toml"});
  };
  const std::string shipped =
      test::read_file(test::project_file("scenarios/emulator/stand_tube.toml"));
  const auto with_width = [&](const std::string& width) {
    const std::size_t at = shipped.find("width = 0.15");
    EXPECT_NE(at, std::string::npos);
    return shipped.substr(0, at) + "width = " + width + shipped.substr(shipped.find(' ', at + 8));
  };
  // Two readings of 20 ms, and half of one.
  const test::Ended same = compare(with_width("0.05"));
  EXPECT_EQ(same.code, 0) << same.out;
  // Without the time's tube they are not the same.
  EXPECT_EQ(compare(with_width("0.001")).code, 3);
}
INSTANTIATE_TEST_SUITE_P(ClosedFormAndMesh, StandModel,
                         testing::Values(std::vector<std::string>(), mesh));

// The emulator's tissue is the scenario's, by another formula: while the press goes in and is held
// both follow Lee and Radok.
TEST(LiveStand, TheModelsForceIsTheMeasuredOne) {
  const Played live(Session{});
  ASSERT_EQ(live.ended.code, 0) << live.ended.err;
  double most = 0.0;
  for (std::size_t i = 0; i < live.rows.size(); ++i) {
    if (live.rows.number(i, "step") > 2.0) continue;
    const double measured = live.rows.number(i, "measured_force_N");
    most = std::max(most, measured);
    // 2 mN of display and 3 x 1 mN / sqrt(8) of noise; and at up to 0.3 N/mm in the press, what
    // half of 0.02 mm of travel and the gauge's lag of 0.6 ms at 2 mm/s are: 3 mN.
    EXPECT_NEAR(live.rows.number(i, "force_N"), measured, 5e-3) << "row " << i;
  }
  EXPECT_NEAR(most, 0.21, 0.02);  // N, the peak: the test would be empty without
  EXPECT_EQ(live.summary.at("moving"), false);
}

// A step to a force ends by the gauge: the stand is stopped there, far above its own limit.
TEST(LiveStand, StopsWhereAForceIsReached) {
  const Played live(Session{.options = {"--arm", "--set", "step.1.to=0.1 N"}});
  ASSERT_EQ(live.ended.code, 0) << live.ended.err;
  double lowest = 1.0;
  double deepest = 0.0;
  for (std::size_t i = 0; i < live.rows.size(); ++i) {
    if (live.rows.number(i, "step") != 2.0) continue;
    lowest = std::min(lowest, live.rows.number(i, "measured_travel_mm"));
    deepest = std::max(deepest, live.rows.number(i, "measured_travel_mm"));
  }
  // 0.1 N is reached at about 1 mm; between two readings it goes 0.04 mm, and as far to brake.
  EXPECT_NEAR(lowest, 1.0, 0.1);
  EXPECT_NEAR(deepest, lowest, 0.1);
}

// The command of the motion after a hold takes its time, which is taken off the hold.
TEST(LiveStand, HoldsForAsLongAsAsked) {
  const Played live(Session{});
  ASSERT_EQ(live.ended.code, 0) << live.ended.err;
  double first = 0.0;
  double last = 0.0;
  for (std::size_t i = 0; i < live.rows.size(); ++i) {
    if (live.rows.number(i, "measured_travel_mm") < 1.97) continue;
    last = live.rows.number(i, "time_s");
    if (first == 0.0) first = last;
  }
  // A second, to a reading at either end.
  EXPECT_NEAR(last - first, 1.0, 0.045);
}

// The slowest press of the stand shows no other travel for seconds.
TEST(LiveStand, IsNotTakenForStuckWhereItIsSlow) {
  const Played live(Session{
      .options = {"--arm", "--set", "step.1.to=0.1 mm", "--set", "step.1.rate=0.0085 mm/s"}});
  EXPECT_EQ(live.ended.code, 0) << live.ended.err;
}

TEST(LiveArm, ShowsTheForceThatOfflineGivesAtTheHandsPlace) {
  const Played live(Session{.link = "inverse3", .scenario = "device_arm"});
  ASSERT_EQ(live.ended.code, 0) << live.ended.err;
  const test::Rows off = offline(live, "device_arm");
  // F = c h^(3/2), c from offline's deepest row.
  double coefficient = 0.0;
  for (std::size_t i = 0; i < off.size(); ++i)
    if (off.number(i, "travel_mm") == 1.0) coefficient = off.number(i, "force_N");  // N at 1 mm
  ASSERT_GT(coefficient, 0.1);
  double deepest = 0.0;
  for (std::size_t i = 0; i < live.rows.size(); ++i) {
    const double travel = std::max(0.0, live.rows.number(i, "measured_travel_mm"));
    deepest = std::max(deepest, travel);
    const double force = live.rows.number(i, "force_N");
    // rounding: the position has passed through 17 digits of JSON
    EXPECT_NEAR(force, coefficient * travel * std::sqrt(travel), 1e-9);
  }
  EXPECT_GT(deepest, 1.0);
}

// A mesh under the hand gives the force that the same mesh gives offline at that travel.
TEST(LiveArm, ShowsAMeshsForceToo) {
  const Played live(
      Session{.link = "inverse3", .scenario = "device_arm", .options = joined({"--arm"}, mesh)});
  ASSERT_EQ(live.ended.code, 0) << live.ended.err;
  const test::Rows off = offline(live, "device_arm", mesh);
  // Of the press, as a polyline over travel: 5 um a row.
  std::vector<double> travels;
  std::vector<double> forces;
  for (std::size_t i = 0; i < off.size() && off.number(i, "step") == 1.0; ++i) {
    travels.push_back(off.number(i, "travel_mm"));
    forces.push_back(off.number(i, "force_N"));
  }
  ASSERT_EQ(travels.size(), 201U);
  std::size_t pressed = 0;
  for (std::size_t i = 0; i < live.rows.size(); ++i) {
    const double travel = live.rows.number(i, "measured_travel_mm");
    if (!(travel > 0.0) || travel >= travels.back()) continue;
    const auto above = static_cast<std::size_t>(
        std::upper_bound(travels.begin(), travels.end(), travel) - travels.begin());
    const double share = (travel - travels[above - 1]) / (travels[above] - travels[above - 1]);
    const double wanted = forces[above - 1] + share * (forces[above] - forces[above - 1]);
    // The mesh's steps end at whole milliseconds, the frames too: 1e-4 is the tolerance to which a
    // contact is balanced, 1e-5 N what the polyline misses of the first row's h^(3/2).
    EXPECT_NEAR(live.rows.number(i, "force_N"), wanted, 1e-5 + 1e-4 * wanted) << "row " << i;
    ++pressed;
  }
  EXPECT_GT(pressed, 200U);  // frames, of a press and a withdrawal of 0.15 s each
}

// What we say we sent is what arrived, and it is the model's force where no rule cuts it.
TEST(LiveArm, SendsWhatItRecords) {
  const Played live(Session{.link = "inverse3", .scenario = "device_arm"});
  ASSERT_EQ(live.ended.code, 0) << live.ended.err;
  double greatest = 0.0;
  for (std::size_t i = 0; i < live.rows.size(); ++i)
    greatest = std::max(greatest, live.rows.number(i, "sent_force_N"));
  EXPECT_NEAR(greatest, live.summary.at("greatest_force_N").get<double>(), 1e-6);  // its digits
  std::size_t uncut = 0;
  for (std::size_t i = 0; i < live.rows.size(); ++i)
    if (live.rows.number(i, "step") == 2.0 &&
        std::abs(live.rows.number(i, "sent_z_N") - live.rows.number(i, "force_N")) < 1e-12)
      ++uncut;
  EXPECT_GT(uncut, 250U);  // of the 300 frames of the hold; some are damped
}

// The energy that a held force, a frame late and slewed, can give in one contact: with F at most,
// at the hand's speed v, frames of T and a slew of s,
//   E = F v (3 T + F / (2 s))                               docs/devices.md
double energy_bound(const Played& live) {
  double speed = 0.0;
  double force = 0.0;
  for (std::size_t i = 1; i < live.rows.size(); ++i) {
    const double way =
        live.rows.number(i, "measured_travel_mm") - live.rows.number(i - 1, "measured_travel_mm");
    if (live.rows.number(i, "contacts") > 0.0) speed = std::max(speed, std::abs(way));
    force = std::max(force, live.rows.number(i, "sent_force_N"));
  }
  return force * speed * (3e-3 + force / (2.0 * 50.0));  // mm a frame of 1 ms is m/s
}

class Stiffness : public testing::TestWithParam<const char*> {};

// Muscle is below the passivity limit of the assumed device all the way down, skin crosses it,
// bone is a thousand times beyond it.
TEST_P(Stiffness, TheHandNeverGainsMoreThanTheBound) {
  const Played live(
      Session{.link = "inverse3",
              .scenario = "device_arm",
              .options = {"--arm", "--set", std::string("tissue.material=") + GetParam()}});
  ASSERT_EQ(live.ended.code, 0) << live.ended.err;
  const double given = live.summary.at("most_work_by_device_J").get<double>();
  EXPECT_LE(given, energy_bound(live));
  EXPECT_GT(live.summary.at("greatest_force_N").get<double>(), 0.1);  // N: it was pressed
  // Our observer and the emulator's own count say the same.
  EXPECT_NEAR(live.health.at("least_energy_J").get<double>(), -given, 1e-8 + 1e-3 * given);
}
INSTANTIATE_TEST_SUITE_P(Tissues, Stiffness, testing::Values("muscle", "skin", "bone"));

TEST(LiveRun, WithoutArmNothingMovesAndNoForceIsSent) {
  const Played stand(Session{.options = {}});
  EXPECT_EQ(stand.ended.code, 0) << stand.ended.err;
  EXPECT_TRUE(has(stand.ended.err, "the stand is stopped beyond 5 N")) << stand.ended.err;
  EXPECT_TRUE(has(stand.ended.err, "give `--arm` to run this"));
  for (std::size_t i = 0; i < stand.log.size(); ++i) {
    const std::string said = stand.log.word(i, "text");
    if (stand.log.word(i, "kind") == "in") {
      EXPECT_TRUE(said != "d" && said != "u" && said[0] != 'g' && said[0] != 'h') << said;
    }
    EXPECT_EQ(stand.log.number(i, "position_m"), 0.0);
  }
  EXPECT_FALSE(test::fs::exists(stand.result("device_stand")));

  const Played arm(Session{.link = "inverse3", .scenario = "device_arm", .options = {}});
  EXPECT_EQ(arm.ended.code, 0) << arm.ended.err;
  EXPECT_TRUE(has(arm.ended.err, "the force sent is at most 2 N")) << arm.ended.err;
  EXPECT_EQ(arm.summary.at("greatest_force_N"), 0.0);
}

// A frame that comes late is told: the model's time is that much behind.
TEST(LiveArm, SaysWhatLateFramesLeftOut) {
  for (int i = 0; i < test::runs_by_the_clock; ++i) {
    const test::TemporaryFolder folder;
    const test::LiveEmulator emulator({"inverse3", "--log", (folder / "log.csv").string()});
    test::Running running(
        {.arguments = {"run", test::project_file("scenarios/device_arm.toml"), "--device",
                       emulator.arm_link(), "--arm", "--set", "output.figures=false"},
         .folder = folder.path()});
    const auto rows = [&](const std::string& kind) {
      const std::string log = test::read_file(folder / "log.csv");
      int count = 0;
      for (std::size_t at = log.find("," + kind + ","); at != std::string::npos;
           at = log.find("," + kind + ",", at + 1))
        ++count;
      return count;
    };
    // Messages after the greeting's: the loop is under way.
    (void)running.until([&] { return rows("in") > 150; });
    running.send(SIGSTOP);
    const int before = rows("state");  // the emulator writes one every 20 ms
    ASSERT_TRUE(test::seen([&] { return rows("state") >= before + 4; }));
    running.send(SIGCONT);
    const int again = rows("in");
    (void)running.until([&] { return rows("in") > again + 20; });
    running.send(SIGINT);
    const test::Ended ended = running.wait();
    if (test::link_was_lost(ended)) continue;
    EXPECT_TRUE(has(ended.err, "dropped from the model's time")) << ended.err;
    return;
  }
  FAIL() << "the machine stood still in each of " << test::runs_by_the_clock << " runs";
}

// Nothing is pushed out of the tissue: the hand has to leave it before a run begins, and what is
// refused leaves nothing behind.
TEST(LiveArm, RefusesToStartInsideTheTissue) {
  Session session{.link = "inverse3", .scenario = "device_arm", .surface = "160 mm"};
  const Played live(session);
  EXPECT_EQ(live.ended.code, 6);
  EXPECT_TRUE(has(live.ended.err, "the finger is 10 mm inside the tissue; move it out"))
      << live.ended.err;
  EXPECT_EQ(live.summary.at("greatest_force_N"), 0.0);
  EXPECT_FALSE(test::fs::exists(live.folder() / "out"));
  session.options = {};
  const Played looked(session);
  EXPECT_EQ(looked.ended.code, 0) << looked.ended.err;
  EXPECT_TRUE(has(looked.ended.err, "10 mm inside the tissue")) << looked.ended.err;
}

TEST(LiveRun, KeepsTheRawTraffic) {
  const Played live(Session{.options = {"--arm", "--traffic"}});
  ASSERT_EQ(live.ended.code, 0) << live.ended.err;
  const std::string traffic = test::read_file(live.result("device_stand") / "traffic.csv");
  EXPECT_TRUE(traffic.starts_with("time_s,way,bytes\n0,sent,\"s\"\n")) << traffic.substr(0, 200);
  EXPECT_TRUE(has(traffic, ",sent,\"LIST\\r\"\n")) << "the greeting is in it";
  EXPECT_TRUE(has(traffic, ",sent,\"g-004.00\"\n"));
  EXPECT_TRUE(has(traffic, " mm\\r\\n\"\n"));
  EXPECT_FALSE(test::fs::exists(Played(Session{}).result("device_stand") / "traffic.csv"));
}

// Time passes with the traffic alone, so that nothing of the machine is in the rows.
TEST(LiveRun, RepeatsItselfToTheBitInLockStep) {
  for (const bool arm : {false, true}) {
    const Session session{.link = arm ? "inverse3" : "mark10",
                          .scenario = arm ? "device_arm" : "device_stand"};
    const Played first(session);
    const Played second(session);
    ASSERT_EQ(first.ended.code, 0) << first.ended.err;
    const auto rows = [&](const Played& played) {
      return test::read_file(played.result(session.scenario) / "force_indentation.csv");
    };
    EXPECT_GT(rows(first).size(), 10000U);
    EXPECT_EQ(rows(first), rows(second));
  }
}

// A live run's own file, played again, gives the same forces.
TEST(LiveRun, PlaysARecordingAgain) {
  const Played live(Session{});
  ASSERT_EQ(live.ended.code, 0) << live.ended.err;
  const test::Ended again =
      test::palpate(live.folder(), {"run", test::project_file("scenarios/device_stand.toml"),
                                    "--out", "again", "--set", "output.figures=false", "--device",
                                    "replay:out/device_stand/force_indentation.csv"});
  ASSERT_EQ(again.code, 0) << again.err;
  const test::Rows rows(record::read_csv(
      (live.folder() / "again" / "device_stand" / "force_indentation.csv").string()));
  ASSERT_GE(rows.size(), live.rows.size() - 2);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_NEAR(rows.number(i, "time_s"), live.rows.number(i, "time_s"), 1e-9);
    EXPECT_NEAR(rows.number(i, "force_N"), live.rows.number(i, "force_N"),
                1e-9);  // times' rounding
    EXPECT_EQ(rows.word(i, "case"), "device_stand");
  }
}

TEST(LiveRun, FeelsForTheSurfaceWhereItIsNotGiven) {
  test::TemporaryFolder folder;
  const test::LiveEmulator emulator({"mark10", "--clock", "virtual", "--tissue",
                                     test::project_file("scenarios/emulator/stand_tissue.toml")});
  const test::Ended ended =
      test::palpate(folder.path(), {"run", test::project_file("scenarios/device_stand.toml"),
                                    "--device", "mark10:" + emulator.port(), "--clock", "virtual",
                                    "--arm", "--set", "output.figures=false"});
  ASSERT_EQ(ended.code, 0) << ended.err;
  const auto health =
      nlohmann::json::parse(test::read_file(folder.path() / "out/device_stand/device_health.json"));
  // The upper limit of the last step is where the surface was found: 2 mm below the start. Felt
  // from 5 mN on, which is a fifth of a millimetre here, by a line through what is viscous.
  EXPECT_NEAR(health.at("limits").at("high_m").get<double>(), -2e-3, 1e-4);
}

}  // namespace
}  // namespace palpate
