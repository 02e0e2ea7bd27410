// Settings of a gauge: the examples, the defaults, and what is refused with its place.
#include "device/line_settings.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "base/error.h"
#include "device/line_gauge.h"
#include "refusal.h"
#include "temporary_folder.h"

namespace palpate::device {
namespace {

TEST(LineSettings, OfTheExamplesAreRead) {
  const std::string folder = PALPATE_SOURCE_DIR "/scenarios/gauges/";
  const LineSettings sketch = read_line_settings(folder + "hx711.toml");
  EXPECT_EQ(sketch.line.baud, 57600);
  EXPECT_EQ(sketch.start, "t");
  EXPECT_EQ(sketch.force_unit, "g");
  EXPECT_EQ(read_line_settings(folder + "mark10_gauge.toml").poll, "?C\r");
  const LineSettings balance = read_line_settings(folder + "balance.toml");
  EXPECT_EQ(balance.line.data_bits, 7);
  EXPECT_EQ(balance.line.parity, LineFormat::Parity::even);
  EXPECT_DOUBLE_EQ(*balance.start_force, 0.1);
}

TEST(LineSettings, AreRefusedAtTheirPlace) {
  const test::TemporaryFolder folder;
  const auto refusal = [&](const std::string& text) {
    const std::string path = folder.file("g.toml", text);
    return test::refusal([&] { (void)read_line_settings(path); }).substr(path.size());
  };
  const std::string good = "pattern = \"{force} {force_unit}\"\n";
  EXPECT_EQ(refusal(good + "baud = 12345\n"),
            ":2:8: no serial line has a rate of 12345 baud; write 300, 600, 1200, 2400, 4800, "
            "9600, 19200, 38400, 57600, 115200, 230400, 460800, 500000, 921600 or 1000000");
  for (const auto& [text, part] : std::vector<std::pair<std::string, const char*>>{
           {"baud = 9600\n", "`pattern` is missing"},
           {"pattern = \"{force}\"\n", "gives the force no unit; add `force_unit`"},
           {"pattern = \"{force} {force_unit} {travel}\"\n", "add `travel_unit`"},
           {"pattern = \"{force}\"\nforce_unit = \"kp\"\n", "`kp` is no unit of it; write `N`"},
           {good + "force_unit = \"N\"\n", "takes the unit from the lines"},
           {good + "travel_unit = \"mm\"\n", "the pattern has no `{travel}`"},
           {good + "force_scale = 0\n", "makes every force 0"},
           {good + "data_bits = 9\n", "data_bits"},
           {good + "bauds = 9600\n", "bauds"},
           {good + "poll = 'Q\\r\\n'\n", "single quotes of TOML keep them"},
           {good + "start = 't\\n'\n", "no line end"},
           {"pattern = \"{weight}\"\n", "got `{weight}`"},
           {"pattern = \"{force} {force_unit} {travel} {travel_unit}\"\nstart_force = \"1 N\"\n",
            "the lines have a travel"}})
    EXPECT_NE(refusal(text).find(part), std::string::npos) << text << refusal(text);
}

// A gauge on a pseudo-terminal that answers at once is asked no more often than `rate` says;
// however slow this machine is, it takes longer, never less.
TEST(LineGauge, PollsKeepTheirRate) {
  const test::TemporaryFolder folder;
  const int master = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  ASSERT_GE(master, 0);
  ASSERT_EQ(::grantpt(master), 0);
  ASSERT_EQ(::unlockpt(master), 0);
  const std::string port = ::ptsname(master);
  std::atomic<int> polls = 0;
  std::atomic<bool> over = false;
  std::thread answering([&] {
    char byte = 0;
    while (!over) {
      pollfd waiting{master, POLLIN, 0};
      if (::poll(&waiting, 1, 20) <= 0 || ::read(master, &byte, 1) != 1 || byte != '?') continue;
      ++polls;
      if (::write(master, "1.5\n", 4) != 4) return;
    }
  });
  constexpr double rate = 50.0;
  constexpr int readings = 10;
  {
    Clock clock(Clock::Kind::monotonic);
    LineGauge gauge({port, folder.file("g.toml",
                                       "pattern = \"{force}\"\nforce_unit = \"N\"\n"
                                       "poll = \"?\"\nrate = 50\n")},
                    clock);
    const double start = wire_time();
    for (int heard = 0; heard < readings && wire_time() < start + 20.0;)
      heard += gauge.sample(1.0).arrival == Arrival::fresh ? 1 : 0;
    // The first poll may be due at once.
    EXPECT_GE(wire_time() - start, (readings - 1) / rate);
    EXPECT_LE(polls, 2 + static_cast<int>((wire_time() - start + 1.0 / rate) * rate));
  }
  over = true;
  answering.join();
  ::close(master);
}

}  // namespace
}  // namespace palpate::device
