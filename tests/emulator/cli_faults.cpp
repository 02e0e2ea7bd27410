// What goes wrong on the line, and what is on the line then: the emulator's log is the judge.
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <set>

#include "held_run.h"

namespace palpate {
namespace {

using test::Played;
using test::Session;

// Everything a fault of either link must leave behind.
void expect_kept(const Played& played, const std::string& scenario, int code) {
  EXPECT_EQ(played.ended.code, code) << played.ended.err;
  EXPECT_EQ(played.ended.signal, 0);
  EXPECT_GT(played.rows.size(), 0U);
  for (const char* file :
       {"force_indentation.csv", "findings.csv", "device_health.json", "run.json", "scenario.toml"})
    EXPECT_TRUE(test::fs::exists(played.result(scenario) / file)) << file;
  EXPECT_EQ(played.findings.word(0, "outcome"), code == 6 ? "stopped" : "completed");
  if (code == 6) {
    EXPECT_NE(played.ended.err.find("rows are kept"), std::string::npos) << played.ended.err;
  }
  for (std::size_t i = 0; i < played.rows.size(); ++i)
    EXPECT_TRUE(std::isfinite(played.rows.number(i, "force_N"))) << "row " << i;
}

struct Fault {
  const char* kind;
  const char* more;  // of its table
  int code;          // 0: it recovers, 6: it ends
  // s after the fault, in which a stop is on the wire, or the arm's force is zero; below 0: none
  // can come, because the line is gone or nothing is to be stopped.
  double within;
};

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.kind << " " << fault.more; }

std::string name_of(const testing::TestParamInfo<Fault>& info) {
  return std::string(info.param.kind) + (info.param.more[0] != '\0' ? "_lasting" : "");
}

std::string fault_file(const Fault& fault, const char* at) {
  return std::string("[[fault]]\nkind = \"") + fault.kind + "\"\nat = \"" + at + "\"\n" +
         fault.more;
}

// --- the stand

class StandFault : public testing::TestWithParam<Fault> {};

// 1.2 s of the emulator is in the press, at some 0.4 mm of 2 mm. Whatever happens, the crosshead
// stays within the limits that were put into it (unless it has forgotten them), it stands at the
// end wherever a stop can reach it, and the stop is on the wire in time.
TEST_P(StandFault, IsStoppedInTimeAndKeepsItsRows) {
  const Fault& fault = GetParam();
  const test::ScratchFile file(fault_file(fault, "1.2 s"));
  const Played played(Session{.emulator = {"--fault", file.path()}});
  expect_kept(played, "device_stand", fault.code);
  const double began = played.fault_time();
  ASSERT_TRUE(std::isfinite(began)) << "the fault did not come";
  double stopped_at = std::nan("");
  for (std::size_t i = 0; i < played.log.size(); ++i) {
    // 4 mm is the programme's lower limit; 10 um of rounding to its text.
    EXPECT_GE(played.log.number(i, "position_m"), -4.01e-3);
    if (played.log.word(i, "kind") != "in" || played.log.number(i, "time_s") < began) continue;
    if (played.log.word(i, "text") == "s" && std::isnan(stopped_at))
      stopped_at = played.log.number(i, "time_s") - began;
  }
  if (fault.within >= 0.0) {
    EXPECT_LE(stopped_at, fault.within);
    EXPECT_EQ(played.summary.at("moving"), false);
  }
  // The last word is a stop, wherever words arrive.
  std::string last;
  for (std::size_t i = 0; i < played.log.size(); ++i)
    if (played.log.word(i, "kind") == "in") last = played.log.word(i, "text");
  const std::set<std::string> unheard{"unplug", "deaf", "wrong_baud"};
  if (!unheard.contains(fault.kind)) {
    EXPECT_EQ(last, "s");
  }
}

// Ends: a lasting silence or nonsense is stale after 60 ms, so that a stop goes out by the next
// reading. A stand that no longer moves is noticed after 1.03 s. What recovers needs no stop.
INSTANTIATE_TEST_SUITE_P(Mark10, StandFault,
                         testing::Values(Fault{"unplug", "", 6, -1.0},                 //
                                         Fault{"stall", "", 6, 0.12},                  //
                                         Fault{"deaf", "", 6, -1.0},                   //
                                         Fault{"wrong_baud", "", 6, -1.0},             //
                                         Fault{"garbage", "replies = 1000", 6, 0.12},  //
                                         Fault{"drop", "replies = 1000", 6, 0.12},
                                         Fault{"truncate", "replies = 1000", 6, 0.12},
                                         Fault{"glue", "replies = 2", 0, -1.0},  //
                                         Fault{"garbage", "", 0, -1.0},          //
                                         Fault{"truncate", "", 0, -1.0},         //
                                         Fault{"drop", "", 0, -1.0},             //
                                         Fault{"duplicate", "", 0, -1.0},        //
                                         Fault{"echo", "", 6, 0.12},             //
                                         Fault{"error_reply", "", 0, -1.0},      //
                                         Fault{"unsolicited", "", 0, -1.0},      //
                                         Fault{"nul", "", 0, -1.0},              //
                                         Fault{"nan", "", 0, -1.0},              //
                                         Fault{"huge", "", 0, -1.0},             //
                                         Fault{"no_travel", "", 0, -1.0},        //
                                         Fault{"swap", "", 0, -1.0},             //
                                         Fault{"slow", "", 0, -1.0},             //
                                         Fault{"unit_change", "", 0, -1.0},      //
                                         Fault{"sign_flip", "", 0, -1.0},        //
                                         Fault{"spike", "", 6, 0.06},            //
                                         Fault{"freeze", "", 6, 1.1},            //
                                         Fault{"overload", "", 6, 0.06},         //
                                         Fault{"limit_switch", "", 6, 1.1},      //
                                         Fault{"reset", "", 6, 1.1}),
                         name_of);

// A stand that ignores the stop goes to the limit that is in it, and no farther; the program says
// that it could not be stopped.
TEST(StandFaults, ARunawayEndsAtTheLimitInTheStand) {
  const test::ScratchFile file(
      "[[fault]]\nkind = \"runaway\"\nat = \"1.2 s\"\n[[fault]]\nkind = \"spike\"\nat = \"1.2 "
      "s\"\n");
  const Played played(Session{.emulator = {"--fault", file.path()}});
  expect_kept(played, "device_stand", 6);
  EXPECT_NEAR(played.summary.at("position_m").get<double>(), -4e-3, 1e-5)
      << "it had not got there when the program ended: its stop was not ignored";
  EXPECT_NE(played.ended.err.find("force went beyond"), std::string::npos) << played.ended.err;
}

// Inches on the stand's display: readings are converted; a limit that would be inches is not
// verified, and the run ends rather than to go there.
TEST(StandFaults, InchesAreReadButNeverSet) {
  const test::ScratchFile file("[[fault]]\nkind = \"travel_unit_change\"\nat = \"1.2 s\"\n");
  const Played played(Session{.emulator = {"--fault", file.path()}});
  expect_kept(played, "device_stand", 6);
  EXPECT_NE(played.ended.err.find("a setting did not read back as it was set"), std::string::npos)
      << played.ended.err;
  for (std::size_t i = 0; i < played.log.size(); ++i)
    EXPECT_GE(played.log.number(i, "position_m"), -4.01e-3);
  EXPECT_EQ(played.summary.at("moving"), false);
}

// --- the arm

class ArmFault : public testing::TestWithParam<Fault> {};

// 1.3 s of the emulator is a press with about 0.4 N. Whatever happens, every force on the wire is
// a number of at most 2 N that changes by at most 50 N/s; where the run ends it is zero in time.
TEST_P(ArmFault, TheForceOnTheWireObeysTheBounds) {
  const Fault& fault = GetParam();
  const test::ScratchFile file(fault_file(fault, "1.3 s"));
  const Played played(
      Session{.link = "inverse3", .scenario = "device_arm", .emulator = {"--fault", file.path()}});
  expect_kept(played, "device_arm", fault.code);
  const double began = played.fault_time();
  ASSERT_TRUE(std::isfinite(began)) << "the fault did not come";
  double before = 0.0;
  double greatest = 0.0;
  double zero_at = std::nan("");
  for (std::size_t i = 0; i < played.log.size(); ++i) {
    if (played.log.word(i, "kind") != "in") continue;
    const std::string text = played.log.word(i, "text");
    if (text.find("set_cursor_force") == std::string::npos) continue;
    const auto json = nlohmann::json::parse(text);
    const auto& vector = json["inverse3"][0]["commands"]["set_cursor_force"]["vector"];
    double force[3] = {vector["x"], vector["y"], vector["z"]};
    const double size = std::hypot(force[0], force[1], force[2]);
    ASSERT_TRUE(std::isfinite(size)) << text;
    EXPECT_LE(size, 2.0) << text;
    // 50 N/s in a frame of 1 ms; the forces' printed digits; and nothing holds up a drop to zero.
    if (size > 0.0) {
      EXPECT_LE(std::abs(force[2] - before), 0.05 + 1e-6);
    }
    before = force[2];
    const double time = played.log.number(i, "time_s") - began;
    if (time < 0.0) greatest = std::max(greatest, size);
    if (time > 0.0 && size == 0.0 && std::isnan(zero_at)) zero_at = time;
  }
  EXPECT_GT(greatest, 0.2) << "it pressed before the fault";
  if (fault.within >= 0.0) {
    EXPECT_LE(zero_at, fault.within);
  }
}

// Stale after 3 ms, zero 50 ms later; a brake is a trip at once, and the force falls by 50 N/s. A
// flood takes the machine's time to come, which has no measure in the emulator's.
INSTANTIATE_TEST_SUITE_P(Inverse3, ArmFault,
                         testing::Values(Fault{"rst", "", 6, -1.0},                         //
                                         Fault{"close_1000", "", 6, -1.0},                  //
                                         Fault{"close_1011", "", 6, -1.0},                  //
                                         Fault{"reset", "", 6, -1.0},                       //
                                         Fault{"drop", "", 0, -1.0},                        //
                                         Fault{"late", "", 0, -1.0},                        //
                                         Fault{"duplicate", "", 0, -1.0},                   //
                                         Fault{"reorder", "", 0, -1.0},                     //
                                         Fault{"invalid_json", "", 0, -1.0},                //
                                         Fault{"invalid_json", "replies = 1000", 6, 0.06},  //
                                         Fault{"partial", "", 0, -1.0},                     //
                                         Fault{"partial", "replies = 1000", 6, 0.06},       //
                                         Fault{"missing_field", "", 0, -1.0},               //
                                         Fault{"missing_field", "replies = 1000", 6, 0.06},
                                         Fault{"wrong_type", "", 0, -1.0},                 //
                                         Fault{"wrong_type", "replies = 1000", 6, 0.06},   //
                                         Fault{"empty", "", 0, -1.0},                      //
                                         Fault{"no_device", "", 0, -1.0},                  //
                                         Fault{"binary", "", 0, -1.0},                     //
                                         Fault{"nan", "", 0, -1.0},                        //
                                         Fault{"nan", "replies = 1000", 6, 0.06},          //
                                         Fault{"huge", "", 0, -1.0},                       //
                                         Fault{"huge", "replies = 1000", 6, 0.06},         //
                                         Fault{"id_change", "", 6, 0.06},                  //
                                         Fault{"second_device", "", 0, -1.0},              //
                                         Fault{"jump", "duration = \"300 ms\"", 0, -1.0},  //
                                         Fault{"velocity_spike", "", 0, -1.0},             //
                                         Fault{"freeze", "", 6, 0.06},                     //
                                         Fault{"brake", "", 6, 0.02},                      //
                                         Fault{"brake", "duration = \"2 ms\"", 6, 0.02},   //
                                         Fault{"event_brake", "", 6, 0.02},                //
                                         Fault{"event_stall", "", 6, 0.02},                //
                                         Fault{"event_ceiling", "", 6, 0.02},              //
                                         Fault{"event_stage", "", 6, 0.02},                //
                                         Fault{"event_unknown", "", 6, 0.02},              //
                                         Fault{"event_disconnect", "", 6, 0.002},          //
                                         Fault{"event_busy", "", 0, -1.0},                 //
                                         Fault{"event_other", "", 0, -1.0},                //
                                         Fault{"event_garbage", "", 0, -1.0},              //
                                         Fault{"event_partial", "", 0, -1.0},              //
                                         Fault{"event_huge", "", 0, -1.0},                 //
                                         Fault{"event_flood", "", 6, -1.0},                //
                                         Fault{"flood", "", 6, -1.0},                      //
                                         Fault{"events_close", "", 0, -1.0},               //
                                         Fault{"events_half_open", "", 0, -1.0},           //
                                         Fault{"not_ready", "", 6, 0.02}),
                         name_of);

// A socket that stays open while nobody reads or answers: by the machine's clock it is lost after
// 0.1 s, and the service, left without commands, lets go of the arm.
TEST(ArmFaults, AHalfOpenSocketIsLostByTheClock) {
  const test::ScratchFile file("[[fault]]\nkind = \"half_open\"\nafter_messages = 300\n");
  const Played played(Session{.link = "inverse3",
                              .scenario = "device_arm",
                              .clock = "real",
                              .emulator = {"--fault", file.path()}});
  expect_kept(played, "device_arm", 6);
  EXPECT_NE(played.ended.err.find("the link is lost"), std::string::npos) << played.ended.err;
}

// Replies that come 30 ms late, by the machine's clock: stale meanwhile, and counted.
TEST(ArmFaults, LateRepliesAreStaleMeanwhile) {
  const test::ScratchFile file(
      "[[fault]]\nkind = \"late\"\nafter_messages = 300\nvalue = \"30 ms\"\nreplies = 1\n");
  for (int i = 0; i < test::runs_by_the_clock; ++i) {
    const Played played(Session{.link = "inverse3",
                                .scenario = "device_arm",
                                .clock = "real",
                                .emulator = {"--fault", file.path()},
                                .options = {"--arm", "--seconds", "1"}});
    if (test::link_was_lost(played.ended)) continue;
    EXPECT_EQ(played.ended.code, 0) << played.ended.err;
    EXPECT_GT(played.health.at("rules").at("stale_frames").get<int>(), 0);
    return;
  }
  FAIL() << "the machine stood still in each of " << test::runs_by_the_clock << " runs";
}

// Killed: the guard process stops the stand on its way.
TEST(StandFaults, AKilledProgramLeavesNoMovingStand) {
  const auto held = test::held_press();
  ASSERT_TRUE(held->moves());
  held->run().send(SIGKILL);
  EXPECT_EQ(held->run().wait().signal, SIGKILL);
  EXPECT_TRUE(test::seen([&] { return held->is_stopped(); }));
  held->pass(10);
  const auto summary = held->summary();
  EXPECT_EQ(summary.at("moving"), false);
  EXPECT_GT(summary.at("position_m").get<double>(), -3e-3);
}

}  // namespace
}  // namespace palpate
