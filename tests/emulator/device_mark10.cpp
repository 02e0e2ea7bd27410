// The stand's link against the emulator, which shares no code with it: greeting, samples, limits,
// motion, and what the link does when something goes wrong.
#include "device/mark10.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "base/error.h"
#include "device/link.h"
#include "live_emulator.h"
#include "refusal.h"

namespace palpate::device {
namespace {

using test::has;
using test::LiveEmulator;
using test::ScratchFile;

std::string stand_refusal(const std::string& link) {
  Clock clock(Clock::Kind::monotonic);
  return test::refusal<LinkError>([&] { const Link opened(link, Purpose::look, clock); });
}

Sample next_of(Mark10& stand) {
  Sample sample;
  for (int i = 0; i < 200 && sample.arrival != Arrival::fresh; ++i) {
    sample = stand.sample(0.2);  // then it is asked again
    if (sample.arrival == Arrival::lost) break;
  }
  return sample;
}

TEST(Mark10Link, SaysWhoIsThereAndReadsForceAndTravel) {
  const LiveEmulator emulator({"mark10", "--clock", "virtual", "--tissue", "none"});
  Clock clock(Clock::Kind::monotonic);
  Mark10 stand(emulator.port(), Purpose::look, clock);
  EXPECT_EQ(stand.identity().model, "M5-2");
  EXPECT_EQ(stand.identity().id, "EMULATOR");
  EXPECT_EQ(stand.identity().firmware, "V1.00");
  EXPECT_TRUE(stand.limits().measures_force);
  const Sample sample = next_of(stand);
  ASSERT_EQ(sample.arrival, Arrival::fresh);
  EXPECT_EQ(sample.position.x(), 0.0);
  EXPECT_NEAR(sample.position.z(), 0.0, 2e-5);  // the stand's resolution
  EXPECT_NEAR(sample.force, 0.0, 0.05);         // the gauge's noise and zero
  EXPECT_GT(sample.received, 0.0);
}

TEST(Mark10Link, DoesNotMoveOrSetWhatIsOnlyLookedAt) {
  const LiveEmulator emulator({"mark10", "--clock", "virtual", "--tissue", "none"});
  Clock clock(Clock::Kind::stepped);
  Mark10 stand(emulator.port(), Purpose::look, clock);
  EXPECT_EQ(stand.set_travel_limits(-0.01, 0.01), Fault::refused);
  EXPECT_EQ(stand.move({Motion::Act::down, 1e-3}), Fault::refused);
  EXPECT_TRUE(stand.stop());
}

TEST(Mark10Link, MovesOnlyBetweenLimitsThatItReadBack) {
  const LiveEmulator emulator(
      {"mark10", "--clock", "virtual", "--tick", "20 ms", "--tissue", "none"});
  Clock clock(Clock::Kind::stepped);
  Mark10 stand(emulator.port(), Purpose::command, clock);
  EXPECT_EQ(stand.move({Motion::Act::down, 1e-3}), Fault::refused);
  EXPECT_EQ(stand.set_travel_limits(0.01, -0.01), Fault::refused);
  ASSERT_EQ(stand.set_travel_limits(-5e-3, 5e-3), Fault::none);
  EXPECT_EQ(stand.move({Motion::Act::down, 1.0}), Fault::refused);  // faster than it goes
  EXPECT_EQ(stand.move({Motion::Act::down, 0.0}), Fault::refused);
  EXPECT_EQ(stand.move({Motion::Act::down, std::nan("")}), Fault::refused);
  ASSERT_EQ(stand.move({Motion::Act::down, 5e-3}), Fault::none);
  double low = 0.0;
  for (int i = 0; i < 100; ++i) low = std::min(low, next_of(stand).position.z());
  // 2 s of the emulator's time at 5 mm/s: it would be 10 mm down without its limit.
  EXPECT_NEAR(low, -5e-3, 4e-5);  // resolution of travel and of the limit
  EXPECT_TRUE(stand.stop());
}

TEST(Mark10Link, StopsAndSaysSo) {
  const LiveEmulator emulator(
      {"mark10", "--clock", "virtual", "--tick", "20 ms", "--tissue", "none"});
  Clock clock(Clock::Kind::stepped);
  Mark10 stand(emulator.port(), Purpose::command, clock);
  ASSERT_EQ(stand.set_travel_limits(-50e-3, 5e-3), Fault::none);
  ASSERT_EQ(stand.move({Motion::Act::down, 5e-3}), Fault::none);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(next_of(stand).arrival, Arrival::fresh);
  EXPECT_TRUE(stand.stop());
  const double where = next_of(stand).position.z();
  EXPECT_LT(where, -0.5e-3);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(next_of(stand).position.z(), where);
}

TEST(Mark10Link, StopsOnItsWayOut) {
  LiveEmulator emulator({"mark10", "--clock", "virtual", "--tick", "20 ms", "--tissue", "none"});
  try {
    Clock clock(Clock::Kind::stepped);
    Mark10 stand(emulator.port(), Purpose::command, clock);
    ASSERT_EQ(stand.set_travel_limits(-50e-3, 5e-3), Fault::none);
    ASSERT_EQ(stand.move({Motion::Act::down, 1e-3}), Fault::none);
    for (int i = 0; i < 3; ++i) static_cast<void>(next_of(stand));
    throw std::runtime_error("something else went wrong");
  } catch (const std::runtime_error&) {
  }
  Clock clock(Clock::Kind::stepped);
  Mark10 again(emulator.port(), Purpose::look, clock);
  const double where = next_of(again).position.z();
  EXPECT_LT(where, 0.0);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(next_of(again).position.z(), where);
}

TEST(Mark10Link, LeavesTheGaugesUnitAsItIsWhereItOnlyLooks) {
  const ScratchFile settings("[gauge]\nunit = \"lbF\"\nnoise = \"0 N\"\n");
  const LiveEmulator emulator({"mark10", "--clock", "virtual", "--stand", settings.path()});
  Clock clock(Clock::Kind::stepped);
  Mark10 looked(emulator.port(), Purpose::look, clock);
  EXPECT_EQ(looked.identity().dialect, "gauge in lbF");
  EXPECT_EQ(next_of(looked).fault, Fault::none);
}

// Pressed into the emulator's tissue and held there: 2 mm of it, relaxed, in newton, whatever unit
// the gauge comes to show.
TEST(Mark10Link, PressesWithAPositiveForceInNewton) {
  const ScratchFile script("[[fault]]\nat = \"6 s\"\nkind = \"unit_change\"\n");
  const LiveEmulator emulator(
      {"mark10", "--clock", "virtual", "--tick", "20 ms", "--fault", script.path()});
  Clock clock(Clock::Kind::stepped);
  Mark10 stand(emulator.port(), Purpose::command, clock);
  ASSERT_EQ(stand.set_travel_limits(-4e-3, 5e-3), Fault::none);
  ASSERT_EQ(stand.move({Motion::Act::down, 5e-3}), Fault::none);
  Sample sample;
  for (int i = 0; i < 250; ++i) sample = next_of(stand);
  EXPECT_EQ(sample.fault, Fault::none);
  // The emulator's default tissue: Einf 12 kPa, nu 0.5, R 5 mm; F = 4/3 sqrt(R) E/(1-nu^2) h^1.5
  const double relaxed = 4.0 / 3.0 * std::sqrt(5e-3) * 12e3 / 0.75 * std::pow(2e-3, 1.5);
  EXPECT_NEAR(sample.force, relaxed, 0.02 * relaxed + 5e-3);  // 0.02 mm of 2 mm; the gauge's noise
  for (int i = 0; i < 100; ++i) sample = next_of(stand);
  EXPECT_EQ(sample.fault, Fault::unit_changed);
  EXPECT_NEAR(sample.force, relaxed, 0.02 * relaxed + 1e-2);  // lbF resolve less
}

TEST(Mark10Link, IsHeldByOneProgram) {
  const LiveEmulator emulator({"mark10", "--clock", "virtual"});
  Clock clock(Clock::Kind::monotonic);
  const Mark10 first(emulator.port(), Purpose::look, clock);
  EXPECT_TRUE(has(stand_refusal("mark10:" + emulator.port()), "is held by another palpate"));
}

TEST(Mark10Link, TellsWhyItCannotBeOpened) {
  EXPECT_TRUE(has(stand_refusal("mark10:/dev/no-such-port"), "is not there"));
  EXPECT_TRUE(has(stand_refusal("mark10:/dev/null"), "is no serial line"));
}

// Something that talks without being asked.
class Babbler {
 public:
  explicit Babbler(const std::string& words) : master_(::posix_openpt(O_RDWR | O_NOCTTY)) {
    ::grantpt(master_);
    ::unlockpt(master_);
    thread_ = std::thread([this, words] {
      while (!done_) {
        static_cast<void>(::write(master_, words.data(), words.size()));
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
      }
    });
  }
  ~Babbler() {
    done_ = true;
    thread_.join();
    ::close(master_);
  }
  [[nodiscard]] std::string port() const { return ::ptsname(master_); }

 private:
  int master_;
  std::atomic<bool> done_ = false;
  std::thread thread_;
};

TEST(Mark10Link, TellsOtherTalkFromAStands) {
  const Babbler noise("\xf8\x80\x9e\xfe\xe0");
  EXPECT_TRUE(
      has(stand_refusal("mark10:" + noise.port()), "garbage answers, as at a wrong baud rate"));
  const Babbler modem("OK, ready\r\n");
  EXPECT_TRUE(
      has(stand_refusal("mark10:" + modem.port()), "in words that are no reading (`OK, ready"));
}

// At a wrong rate the stand does not understand us, so that it keeps silent.
TEST(Mark10Link, NamesTheRateWhereNothingAnswers) {
  const auto refused_with = [](const char* kind) {
    const ScratchFile script("[[fault]]\nat = \"0 s\"\nkind = \"" + std::string(kind) +
                             "\"\nduration = \"600 s\"\n");
    const LiveEmulator emulator({"mark10", "--clock", "virtual", "--fault", script.path()});
    return stand_refusal("mark10:" + emulator.port());
  };
  for (const char* kind : {"wrong_baud", "deaf"})
    EXPECT_TRUE(has(refused_with(kind), "and the rate to 115200 baud")) << kind;
}

std::string refusal_with(const std::string& stand_table, Purpose purpose) {
  const ScratchFile settings("[stand]\n" + stand_table);
  const LiveEmulator emulator({"mark10", "--clock", "virtual", "--stand", settings.path()});
  Clock clock(Clock::Kind::stepped);
  return test::refusal<LinkError>(
      [&] { const Link opened("mark10:" + emulator.port(), purpose, clock); });
}

TEST(Mark10Link, NamesWhatAStandInTheFieldLacks) {
  EXPECT_TRUE(has(refusal_with("pc_control = false\n", Purpose::command),
                  "is read and does not obey; switch PC Control on in its menu"));
  EXPECT_TRUE(has(refusal_with("travel_display = false\n", Purpose::look),
                  "sends a force and no travel; it has no travel display"));
}

TEST(Mark10Link, ReadsAStandThatSendsTheTravelFirst) {
  const ScratchFile settings("[stand]\norder = \"travel_first\"\n");
  const LiveEmulator emulator(
      {"mark10", "--clock", "virtual", "--tissue", "none", "--stand", settings.path()});
  Clock clock(Clock::Kind::stepped);
  Mark10 stand(emulator.port(), Purpose::command, clock);
  ASSERT_EQ(stand.set_travel_limits(-5e-3, 5e-3), Fault::none);
  ASSERT_EQ(stand.move({Motion::Act::down, 2e-3}), Fault::none);
  Sample sample;
  for (int i = 0; i < 50; ++i) {
    sample = stand.sample(test::wire_patience);
    ASSERT_EQ(sample.arrival, Arrival::fresh);
  }
  EXPECT_LT(sample.position.z(), -1e-3);
  EXPECT_TRUE(stand.stop());
}

// Without a status, equal readings of the travel tell that the stand has stopped.
TEST(Mark10Link, StopsAStandThatReportsNoStatus) {
  const ScratchFile settings("[stand]\nstatus = \"none\"\n");
  LiveEmulator emulator(
      {"mark10", "--clock", "virtual", "--tissue", "none", "--stand", settings.path()});
  Clock clock(Clock::Kind::stepped);
  {
    Mark10 stand(emulator.port(), Purpose::command, clock);
    const std::vector<std::string>& notes = stand.identity().notes;
    EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
      return has(note, "does not report its status (`p`)");
    }));
    ASSERT_EQ(stand.set_travel_limits(-5e-3, 5e-3), Fault::none);
    ASSERT_EQ(stand.move({Motion::Act::down, 2e-3}), Fault::none);
    (void)next_of(stand);
    EXPECT_TRUE(stand.stop());
  }
  EXPECT_EQ(emulator.end().at("summary").at("moving"), false);
}

TEST(Mark10Link, DoesNotMoveAStandThatHasForgottenItsLimits) {
  const ScratchFile script("[[fault]]\nat = \"1.5 s\"\nkind = \"reset\"\n");
  const LiveEmulator emulator(
      {"mark10", "--clock", "virtual", "--tissue", "none", "--fault", script.path()});
  Clock clock(Clock::Kind::stepped);
  Mark10 stand(emulator.port(), Purpose::command, clock);
  ASSERT_EQ(stand.set_travel_limits(-5e-3, 5e-3), Fault::none);
  EXPECT_EQ(stand.move({Motion::Act::down, 1e-3}), Fault::none);
  for (int i = 0; i < 100; ++i) static_cast<void>(next_of(stand));
  EXPECT_EQ(stand.move({Motion::Act::down, 1e-3}), Fault::not_verified);
}

// The stand reads a limit back in steps of 0.02 mm, wherever between two of them it was asked for.
TEST(Mark10Link, SetsLimitsBetweenTheStepsOfTheStand) {
  LiveEmulator emulator({"mark10", "--clock", "virtual", "--tissue", "none"});
  Clock clock(Clock::Kind::stepped);
  Mark10 stand(emulator.port(), Purpose::command, clock);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(stand.set_travel_limits(-5e-3 - 2e-6 * i, 5e-3 + 3e-6 * i), Fault::none) << i;
    EXPECT_NEAR(stand.limits().low, -5e-3 - 2e-6 * i, 1.001e-5);  // half a step
  }
}

// A stand that cannot go as fast takes what it can; it does not start at a speed that nobody asked
// for.
TEST(Mark10Link, DoesNotMoveAtAnotherSpeedThanAsked) {
  const ScratchFile slow("[stand]\nfastest = \"600 mm/min\"\n");
  LiveEmulator emulator(
      {"mark10", "--clock", "virtual", "--tissue", "none", "--stand", slow.path()});
  Clock clock(Clock::Kind::stepped);
  Mark10 stand(emulator.port(), Purpose::command, clock);
  ASSERT_EQ(stand.set_travel_limits(-5e-3, 5e-3), Fault::none);
  EXPECT_EQ(stand.move({Motion::Act::down, 12e-3}), Fault::not_verified);  // 720 mm/min
  EXPECT_EQ(next_of(stand).position.z(), 0.0);
  EXPECT_EQ(stand.move({Motion::Act::down, 10e-3}), Fault::none);
}

TEST(Mark10Link, SaysWhereAStopIsNotObeyed) {
  const ScratchFile script("[[fault]]\nat = \"2 s\"\nkind = \"runaway\"\n");
  const LiveEmulator emulator(
      {"mark10", "--clock", "virtual", "--tissue", "none", "--fault", script.path()});
  Clock clock(Clock::Kind::monotonic);
  Mark10 stand(emulator.port(), Purpose::command, clock);
  ASSERT_EQ(stand.set_travel_limits(-100e-3, 5e-3), Fault::none);
  ASSERT_EQ(stand.move({Motion::Act::down, 1e-3}), Fault::none);
  for (int i = 0; i < 100; ++i) static_cast<void>(next_of(stand));
  EXPECT_FALSE(stand.stop());
  EXPECT_EQ(stand.move({}), Fault::not_verified);
}

class Mark10Deaths : public testing::TestWithParam<int> {};

// Another process drives the stand down and dies by a signal: the stand stands.
TEST_P(Mark10Deaths, StopTheStand) {
  const LiveEmulator emulator(
      {"mark10", "--clock", "virtual", "--tick", "20 ms", "--tissue", "none"});
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(2);
    ::signal(GetParam(), SIG_DFL);  // a sanitizer has handlers of its own
    Clock clock(Clock::Kind::stepped);
    Mark10 stand(emulator.port(), Purpose::command, clock);
    if (stand.set_travel_limits(-50e-3, 5e-3) != Fault::none) ::_exit(1);
    if (stand.move({Motion::Act::down, 5e-3}) != Fault::none) ::_exit(2);
    for (int i = 0; i < 5; ++i) static_cast<void>(next_of(stand));
    ::raise(GetParam());
    ::_exit(3);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status)) << WEXITSTATUS(status);
  Clock clock(Clock::Kind::stepped);
  Mark10 again(emulator.port(), Purpose::look, clock);
  const double where = next_of(again).position.z();
  EXPECT_LT(where, -0.2e-3);
  bool stands = true;
  for (int i = 0; i < 5; ++i) stands = stands && next_of(again).position.z() == where;
  EXPECT_TRUE(stands);
}

INSTANTIATE_TEST_SUITE_P(Signals, Mark10Deaths,
                         testing::Values(SIGINT, SIGTERM, SIGHUP, SIGSEGV, SIGABRT, SIGKILL));

struct StandFault {
  const char* kind;
  Fault fault;            // that must be seen at least once
  bool lost;              // whether the link ends
  const char* more = "";  // keys of its table
};
void PrintTo(const StandFault& fault, std::ostream* out) { *out << fault.kind; }
class Mark10Faults : public testing::TestWithParam<StandFault> {};

// A byte that is no request takes the emulator's clock on by 87 us alone: 2 ms are some ten of
// them. Of 60 samples the fault falls in the middle; what is fresh is right, and all that follows
// comes.
TEST_P(Mark10Faults, AreSeenAndPassedOver) {
  const StandFault& expected = GetParam();
  const ScratchFile script("[[fault]]\nat = \"0.8 s\"\nkind = \"" + std::string(expected.kind) +
                           "\"\n" + expected.more);
  const LiveEmulator emulator({"mark10", "--clock", "virtual", "--tick", "20 ms", "--tissue",
                               "none", "--fault", script.path()});
  Clock clock(Clock::Kind::monotonic);
  Mark10 stand(emulator.port(), Purpose::look, clock);
  bool seen = false;
  bool lost = false;
  int fresh_in_the_end = 0;
  for (int i = 0; i < 60 && !lost; ++i) {
    Sample sample = stand.sample(0.15);
    seen = seen || sample.fault == expected.fault;
    // In the end all are fresh, on a busy machine in a few tries.
    for (int tries = 0; i >= 50 && tries < 20 && sample.arrival == Arrival::none; ++tries)
      sample = stand.sample(0.15);
    lost = sample.arrival == Arrival::lost;
    if (sample.arrival == Arrival::fresh) {
      EXPECT_NEAR(sample.force, 0.0, 0.1) << i;          // noise; a wrong reading is not near
      EXPECT_NEAR(sample.position.z(), 0.0, 4e-5) << i;  // it stands
      if (i >= 50) ++fresh_in_the_end;
    }
  }
  EXPECT_TRUE(seen);
  EXPECT_EQ(lost, expected.lost);
  if (!expected.lost) {
    EXPECT_EQ(fresh_in_the_end, 10);
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, Mark10Faults,
    testing::Values(
        StandFault{"unplug", Fault::hung_up, true}, StandFault{"garbage", Fault::garbage, false},
        StandFault{"truncate", Fault::truncated, false},
        StandFault{"glue", Fault::truncated, false}, StandFault{"drop", Fault::silent, false},
        StandFault{"duplicate", Fault::none, false},
        StandFault{"error_reply", Fault::error_reply, false},
        StandFault{"unsolicited", Fault::none, false}, StandFault{"nul", Fault::garbage, false},
        StandFault{"nan", Fault::garbage, false}, StandFault{"huge", Fault::garbage, false},
        StandFault{"no_travel", Fault::truncated, false},
        StandFault{"swap", Fault::truncated, false},
        StandFault{"unit_change", Fault::unit_changed, false},
        StandFault{"travel_unit_change", Fault::none, false},
        StandFault{"freeze", Fault::none, false, "duration = \"0.1 s\"\n"},
        StandFault{"stall", Fault::silent, false, "duration = \"0.1 s\"\n"},
        StandFault{"deaf", Fault::silent, false, "duration = \"2 ms\"\n"},
        StandFault{"echo", Fault::garbage, false, "duration = \"0.1 s\"\n"},
        StandFault{"overload", Fault::overload, false, "duration = \"0.1 s\"\n"},
        StandFault{"wrong_baud", Fault::silent, false, "duration = \"2 ms\"\n"},
        StandFault{"slow", Fault::none, false, "duration = \"0.1 s\"\n"}),
    [](const auto& one) { return std::string(one.param.kind); });

}  // namespace
}  // namespace palpate::device
