// The arm's link and the events port of the emulated service: what it obeys, what it tells, and
// that nothing which comes there, or does not, holds it up.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/error.h"
#include "device/inverse3.h"
#include "device/inverse3_protocol.h"
#include "device/link.h"
#include "device/safety.h"
#include "live_emulator.h"

namespace palpate::device {
namespace {

using test::LiveEmulator;
using test::ScratchFile;

std::string at(const char* time, const std::string& kind, const std::string& more = {}) {
  return "[[fault]]\nkind = \"" + kind + "\"\nat = \"" + time + "\"\n" + more;
}

std::vector<std::string> arguments(const ScratchFile& script, const char* clock = "virtual") {
  return {"inverse3", "--clock", clock, "--fault", script.path()};
}

std::uint64_t count(const Inverse3& arm, Event event) {
  return arm.traffic().events.counts[static_cast<std::size_t>(event)];
}

bool any_has(const std::vector<std::string>& notes, const std::string& part) {
  return std::any_of(notes.begin(), notes.end(),
                     [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

// Frames that ask for 1 N upwards, armed after 20; the fault falls at 0.1 s.
struct Heard {
  Trip trip = Trip::none;
  Fault fault = Fault::none;      // of the first sample that had one
  int fault_at = -1;              // its frame
  int fresh = 0;                  // samples
  bool lost = false;              //
  bool armed_in_the_end = false;  //
  bool armed_again = false;       // when asked to, in the end
  double longest_after = 0.0;     // N, sent 60 frames after the fault and later
  Events events;
};
Heard heard_with(const std::string& script_text, int frames = 300) {
  const ScratchFile script(script_text);
  const LiveEmulator emulator(arguments(script));
  Clock clock(Clock::Kind::stepped);
  Link link(emulator.arm_link(), Purpose::command, clock);
  ArmSafety safety{ArmRules{}};
  Heard heard;
  for (int i = 0; i < frames && !heard.lost; ++i) {
    const Sample sample = link.sample(test::wire_patience);
    const double now = clock.now();
    if (sample.arrival == Arrival::fresh) ++heard.fresh;
    heard.lost = sample.arrival == Arrival::lost;
    if (sample.fault != Fault::none && heard.fault_at < 0) {
      heard.fault = sample.fault;
      heard.fault_at = i;
    }
    static_cast<void>(safety.take(now, sample));
    if (i == 20) {
      EXPECT_TRUE(safety.arm(now, -1.0));
    }
    const Vec3 force = safety.allow(now, {0.0, 0.0, 1.0});
    if (heard.fault_at >= 0 && i > heard.fault_at + 60)
      heard.longest_after = std::max(heard.longest_after, force.norm());
    static_cast<void>(link.command_force(force));
  }
  heard.trip = safety.tripped();
  heard.armed_in_the_end = safety.armed();
  heard.armed_again = safety.arm(clock.now(), -1.0);
  heard.events = link.traffic().events;
  return heard;
}

struct Obeyed {
  const char* kind;
  Fault fault;
  Event event;
};
void PrintTo(const Obeyed& one, std::ostream* out) { *out << one.kind; }
class EventsObeyed : public testing::TestWithParam<Obeyed> {};

// The state goes on as if nothing were: only the event says that something is.
TEST_P(EventsObeyed, TripAtOnceAndForGood) {
  const Heard heard = heard_with(at("0.1 s", GetParam().kind));
  EXPECT_EQ(heard.trip, Trip::brake);
  EXPECT_EQ(heard.fault, GetParam().fault);
  // The greeting takes a few frames of the 100.
  EXPECT_GE(heard.fault_at, 85);
  EXPECT_LE(heard.fault_at, 101);
  EXPECT_EQ(heard.fresh, 300);
  EXPECT_EQ(heard.longest_after, 0.0);
  EXPECT_FALSE(heard.armed_in_the_end);
  EXPECT_FALSE(heard.armed_again);
  EXPECT_EQ(heard.events.counts[static_cast<std::size_t>(GetParam().event)], 1u);
  EXPECT_EQ(heard.events.port, Events::Port::heard);
}

INSTANTIATE_TEST_SUITE_P(All, EventsObeyed,
                         testing::Values(Obeyed{"event_stall", Fault::stalled, Event::stall},
                                         Obeyed{"event_ceiling", Fault::unstable, Event::ceiling},
                                         Obeyed{"event_stage", Fault::brake, Event::stage_raised},
                                         Obeyed{"event_unknown", Fault::brake, Event::safety}),
                         [](const auto& one) { return std::string(one.param.kind); });

TEST(ArmEventsPort, TellsABrakeThatTheStateDoesNot) {
  const Heard heard = heard_with(at("0.1 s", "event_brake", "duration = \"2 ms\"\n"));
  EXPECT_EQ(heard.trip, Trip::brake);
  EXPECT_EQ(heard.events.counts[static_cast<std::size_t>(Event::brake)], 1u);
  EXPECT_EQ(heard.events.counts[static_cast<std::size_t>(Event::released)], 1u);
  EXPECT_EQ(heard.longest_after, 0.0);
  EXPECT_FALSE(heard.armed_again) << "released, and not armed by that";
}

// While it holds every sample says so, as one who only looks wants to know it.
TEST(ArmEventsPort, KeepsABrakeTillItsRelease) {
  const ScratchFile script(at("0.1 s", "event_brake", "duration = \"50 ms\"\n"));
  const LiveEmulator emulator(arguments(script));
  Clock clock(Clock::Kind::monotonic);
  Inverse3 arm(std::get<ArmAddress>(parse_link(emulator.arm_link())), Purpose::look, clock);
  int braked = 0;
  for (int i = 0; i < 300; ++i)
    if (arm.sample(test::wire_patience).fault == Fault::brake) ++braked;
  EXPECT_GE(braked, 49);  // frames of 1 ms, give or take its ends
  EXPECT_LE(braked, 51);
}

TEST(ArmEventsPort, LosesAnArmThatWasDisconnected) {
  const Heard heard = heard_with(at("0.1 s", "event_disconnect"));
  EXPECT_TRUE(heard.lost);
  EXPECT_EQ(heard.fault, Fault::hung_up);
  EXPECT_EQ(heard.trip, Trip::link_lost);
  EXPECT_FALSE(heard.armed_again);
}

struct Passed {
  const char* kind;
  Event event;
  std::uint64_t times;
  Events::Port port;
};
void PrintTo(const Passed& one, std::ostream* out) { *out << one.kind; }
class EventsPassed : public testing::TestWithParam<Passed> {};

// Told or counted, and the session goes on; a stall that comes later is heard all the same, unless
// the port is gone.
TEST_P(EventsPassed, NeitherTripNorStop) {
  const int frames = 300;
  const Heard heard = heard_with(at("0.1 s", GetParam().kind), frames);
  EXPECT_EQ(heard.trip, Trip::none);
  EXPECT_EQ(heard.fault, Fault::none);
  EXPECT_EQ(heard.fresh, frames);
  EXPECT_TRUE(heard.armed_in_the_end);
  EXPECT_EQ(heard.events.counts[static_cast<std::size_t>(GetParam().event)], GetParam().times);
  EXPECT_EQ(heard.events.port, GetParam().port);
  if (GetParam().port != Events::Port::heard) return;
  const Heard later =
      heard_with(at("0.1 s", GetParam().kind) + at("0.15 s", "event_stall"), frames);
  EXPECT_EQ(later.trip, Trip::brake);
  EXPECT_EQ(later.fault, Fault::stalled);
}

INSTANTIATE_TEST_SUITE_P(
    All, EventsPassed,
    testing::Values(Passed{"event_busy", Event::busy, 1, Events::Port::heard},
                    Passed{"event_other", Event::other_device, 1, Events::Port::heard},
                    Passed{"event_garbage", Event::garbage, 1, Events::Port::heard},
                    Passed{"event_partial", Event::garbage, 1, Events::Port::heard},
                    Passed{"event_huge", Event::garbage, 1, Events::Port::heard},
                    Passed{"events_close", Event::other, 0, Events::Port::lost}),
    [](const auto& one) { return std::string(one.param.kind); });

// A fault must not wait behind 2000 other events, nor a frame for 20000 replies.
TEST(ArmEventsPort, IsLostWithTheLinkWhereItSendsMoreThanIsRead) {
  for (const char* kind : {"event_flood", "flood"}) {
    // In lock-step the frames do not wait for the flood, which takes its own time to come.
    const Heard heard = heard_with(at("0.1 s", kind), 20000);
    EXPECT_TRUE(heard.lost) << kind;
    EXPECT_EQ(heard.fault, Fault::flooded) << kind;
    EXPECT_EQ(heard.trip, Trip::link_lost) << kind;
    EXPECT_GE(heard.fault_at, 85) << kind;
    EXPECT_FALSE(heard.armed_again) << kind;
  }
}

TEST(ArmEventsPort, ThatIsHalfOpenIsSimplySilent) {
  const Heard heard = heard_with(at("0.1 s", "events_half_open") + at("0.15 s", "event_stall"));
  EXPECT_EQ(heard.trip, Trip::none);
  EXPECT_EQ(heard.fresh, 300);
}

// An older service has none; and a link may say that it is not to be listened to.
TEST(ArmEventsPort, ThatIsNotThereIsANoteAndNoError) {
  std::string free_port;
  {
    const LiveEmulator gone({"inverse3"});
    free_port = gone.port();
  }
  const ScratchFile script(at("0.1 s", "event_stall"));
  for (const std::string& events : {free_port, std::string("none")}) {
    const LiveEmulator emulator(arguments(script));
    Clock clock(Clock::Kind::stepped);
    const std::string link = "inverse3:127.0.0.1:" + emulator.port() + ":" + events;
    Inverse3 arm(std::get<ArmAddress>(parse_link(link)), Purpose::look, clock);
    const auto& notes = arm.identity().notes;
    EXPECT_TRUE(any_has(notes, events == "none" ? "are not listened to" : "are not heard"));
    for (int i = 0; i < 200; ++i) EXPECT_EQ(arm.sample(test::wire_patience).fault, Fault::none);
    EXPECT_EQ(arm.traffic().events.port, Events::Port::unheard);
    EXPECT_EQ(count(arm, Event::stall), 0u);
  }
}

TEST(ArmEventsPort, SaysAtTheGreetingThatTheArmIsGoneOrBusy) {
  const ScratchFile gone(at("2 ms", "event_disconnect"));
  const ScratchFile busy(at("2 ms", "event_busy"));
  Clock clock(Clock::Kind::monotonic);
  const LiveEmulator without(arguments(gone));
  EXPECT_THROW(Link(without.arm_link(), Purpose::look, clock), LinkError);
  const LiveEmulator shared(arguments(busy));
  const Link link(shared.arm_link(), Purpose::look, clock);
  EXPECT_TRUE(any_has(link.identity().notes, "another session"));
}

}  // namespace
}  // namespace palpate::device
