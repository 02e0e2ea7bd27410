// Settings of a gauge: the examples, the defaults, and what is refused with its place.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/index.h"
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

// A gauge on a pseudo-terminal that answers each `?` by the next of its texts, the last ones by the
// last.
class AnsweringGauge {
 public:
  explicit AnsweringGauge(std::vector<std::string> texts,
                          std::chrono::milliseconds takes = std::chrono::milliseconds(0))
      : texts_(std::move(texts)), takes_(takes) {
    if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0)
      throw std::runtime_error("no pseudo-terminal");
    port_ = ::ptsname(master_);
    thread_ = std::thread([this] { answer(); });
  }
  ~AnsweringGauge() {
    over_ = true;
    thread_.join();
    ::close(master_);
  }
  AnsweringGauge(const AnsweringGauge&) = delete;
  AnsweringGauge& operator=(const AnsweringGauge&) = delete;

  // With these settings besides `poll`.
  [[nodiscard]] GaugeAddress address(const std::string& settings) const {
    return {port_, folder_.file("g.toml", settings + "poll = \"?\"\n")};
  }
  [[nodiscard]] int polls() const { return polls_; }

 private:
  void answer() {
    char byte = 0;
    while (!over_) {
      pollfd waiting{master_, POLLIN, 0};
      if (::poll(&waiting, 1, 20) <= 0 || ::read(master_, &byte, 1) != 1 || byte != '?') continue;
      const std::string& text = texts_[std::min(as_index(polls_++), texts_.size() - 1)];
      std::this_thread::sleep_for(takes_);
      if (::write(master_, text.data(), text.size()) != static_cast<ssize_t>(text.size())) return;
    }
  }

  std::vector<std::string> texts_;
  std::chrono::milliseconds takes_;
  test::TemporaryFolder folder_;
  int master_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  std::string port_;
  std::atomic<int> polls_ = 0;
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

constexpr const char* plain = "pattern = \"{force}\"\nforce_unit = \"N\"\nrate = 50\n";
constexpr const char* timed =
    "pattern = \"{force} {time}\"\nforce_unit = \"N\"\ntime_unit = \"s\"\nrate = 50\n";

// One that answers at once is asked no more often than `rate` says; however slow this machine is,
// it takes longer, never less.
TEST(LineGauge, PollsKeepTheirRate) {
  const AnsweringGauge device({"1.5\n"});
  constexpr double rate = 50.0;
  constexpr int readings = 10;
  Clock clock(Clock::Kind::monotonic);
  LineGauge gauge(device.address(plain), clock);
  const double start = wire_time();
  for (int heard = 0; heard < readings && wire_time() < start + 20.0;)
    heard += gauge.sample(1.0).arrival == Arrival::fresh ? 1 : 0;
  // The first poll may be due at once.
  EXPECT_GE(wire_time() - start, (readings - 1) / rate);
  EXPECT_LE(device.polls(), 2 + static_cast<int>((wire_time() - start + 1.0 / rate) * rate));
}

// The link's opening takes the first answer.
TEST(LineGauge, IsLostWhereItsClockJumps) {
  const AnsweringGauge device({"1 0\n", "1 0.02\n", "1 99\n"});
  Clock clock(Clock::Kind::monotonic);
  LineGauge gauge(device.address(timed), clock);
  EXPECT_EQ(gauge.sample(1.0).arrival, Arrival::fresh);
  for (int i = 0; i < 2; ++i) {
    const Sample late = gauge.sample(1.0);
    EXPECT_EQ(late.arrival, Arrival::lost);
    EXPECT_EQ(late.fault, Fault::clock_jumped);
  }
}

TEST(LineGauge, TellsAReadingThatComesTwice) {
  const AnsweringGauge device({"1 0\n", "1 0.02\n", "2 0.02\n", "3 0.04\n"});
  Clock clock(Clock::Kind::monotonic);
  LineGauge gauge(device.address(timed), clock);
  EXPECT_EQ(gauge.sample(1.0).arrival, Arrival::fresh);
  EXPECT_EQ(gauge.sample(1.0).arrival, Arrival::duplicate);
  EXPECT_EQ(gauge.sample(1.0).arrival, Arrival::fresh);
}

// A line that does not match may be an echo of the request: the reply is behind it.
TEST(LineGauge, WaitsForTheReplyBehindAnEcho) {
  const AnsweringGauge device({"?\n1.5\n"});
  Clock clock(Clock::Kind::monotonic);
  LineGauge gauge(device.address(plain), clock);
  EXPECT_EQ(gauge.sample(1.0).arrival, Arrival::dropped);
  EXPECT_EQ(gauge.sample(1.0).force, 1.5);
  EXPECT_EQ(device.polls(), 2);
}

// What came behind a reply is not the beginning of the next.
TEST(LineGauge, ForgetsWhatCameBeforeItAsks) {
  const AnsweringGauge device({"1.5\n", "1.5\n9", "2.5\n"});
  Clock clock(Clock::Kind::monotonic);
  LineGauge gauge(device.address(plain), clock);
  EXPECT_EQ(gauge.sample(1.0).force, 1.5);
  EXPECT_EQ(gauge.sample(1.0).force, 2.5);
}

// At 1 kHz a reply may still take a quarter of a second, as by a radio or a slow gauge.
TEST(LineGauge, MayTakeLongerThanItsRate) {
  const AnsweringGauge device({"1.5\n"}, std::chrono::milliseconds(20));
  Clock clock(Clock::Kind::monotonic);
  LineGauge gauge(device.address("pattern = \"{force}\"\nforce_unit = \"N\"\nrate = 1000\n"),
                  clock);
  EXPECT_EQ(gauge.sample(1.0).arrival, Arrival::fresh);
  EXPECT_EQ(device.polls(), 2);
}

// The first line of a stream may be cut, so that two must come, however slow the gauge is.
// Here the second comes after `wait`, and long before the gauge's own time for it.
TEST(LineGauge, OfFewLinesIsWaitedFor) {
  const auto sending = [](const std::string& settings, int lines) {
    const test::TemporaryFolder folder;
    const int master = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (master < 0 || ::grantpt(master) != 0 || ::unlockpt(master) != 0)
      throw std::runtime_error("no pseudo-terminal");
    std::atomic<bool> over = false;
    std::thread device([&] {
      for (int i = 0; !over; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        if (i % 30 == 0 && i / 30 < lines && ::write(master, "1.5\n", 4) != 4) return;
      }
    });
    Clock clock(Clock::Kind::monotonic);
    const std::string said = test::refusal<LinkError>([&] {
      return LineGauge({::ptsname(master), folder.file("g.toml", settings)}, clock).identity();
    });
    over = true;
    device.join();
    ::close(master);
    return said;
  };
  const std::string line = "pattern = \"{force}\"\nforce_unit = \"N\"\nwait = \"1 s\"\n";
  const std::string said = sending(line + "rate = 50\n", 1);
  EXPECT_NE(said.find("one line comes within 1 s"), std::string::npos) << said;
  EXPECT_EQ(sending(line + "rate = 0.2\n", 2), "accepted") << "2.5 of its periods are 12.5 s";
}

}  // namespace
}  // namespace palpate::device
