// Every fault of the stand does what its line in the list says.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <string>

#include "base/error.h"
#include "stand_conversation.h"
#include "temporary_folder.h"

namespace emulator {
namespace {

constexpr Nanoseconds ms = 1'000'000;

using test::Conversation;
using test::quiet;

Fault stand_fault(const std::string& kind, std::int64_t after,
                  std::optional<Nanoseconds> duration = {}) {
  for (const FaultKind& known : stand_faults())
    if (known.name == kind)
      return {.kind = kind, .life = known.life, .after_messages = after, .duration = duration};
  ADD_FAILURE() << "no fault " << kind;
  return {};
}

const std::string sound = "0.000 N\r\n0.00 mm\r\n";

// Those that spoil one reply to `n`: the reply before and after is sound.
TEST(EmulatorStandFaults, SpoilOneReply) {
  const std::pair<const char*, std::string> rows[] = {
      {"truncate", sound.substr(0, sound.size() / 2)},
      {"glue", "0.000 N0.00 mm"},
      {"drop", ""},
      {"duplicate", sound + sound},
      {"error_reply", "*10\r\n"},
      {"unsolicited", "0.000 N\r\n" + sound},
      {"nan", "nan N\r\n0.00 mm\r\n"},
      {"huge", "1e308 N\r\n0.00 mm\r\n"},
      {"no_travel", "0.000 N\r\n"},
      {"swap", "0.00 mm\r\n0.000 N\r\n"},
  };
  for (const auto& [kind, reply] : rows) {
    Conversation stand(quiet({stand_fault(kind, 1)}));
    EXPECT_EQ(stand.say("n"), sound) << kind;
    EXPECT_EQ(stand.say("n"), reply) << kind;
    EXPECT_EQ(stand.say("n"), sound) << kind;
  }
}

TEST(EmulatorStandFaults, SpoilAsManyRepliesAsAsked) {
  Fault drop = stand_fault("drop", 1);
  drop.replies = 3;
  Conversation stand(quiet({drop}));
  EXPECT_EQ(stand.say("nnnnn"), sound + sound);
}

TEST(EmulatorStandFaults, GarbageAndNulKeepTheLength) {
  Conversation garbage(quiet({stand_fault("garbage", 0)}));
  const std::string heard = garbage.say("n");
  EXPECT_EQ(heard.size(), sound.size());
  EXPECT_TRUE(std::all_of(heard.begin(), heard.end(), [](char c) { return (c & 0x80) != 0; }));
  Conversation nul(quiet({stand_fault("nul", 0)}));
  const std::string wide = nul.say("n");
  EXPECT_EQ(wide.size(), 2 * sound.size());
  EXPECT_EQ(wide[1], '\0');
}

TEST(EmulatorStandFaults, StallHoldsWhatIsDueAndMovesOn) {
  Conversation stand(quiet({stand_fault("stall", 1, 90 * ms)}));
  stand.say("e0600.0d");
  EXPECT_FALSE(stand.say("n").empty());
  const double before = stand->stand().crosshead.position;
  EXPECT_EQ(stand.say("nnnn"), "");
  EXPECT_LT(stand->stand().crosshead.position, before - 0.5e-3) << "it moves while it is silent";
  const std::string after = stand.say("n");
  EXPECT_EQ(std::count(after.begin(), after.end(), '\n'), 2 * 5) << "all that was due comes";
}

TEST(EmulatorStandFaults, DeafAndRunawayDoNotStop) {
  Conversation deaf(quiet({stand_fault("deaf", 1, 50 * ms)}));
  deaf.say("e0600.0dn");
  EXPECT_EQ(deaf.say("sp"), "");
  EXPECT_TRUE(moves(deaf->stand().crosshead));
  Conversation runaway(quiet({stand_fault("runaway", 1, 200 * ms)}));
  runaway.say("e0600.0dn");
  runaway.say("snnnnn");  // 100 ms, twice what braking takes
  EXPECT_EQ(runaway.say("p"), "DM\r\n");
  runaway.say("nnnnn");
  runaway.say("snnn");
  EXPECT_FALSE(moves(runaway->stand().crosshead)) << "after its time it obeys again";
}

TEST(EmulatorStandFaults, EchoComesFirst) {
  Conversation stand(quiet({stand_fault("echo", 0, 60 * ms)}));
  EXPECT_EQ(stand.say("x"), "x0.00 mm\r\n");
  EXPECT_EQ(stand.say("ix"), "ix0.00 mm\r\n");
}

TEST(EmulatorStandFaults, WrongBaudIsNoiseBothWays) {
  Conversation stand(quiet({stand_fault("wrong_baud", 1, 50 * ms)}));
  stand.say("e0600.0dn");
  EXPECT_EQ(stand.say("s"), "");
  EXPECT_TRUE(moves(stand->stand().crosshead)) << "`s` was not understood";
  Conversation other(quiet({}));
  other->take('n', Mark10::Rate::other);
  EXPECT_EQ(other->give(), "") << "a client at another rate is not understood";
}

TEST(EmulatorStandFaults, UnitsChangeByThemselves) {
  Conversation force(quiet({stand_fault("unit_change", 1)}));
  EXPECT_EQ(force.say("n"), sound);
  EXPECT_EQ(force.say("x").size(), 9U);
  EXPECT_EQ(force.say("n"), "0.0000 lbF\r\n0.00 mm\r\n");
  EXPECT_NE(force.say("/LIST\r").find(";LBF;"), std::string::npos);
  Conversation travel(quiet({stand_fault("travel_unit_change", 1)}));
  EXPECT_EQ(travel.say("n"), sound);
  travel.say("x");
  EXPECT_EQ(travel.say("n"), "0.000 N\r\n0.000 in\r\n");
}

TEST(EmulatorStandFaults, TheGaugeLies) {
  Mark10Settings settings = quiet({stand_fault("sign_flip", 6), stand_fault("spike", 12, 50 * ms)});
  settings.faults[1].value = 5.0;
  settings.stand.tissue = {.E0 = 40e3, .E_inf = 40e3, .tau = 1.0, .R = 10e-3, .surface = 0.0};
  Conversation stand(settings);
  stand.say("lg-001.00e0600.0dxxxxx");
  const double pressed = std::stod(stand.say("n"));
  EXPECT_GT(pressed, 0.1);
  stand.say("x");
  EXPECT_LT(std::stod(stand.say("n")), 0.0) << "compression now reads negative";
  EXPECT_NE(stand.say("/LIST\r\\").find("IPOL0"), std::string::npos) << "and LIST hides it";
  stand.say("xxx");
  stand.say("x");
  EXPECT_LT(std::stod(stand.say("n")), -5.0) << "5 N are added before the sign";
  stand.say("xxx");
  EXPECT_GT(std::stod(stand.say("n")), -5.0);
}

TEST(EmulatorStandFaults, FreezeRepeatsWhatWas) {
  Conversation stand(quiet({stand_fault("freeze", 1, 100 * ms)}));
  stand.say("e0600.0dn");
  stand.say("n");
  const std::string first = stand.say("n");
  EXPECT_EQ(stand.say("n"), first);
  EXPECT_EQ(stand.say("n"), first);
  stand.say("nnn");
  EXPECT_NE(stand.say("n"), first) << "after its time it reads again";
}

TEST(EmulatorStandFaults, OverloadStopsAndSaysSo) {
  Conversation stand(quiet({stand_fault("overload", 1, 60 * ms)}));
  stand.say("e0600.0dn");
  stand.say("x");
  EXPECT_EQ(stand.say("n").substr(0, 10), "OVERLOAD\r\n");
  EXPECT_EQ(stand->stand().crosshead.direction, 0);
  stand.say("xxxx");
  EXPECT_EQ(stand.say("n").substr(0, 7), "0.000 N");
}

TEST(EmulatorStandFaults, TheSwitchStopsAtOnce) {
  Conversation stand(quiet({stand_fault("limit_switch", 3)}));
  EXPECT_EQ(stand.say("e0600.0dp"), "DM\r\n");
  stand.say("xx");
  stand.say("i");
  EXPECT_EQ(stand.say("p"), "SMDL\r\n");
  EXPECT_EQ(stand->stand().crosshead.velocity, 0.0);
  EXPECT_EQ(stand.say("dp"), "SMDL\r\n") << "it stays pressed";
  EXPECT_EQ(stand.say("up"), "UM\r\n") << "the way back is free";
  EXPECT_EQ(stand.say("dp"), "DM\r\n") << "and then that way again";
}

TEST(EmulatorStandFaults, ResetForgetsSettings) {
  Conversation stand(quiet({stand_fault("reset", 4)}));
  stand.say("lg-002.00e0600.0d/LB\r\\");
  stand.say("nnn");
  const double where = stand->stand().crosshead.position;
  stand.say("i");
  EXPECT_EQ(stand.say("w"), "-150.00 mm\r\n");
  EXPECT_EQ(stand.say("a"), "60.0 mm/min\r\n");
  EXPECT_EQ(stand.say("p"), "SM\r\n");
  EXPECT_EQ(stand.say("n").substr(0, 7), "0.000 N") << "newtons again";
  EXPECT_NEAR(stand->stand().crosshead.position, where, 0.2e-3) << "it stays where it was";
}

TEST(EmulatorStandFaults, SlowTakesTenTimesTheLine) {
  Conversation stand(quiet({stand_fault("slow", 0, 100 * ms)}));
  EXPECT_EQ(stand->byte_time(), 86806);
  stand.say("i");
  EXPECT_EQ(stand->byte_time(), 868060);
}

TEST(EmulatorStandFaults, UnplugEndsTheLine) {
  Conversation stand(quiet({stand_fault("unplug", 1)}));
  stand.say("n");
  EXPECT_EQ(stand.say("n"), "");
  EXPECT_TRUE(stand->unplugged());
  EXPECT_FALSE(stand->plugged_again_at());
  Conversation again(quiet({stand_fault("unplug", 1, 500 * ms)}));
  again.say("nn");
  EXPECT_TRUE(again->plugged_again_at());
  again->plug_in();
  EXPECT_FALSE(again.say("x").empty());
}

TEST(EmulatorStandFaults, BeginAtTheirTime) {
  Fault timed = stand_fault("unit_change", 0);
  timed.after_messages.reset();
  timed.at = 50 * ms;
  Conversation stand(quiet({timed}));
  EXPECT_EQ(stand.say("nn"), sound + sound);                 // 20 and 40 ms
  EXPECT_NE(stand.say("n").find("lbF"), std::string::npos);  // 60 ms
}

// --- the script as a file ---

std::string refusal(const std::string& text) {
  const palpate::test::TemporaryFolder folder;
  const std::string path = (folder / "faults.toml").string();
  std::ofstream(path) << text;
  try {
    return "read " + std::to_string(read_faults(path, stand_faults()).size());
  } catch (const palpate::InputError& refused) {
    return std::string(refused.what()).substr(path.size());
  }
}

TEST(EmulatorStandFaults, ScriptsAreReadAndRefusedWithTheirPlace) {
  EXPECT_EQ(refusal("[[fault]]\nat = \"1.5 s\"\nkind = \"stall\"\nduration = \"200 ms\"\n"
                    "[[fault]]\nafter_messages = 3\nkind = \"garbage\"\nreplies = 2\n"),
            "read 2");
  EXPECT_EQ(refusal("[[fault]]\nat = \"3 mm\"\nkind = \"stall\"\n"),
            ":2:6: `at` wants a time, got `3 mm`, a length; write it as `3 s`");
  const std::string one_of_two =
      "a fault begins either `at` a time or `after_messages`; give one of the two";
  EXPECT_EQ(refusal("[[fault]]\nkind = \"stall\"\n"), ":2:8: " + one_of_two);
  EXPECT_EQ(refusal("[[fault]]\nkind = \"stall\"\nat = \"1 s\"\nafter_messages = 0\n"),
            ":2:8: " + one_of_two);
  EXPECT_EQ(refusal("[[fault]]\nat = \"1 s\"\nkind = \"stall\"\n[[fault]]\nat = \"2 s\"\n"),
            ":4:1: `kind` is missing; say what goes wrong, as `kind = \"unplug\"`");
  EXPECT_EQ(
      refusal("[[fault]]\nat = \"1 s\"\nkind = \"drop\"\nduration = \"1 s\"\n"),
      ":4:1: `duration` has no effect here: it is used only with a kind that lasts; remove it "
      "or change that");
  EXPECT_EQ(refusal("[[fault]]\nat = \"1 s\"\nkind = \"stall\"\nreplies = 2\n"),
            ":4:1: `replies` has no effect here: it is used only with a kind that spoils replies; "
            "remove it or change that");
  EXPECT_EQ(refusal("[[fault]]\nat = \"1 s\"\nkind = \"stall\"\nvalue = \"2 N\"\n"),
            ":4:1: `value` has no effect here: it is used only with a kind whose effect has a "
            "size; remove it or change that");
  EXPECT_EQ(refusal("[[fault]]\nat = \"1 s\"\nkind = \"spike\"\nvalue = \"2 mm\"\n"),
            ":4:9: `value` wants a force, got `2 mm`, a length; write it as `2 N`");
  EXPECT_EQ(refusal("[[fault]]\nat = \"-1 s\"\nkind = \"drop\"\n"),
            ":2:6: `at` must be at least 0 s, got `-1 s`; give a value in that range");
  EXPECT_EQ(refusal("[[fault]]\nat = \"1 s\"\nkind = \"drop\"\nwhen = 3\n"),
            ":4:1: `when` is not a key here; known keys: after_messages, at, duration, kind, "
            "replies, value");
  EXPECT_EQ(refusal("[[fault]]\nat = \"1 s\"\nkind = \"rst\"\n").substr(0, 62),
            ":3:8: `kind` does not know `rst`; did you mean `reset`? It is ");
}

TEST(EmulatorStandFaults, AValueStandsWithoutOneAndIsReadWithOne) {
  const palpate::test::TemporaryFolder folder;
  const std::string path = (folder / "faults.toml").string();
  std::ofstream(path) << "[[fault]]\nat = \"1 s\"\nkind = \"spike\"\n"
                         "[[fault]]\nat = \"2 s\"\nkind = \"spike\"\nvalue = \"-250 mN\"\n";
  const auto faults = read_faults(path, stand_faults());
  ASSERT_EQ(faults.size(), 2U);
  EXPECT_EQ(faults[0].value, 5.0);
  EXPECT_EQ(faults[1].value, -0.25);
  EXPECT_EQ(faults[1].at, 2000 * ms);
}

TEST(EmulatorStandFaults, ThereAreTwentyAndEachNameIsTakenOnce) {
  for (const auto& kinds : {stand_faults(), arm_faults()}) {
    std::set<std::string_view> names;
    for (const FaultKind& kind : kinds) names.insert(kind.name);
    EXPECT_EQ(names.size(), kinds.size());
    EXPECT_GE(names.size(), 20U);
  }
}

}  // namespace
}  // namespace emulator
