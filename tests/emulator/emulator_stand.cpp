// The stand's bytes, on the virtual clock and without a port.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "stand_conversation.h"

namespace emulator {
namespace {

using test::Conversation;
using test::quiet;

// ESM301/ESM303 guides, 6.2: e0200.3 = 200.3 mm/min, g-007.52 = -7.52 mm, g010.70 = 10.7 mm, h the
// same, f0500 = 500 cycles; e02.85 = 2.85 in/min, g-00.550 = -0.55 in, g01.258 = 1.258 in.
TEST(EmulatorStand, TakesNumbersAsTheGuideWritesThem) {
  Conversation stand(quiet());
  EXPECT_EQ(stand.say("e0200.3"), "");
  EXPECT_EQ(stand.say("a"), "200.3 mm/min\r\n");
  EXPECT_EQ(stand.say("g-007.52h010.70"), "");
  EXPECT_EQ(stand.say("v"), "10.70 mm\r\n");  // v: upper travel limit
  EXPECT_EQ(stand.say("w"), "-7.52 mm\r\n");  // w: lower travel limit
  EXPECT_EQ(stand.say("f0500r"), "500\r\n");
  EXPECT_EQ(stand.say("be02.85a"), "2.85 in/min\r\n");
  EXPECT_NEAR(stand->stand().crosshead.speed, 2.85 * 25.4e-3 / 60.0, 1e-15);  // rounding
  EXPECT_EQ(stand.say("g-00.550h01.258"), "");
  EXPECT_NEAR(stand->stand().crosshead.lower_limit, -0.55 * 25.4e-3, 1e-15);
  EXPECT_NEAR(stand->stand().crosshead.upper_limit, 1.258 * 25.4e-3, 1e-15);
  EXPECT_EQ(stand.say("x"), "0.000 in\r\n");
  EXPECT_EQ(stand.say("ix"), "0.00 mm\r\n");
}

TEST(EmulatorStand, SettersAndMotionAreMute) {
  Conversation stand(quiet());
  for (const char byte : std::string("ibzudslmcjkot")) EXPECT_EQ(stand.say({byte}), "") << byte;
  for (const char byte : std::string("ABNyQ0 \r\n\x01\xff"))
    EXPECT_EQ(stand.say({byte}), "") << "unknown bytes are ignored";
}

TEST(EmulatorStand, AnswersForceThenTravel) {
  Mark10Settings settings = quiet();
  Conversation stand(settings);
  EXPECT_EQ(stand.say("n"), "0.000 N\r\n0.00 mm\r\n");
  EXPECT_EQ(stand.say("e0060.0d"), "");
  while (stand->now() < 1'000'000'000) stand.say("p");
  stand.say("s");
  while (stand.say("p") != "SM\r\n") {
  }
  const std::string reply = stand.say("n");
  // 60 mm/min for a second and the braking way, in steps of 0.02 mm.
  const double steps = std::round(stand->stand().crosshead.position / 0.02e-3);
  EXPECT_EQ(reply, "0.000 N\r\n" + in_steps(steps * 0.02, 0.01) + " mm\r\n");
  EXPECT_NEAR(stand->stand().crosshead.position, -1e-3, 0.03e-3);  // sent off within the 20 ms tick
  EXPECT_EQ(stand.say("zx"), "0.00 mm\r\n");
}

TEST(EmulatorStand, SaysItsStatus) {
  Mark10Settings settings = quiet();
  Conversation stand(settings);
  EXPECT_EQ(stand.say("p"), "SM\r\n");
  stand.say("lg-000.50h000.50e0600.0");
  EXPECT_EQ(stand.say("p"), "SL\r\n");
  EXPECT_EQ(stand.say("dp"), "DL\r\n");
  for (int i = 0; i < 20; ++i) stand.say("p");
  EXPECT_EQ(stand.say("p"), "SLDL\r\n");
  EXPECT_EQ(stand->stand().crosshead.position, -0.5e-3);
  EXPECT_EQ(stand.say("up"), "UL\r\n");
  for (int i = 0; i < 20; ++i) stand.say("p");
  EXPECT_EQ(stand.say("p"), "SLUL\r\n");
  EXPECT_EQ(stand.say("f0002cdp"), "DC\r\n");
  for (int i = 0; i < 60; ++i) stand.say("p");
  EXPECT_EQ(stand.say("q"), "2\r\n");
  settings.stand.status = StatusLayout::spaced;
  Conversation spaced(settings);
  spaced.say("lg-000.50e0600.0d");
  for (int i = 0; i < 20; ++i) spaced.say("p");
  EXPECT_EQ(spaced.say("p"), "S L DL\r\n");
}

TEST(EmulatorStand, StopsEvenInsideABrokenNumber) {
  Conversation stand(quiet());
  stand.say("d");
  EXPECT_EQ(stand.say("e02s"), "");
  EXPECT_EQ(stand->stand().crosshead.direction, 0);
  EXPECT_EQ(stand.say("g-0p").substr(0, 1), "S");
  EXPECT_EQ(stand.say("a"), "60.0 mm/min\r\n") << "the broken number set nothing";
}

TEST(EmulatorStand, LimitsMoveWithTheZero) {
  Conversation stand(quiet());
  stand.say("e0600.0d");
  while (stand->now() < 500'000'000) stand.say("p");
  stand.say("s");
  for (int i = 0; i < 10; ++i) stand.say("p");
  stand.say("g-002.00z");
  EXPECT_EQ(stand.say("w"), "-2.00 mm\r\n");
  stand.say("ld");
  for (int i = 0; i < 50; ++i) stand.say("p");
  EXPECT_EQ(stand.say("x"), "-2.00 mm\r\n");
}

// ESM303 guide 6.2.1: `/` opens the gauge's channel, `\` closes it. GCL2 ends with CR, LF is
// ignored.
TEST(EmulatorStand, PassesLinesToTheGauge) {
  Conversation stand(quiet());
  EXPECT_EQ(stand.say("/?\r"), "0.000 N\r\n");
  EXPECT_EQ(stand.say("LB\r\n?\r\n"), "0.0000 lbF\r\n");
  EXPECT_EQ(stand.say("d\r"), "*10\r\n") << "no motion through the gauge's channel";
  EXPECT_EQ(stand.say("LIS"), "");
  EXPECT_EQ(stand.say("\\"), "");
  EXPECT_EQ(stand.say("n"), "0.0000 lbF\r\n0.00 mm\r\n");
  EXPECT_EQ(stand->stand().crosshead.direction, 0);
  EXPECT_EQ(stand.say("/RN\r"), "Series 5\r\n");
  EXPECT_EQ(stand.say("AOUT50\rLIST\r").find("AOUT50") != std::string::npos, true);
  EXPECT_EQ(stand.say("\\"), "");
  EXPECT_EQ(stand.say("x"), "0.0000 lbF\r\n0.00 mm\r\n") << "its own output comes in between";
  EXPECT_EQ(stand.say("/AOUT0\r\\x"), "0.0000 lbF\r\n0.00 mm\r\n");
  EXPECT_EQ(stand.say("x"), "0.00 mm\r\n");
}

TEST(EmulatorStand, WithoutItsOptionItOnlyReads) {
  Mark10Settings settings = quiet();
  settings.stand.pc_control = false;
  Conversation stand(settings);
  EXPECT_EQ(stand.say("le0100.0dp"), "SM\r\n");
  EXPECT_EQ(stand.say("n"), "0.000 N\r\n0.00 mm\r\n");
  EXPECT_EQ(stand->stand().crosshead.direction, 0);
}

TEST(EmulatorStand, ReadsWhatItsTissueGives) {
  Mark10Settings settings = quiet();
  settings.stand.tissue = {.E0 = 40e3, .E_inf = 40e3, .tau = 1.0, .R = 10e-3, .surface = -1e-3};
  settings.stand.gauge.filter = 0;
  Conversation stand(settings);
  stand.say("lg-003.00e0300.0d");
  for (int i = 0; i < 60; ++i) stand.say("p");
  // Elastic: F = 4/3 E/(1 - nu^2) sqrt(R) h^(3/2), h = 2 mm, nu = 0.5.
  const double force = 4.0 / 3.0 * 40e3 / 0.75 * std::sqrt(10e-3) * std::pow(2e-3, 1.5);
  EXPECT_EQ(stand.say("n"), in_steps(force, 2e-3) + " N\r\n-3.00 mm\r\n");
}

TEST(EmulatorStand, StopsWhenItsGaugeIsOverloaded) {
  Mark10Settings settings = quiet();
  settings.stand.tissue = {.E0 = 1e6, .E_inf = 1e6, .tau = 1.0, .R = 10e-3, .surface = 0.0};
  Conversation stand(settings);
  stand.say("e0060.0d");
  for (int i = 0; i < 200; ++i) stand.say("p");
  EXPECT_EQ(stand.say("p"), "SM\r\n");
  EXPECT_EQ(stand.say("n").substr(0, 10), "OVERLOAD\r\n");
  // 110 % of 10 N, and what one step and the braking way of 2.5 um add.
  EXPECT_NEAR(stand->stand().greatest_force, 11.0, 0.1);
  EXPECT_EQ(stand.say("dp"), "SM\r\n") << "no further";
  stand.say("u");
  for (int i = 0; i < 20; ++i) stand.say("p");
  EXPECT_LT(std::stod(stand.say("n")), 11.0) << "back is free";
}

TEST(EmulatorStand, AnswersAtTheTicksOfTheVirtualClock) {
  Mark10Settings settings = quiet();
  Conversation stand(settings);
  // Ten bits a byte at 115200 a second; `n` is answered at 20 ms, its reply is 18 bytes long.
  stand.say("i");
  EXPECT_EQ(stand->now(), 86806);
  const auto length = static_cast<Nanoseconds>(stand.say("n").size());
  EXPECT_EQ(stand->now(), 20'000'000 + 86806 * length);
  stand.say("n");
  EXPECT_EQ(stand->now(), 40'000'000 + 86806 * length);
}

TEST(EmulatorStand, SameBytesInSameBytesOut) {
  Mark10Settings settings;
  settings.clock = Clock::lockstep;
  const auto all = [&settings] {
    Conversation stand(settings);
    std::string bytes = stand.say("lg-004.00e0300.0d");
    for (int i = 0; i < 100; ++i) bytes += stand.say("n");
    return bytes;
  };
  const std::string first = all();
  EXPECT_EQ(first, all());
  settings.stand.seed = 2;
  EXPECT_NE(first, all()) << "the seed is of the noise";
}

}  // namespace
}  // namespace emulator
