// A live run's rows are on the disk while it goes on: killed or out of room, it loses none of what
// was written, and the loop goes on.
#include <gtest/gtest.h>

#include "live/loop.h"
#include "live_session.h"

namespace palpate {
namespace {

namespace fs = test::fs;
using test::has;

// Runs of the arm in a folder of their own, in lock-step with the emulator, so that a busy machine
// loses no link; at some thousand frames a second, and with a hold that outlasts every test.
class LiveRows : public testing::Test {
 protected:
  [[nodiscard]] static std::vector<std::string> arm(const std::string& port,
                                                    const std::vector<std::string>& more) {
    std::vector<std::string> words{"run",
                                   test::project_file("scenarios/device_arm.toml"),
                                   "--set",
                                   "output.figures=false",
                                   "--set",
                                   "step.2.time=50 s",
                                   "--arm",
                                   "--clock",
                                   "virtual",
                                   "--device",
                                   "inverse3:127.0.0.1:" + port,
                                   "--surface",
                                   "130 mm"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  [[nodiscard]] std::vector<std::string> emulated_arm() const {
    return {"inverse3",
            "--clock",
            "virtual",
            "--log",
            (folder_ / "log.csv").string(),
            "--hand",
            test::project_file("scenarios/emulator/arm_hand.toml")};
  }
  [[nodiscard]] fs::path partial(const test::Running& running) const {
    return folder_ / ("out/device_arm.partial-" + std::to_string(running.id()));
  }
  static std::uintmax_t size_of(const fs::path& path) {
    std::error_code missing;
    const auto size = fs::file_size(path, missing);
    return missing ? 0 : size;
  }
  // Forces that the emulated arm was sent.
  [[nodiscard]] std::size_t frames_on_the_wire() const {
    const test::Rows log(record::read_csv((folder_ / "log.csv").string()));
    std::size_t frames = 0;
    for (std::size_t i = 0; i < log.size(); ++i)
      if (log.word(i, "kind") == "in" &&
          log.word(i, "text").find("set_cursor_force") != std::string::npos)
        ++frames;
    return frames;
  }

  static constexpr std::size_t lead = live::LiveLog::lead;
  test::TemporaryFolder folder_;
};

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t times = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
    ++times;
  return times;
}

// Writes of a program end at `bytes` of a file, as on a full disk, for root too, until somebody
// makes room. What it says goes to `said`.
std::function<void()> full_disk(const std::string& said, rlim_t bytes) {
  test::write_file(said, "");
  return [said, bytes] {
    ::dup2(::open(said.c_str(), O_WRONLY), 2);
    rlimit limit{};
    ::getrlimit(RLIMIT_FSIZE, &limit);
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
  };
}

void make_room(const test::Running& running) {
  rlimit limit{};
  ::prlimit(running.id(), RLIMIT_FSIZE, nullptr, &limit);
  limit.rlim_cur = limit.rlim_max;
  ASSERT_EQ(::prlimit(running.id(), RLIMIT_FSIZE, &limit, nullptr), 0);
}

TEST_F(LiveRows, AKilledRunLeavesItsRowsAndTraffic) {
  fs::path left;
  {
    test::LiveEmulator emulator(emulated_arm());
    test::Running running(
        {.arguments = arm(emulator.port(), {"--traffic"}), .folder = folder_.path()});
    left = partial(running);
    // Some 400 rows and more.
    ASSERT_TRUE(running.until([&] {
      return size_of(left / "force_indentation.csv") > 60000 &&
             size_of(left / "traffic.csv") > 60000;
    }));
    running.send(SIGKILL);
    EXPECT_EQ(running.wait().signal, SIGKILL);
    (void)emulator.end();
  }
  EXPECT_EQ(test::names_in(left),
            (std::set<std::string>{"contents.sha256", "force_indentation.csv", "traffic.csv"}));
  const test::Rows rows(record::read_csv((left / "force_indentation.csv").string()));
  EXPECT_GT(rows.size(), 200U);
  EXPECT_EQ(rows.word(0, "case"), "device_arm");
  // In lock-step the loop waits for the disk; a frame has one row, and a force before the first.
  const std::size_t frames = frames_on_the_wire();
  EXPECT_GE(rows.size() + lead + 1, frames);
  for (std::size_t i = 1; i < rows.size(); ++i)
    EXPECT_GT(rows.number(i, "time_s"), rows.number(i - 1, "time_s"));
  const std::string traffic = test::read_file(left / "traffic.csv");
  EXPECT_TRUE(traffic.starts_with("time_s,way,bytes\n0,")) << traffic.substr(0, 200);
  EXPECT_GE(count(traffic, "set_cursor_force") + lead + 1, frames);

  // The next run says where they are, leaves them alone, and can play them.
  const std::string before = test::read_file(left / "force_indentation.csv");
  const test::Ended again = test::palpate(
      folder_.path(),
      {"run", test::project_file("scenarios/device_arm.toml"), "--set", "output.figures=false",
       "--device", "replay:" + (left / "force_indentation.csv").string(), "--force"});
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_TRUE(has(again.err, "note: out/" + left.filename().string() + "/force_indentation.csv"))
      << again.err;
  EXPECT_EQ(test::read_file(left / "force_indentation.csv"), before);
  EXPECT_EQ(test::names_in(folder_ / "out"),
            (std::set<std::string>{"device_arm", left.filename().string()}));
  const test::Rows played(
      record::read_csv((folder_ / "out/device_arm/force_indentation.csv").string()));
  EXPECT_EQ(played.size(), rows.size());
}

// A full disk in the middle: told once, and once there is room everything is there.
TEST_F(LiveRows, ADiskThatIsFullForAWhileCostsNothing) {
  const std::string said = (folder_ / "said").string();
  const std::string sentence =
      "warning: force_indentation.csv cannot be written: File too large; until the run ends its "
      "rows are in memory";
  test::LiveEmulator emulator(emulated_arm());
  test::Running running({.arguments = arm(emulator.port(), {}),
                         .folder = folder_.path(),
                         .before = full_disk(said, 8192)});
  ASSERT_TRUE(running.until([&] { return has(test::read_file(said), sentence); }));
  EXPECT_LE(size_of(partial(running) / "force_indentation.csv"), 8192U);
  make_room(running);
  running.send(SIGINT);
  EXPECT_EQ(running.wait().code, 130);
  (void)emulator.end();
  EXPECT_EQ(count(test::read_file(said), sentence), 1U);
  EXPECT_EQ(test::names_in(folder_ / "out"), std::set<std::string>{"device_arm"});
  const fs::path result = folder_ / "out/device_arm";
  EXPECT_FALSE(fs::exists(result / "case_001"));
  const auto health = nlohmann::json::parse(test::read_file(result / "device_health.json"));
  EXPECT_TRUE(has(health.at("notes").dump(), sentence.substr(9)));
  // Every frame has its row.
  const test::Rows rows(record::read_csv((result / "force_indentation.csv").string()));
  EXPECT_EQ(rows.size(), health.at("frames").get<std::size_t>());
  EXPECT_GT(rows.size(), 50U);
}

// A disk that stays full: the loop goes on to its end all the same, then the program says what it
// could not write and where the rest is.
TEST_F(LiveRows, ADiskThatStaysFullStopsNoLoop) {
  const std::string said = (folder_ / "said").string();
  test::LiveEmulator emulator(emulated_arm());
  test::Running running({.arguments = arm(emulator.port(), {"--seconds", "2", "--traffic"}),
                         .folder = folder_.path(),
                         .before = full_disk(said, 131072)});
  const fs::path left = partial(running);
  EXPECT_EQ(running.wait().code, 1);
  (void)emulator.end();
  const std::string err = test::read_file(said);
  EXPECT_TRUE(has(err, "cannot be written: File too large; the rows written before are in out/" +
                           left.filename().string() + "/force_indentation.csv"))
      << err;
  EXPECT_EQ(count(err, "traffic.csv cannot be written"), 1U) << err;
  EXPECT_GE(frames_on_the_wire(), 2000U) << "2 s of 1 ms";
  const std::string kept = test::read_file(left / "force_indentation.csv");
  // What it took, in whole lines: 2000 rows would be 300 kB.
  EXPECT_LE(kept.size(), 131072U);
  EXPECT_GT(record::parse_csv(kept, "kept").rows.size(), 100U);
  EXPECT_EQ(kept.back(), '\n');
  EXPECT_FALSE(fs::exists(folder_ / "out/device_arm"));
}

// Nor does a full disk hide that a device must be looked after.
TEST_F(LiveRows, AFullDiskHidesNoLostLink) {
  const test::ScratchFile fault("[[fault]]\nkind = \"rst\"\nat = \"1.3 s\"\n");
  const std::string said = (folder_ / "said").string();
  std::vector<std::string> words = emulated_arm();
  words.insert(words.end(), {"--fault", fault.path()});
  test::LiveEmulator emulator(words);
  test::Running running({.arguments = arm(emulator.port(), {}),
                         .folder = folder_.path(),
                         .before = full_disk(said, 8192)});
  EXPECT_EQ(running.wait().code, 1);
  const std::string err = test::read_file(said);
  EXPECT_TRUE(has(err, "the link is lost")) << err;
  EXPECT_TRUE(has(err, "/case_001/force_indentation.csv cannot be written")) << err;
}

// Numbers of processes come again: what a killed one left is no part of the next one's result.
TEST_F(LiveRows, AFolderThatWasLeftUnderTheSameNumberStays) {
  test::write_file(folder_ / "rows.csv", "time_s,travel_mm\n0,0\n0.1,0.2\n0.2,0\n");
  fs::path left;
  test::Running running(
      {.arguments = {"run", test::project_file("scenarios/device_arm.toml"), "--set",
                     "output.figures=false", "--device", "replay:rows.csv"},
       .folder = folder_.path(),
       .before = [&] {
         const std::string own = "out/device_arm.partial-" + std::to_string(::getpid());
         test::write_file(own + "/force_indentation.csv", "of another\n");
       }});
  left = partial(running);
  const test::Ended ended = running.wait();
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_EQ(test::read_file(left / "force_indentation.csv"), "of another\n");
  EXPECT_TRUE(fs::exists(folder_ / "out/device_arm/run.json"));
}

// More rows than the log holds at a time, as fast as they can be computed: all of them are played.
TEST_F(LiveRows, ALongRecordingIsPlayedToItsLastRow) {
  std::string text = "time_s,travel_mm\n";
  constexpr int rows = 100000;
  for (int i = 0; i < rows; ++i) text += std::to_string(1e-3 * i) + ",-1\n";
  test::write_file(folder_ / "rows.csv", text);
  const test::Ended ended =
      test::palpate(folder_.path(), {"run", test::project_file("scenarios/device_arm.toml"),
                                     "--set", "output.figures=false", "--set", "output.fits=false",
                                     "--device", "replay:rows.csv"});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_FALSE(has(ended.err, "missing")) << ended.err;
  const std::string all = test::read_file(folder_ / "out/device_arm/force_indentation.csv");
  EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), rows + 1);
}

}  // namespace
}  // namespace palpate
