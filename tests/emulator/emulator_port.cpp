// The stand's program on its pseudo-terminal: the port, the line's rate, ends, refusals.
#include <gtest/gtest.h>

#include "emulator_program.h"

namespace emulator::test {
namespace {

TEST(EmulatorPort, SpeaksOnThePortItNames) {
  const TemporaryFolder folder;
  Program program({"mark10", "--clock", "virtual", "--link", folder / "stand"});
  const auto said = program.line();
  EXPECT_EQ(said["clock"], "virtual");
  EXPECT_EQ(said["tick_s"], 0.02);
  EXPECT_EQ(fs::read_symlink(folder / "stand").string(), said["port"]);
  {
    const Port port(folder / "stand");
    port.say("n");
    EXPECT_EQ(port.lines(2), "0.000 N\r\n0.00 mm\r\n");
  }
  const Port again(said["port"]);  // a client may come and go
  again.say("/LIST\r");
  EXPECT_EQ(again.lines(1), "V1.00;N;CUR;FLTC3;FLTP1;AOUT0;AOFF5;FULL;IPOL0;OPOL0;B0\r\n");
  program.send(SIGTERM);
  EXPECT_EQ(program.line()["summary"]["requests"], 2);
  EXPECT_EQ(program.wait(), 0);
  EXPECT_FALSE(fs::exists(fs::symlink_status(folder / "stand"))) << "the link goes with the port";
}

// The same bytes again and the same log, from two runs of the program.
TEST(EmulatorPort, TheVirtualClockRepeatsItself) {
  const TemporaryFolder folder;
  const std::string tissue = folder.file(
      "tissue.toml",
      "E0 = \"40 kPa\"\nEinf = \"15 kPa\"\ntau = \"300 ms\"\nR = \"5 mm\"\nsurface = \"-1 mm\"\n");
  std::array<std::string, 2> replies;
  std::array<std::string, 2> logs;
  for (std::size_t run = 0; run < 2; ++run) {
    const std::string log = folder / ("log" + std::to_string(run) + ".csv");
    Program program(
        {"mark10", "--clock", "virtual", "--tissue", tissue, "--log", log, "--seed", "9"});
    const Port port(program.line()["port"]);
    port.say("ilg-003.00e0300.0d");
    for (int i = 0; i < 50; ++i) {
      port.say("n");
      replies[run] += port.lines(2);
    }
    EXPECT_EQ(program.end(), 0);
    logs[run] = read_file(log);
  }
  EXPECT_EQ(replies[0], replies[1]);
  EXPECT_EQ(logs[0], logs[1]);
  EXPECT_NE(logs[0].find(",in,\"e0300.0\","), std::string::npos);
  EXPECT_NE(replies[0].find("-3.00 mm"), std::string::npos);
  EXPECT_EQ(logs[0].substr(0, logs[0].find('\n')),
            "time_s,kind,text,position_m,travel_m,velocity_m_s,depth_m,force_N");
}

TEST(EmulatorPort, PacesBytesAtTheLinesRate) {
  Program program({"mark10", "--baud", "9600"});
  const auto said = program.line();
  const Port port(said["port"], B9600);
  const auto before = std::chrono::steady_clock::now();
  port.say("/" + std::string(40, '\n') + "LIST\r");
  const std::string reply = port.lines(1);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - before;
  EXPECT_EQ(reply.size(), 57U);
  // Ten bits a byte, out after in; later is allowed, sooner is not.
  EXPECT_GE(took.count(), 0.98 * 10.0 * (46 + 57) / 9600.0);  // the last wake is 2 ms wide
}

TEST(EmulatorPort, AWrongRateIsNoise) {
  const TemporaryFolder folder;
  const std::string log = folder / "log.csv";
  Program program({"mark10", "--clock", "virtual", "--log", log});
  const auto said = program.line();
  const Port port(said["port"], B9600);
  port.say("nxn");
  ASSERT_TRUE(seen([&] {
    const std::string rows = read_file(log);
    return std::count(rows.begin(), rows.end(), '\n') >= 4 && rows.ends_with('\n');
  })) << "three bytes have arrived";
  // Nothing was understood: what comes next is the reply to this.
  port.set_rate(B115200);
  port.say("x");
  EXPECT_EQ(port.lines(1), "0.00 mm\r\n");
  EXPECT_EQ(program.end(), 0);
  const std::string rows = read_file(log);
  EXPECT_EQ(rows.find(",in,\"n\""), std::string::npos) << rows;
}

TEST(EmulatorPort, IsUnpluggedAndComesBack) {
  const TemporaryFolder folder;
  const std::string faults =
      folder.file("faults.toml",
                  "[[fault]]\nafter_messages = 1\nkind = \"unplug\"\nduration = \"20 ms\"\n"
                  "[[fault]]\nafter_messages = 2\nkind = \"unplug\"\n");
  Program program({"mark10", "--fault", faults, "--link", folder / "stand"});
  const auto said = program.line();
  {
    const Port port(said["port"]);
    port.say("x");
    EXPECT_EQ(port.lines(1), "0.00 mm\r\n");
    port.say("x");
    pollfd ready{port.descriptor(), POLLIN, 0};
    ASSERT_EQ(::poll(&ready, 1, static_cast<int>(patience / std::chrono::milliseconds(1))), 1);
    EXPECT_NE(ready.revents & POLLHUP, 0);
    EXPECT_LT(::write(port.descriptor(), "x", 1), 0);
  }
  const Port port(program.line()["port"]);  // said again
  EXPECT_TRUE(fs::exists(folder / "stand"));
  port.say("x");
  EXPECT_EQ(port.lines(1), "0.00 mm\r\n");
  port.say("x");
  EXPECT_EQ(program.line()["summary"]["requests"], 2);
  EXPECT_EQ(program.wait(), 0) << "unplugged for good, it ends";
}

TEST(EmulatorPort, RefusesInOneSentence) {
  const TemporaryFolder folder;
  const std::string bad = folder.file("bad.toml", "E0 = \"40 kPa\"\nsurfaces = \"1 mm\"\n");
  const std::string soft = folder.file("soft.toml", "E0 = \"1 kPa\"\nEinf = \"2 kPa\"\n");
  const std::string broken = folder.file("broken.toml", "E0 = \n");
  const std::string taken = folder.file("taken", "");
  const struct {
    std::vector<std::string> arguments;
    std::string message;
  } rows[] = {
      {{"mark10", "--tissue", bad},
       bad + ":2:1: `surfaces` is not a key here; did you mean `surface`?"},
      {{"mark10", "--tissue", soft},
       soft + ":1:6: `E0` is below `Einf`, and a modulus relaxes to less; give a larger `E0`"},
      {{"mark10", "--tissue", folder / "none.toml"},
       (folder / "none.toml").string() +
           ": cannot be read: No such file or directory; check the path"},
      {{"mark10", "--clock", "slow"},
       "--clock: there is no clock `slow`; write `real` or `virtual`"},
      {{"mark10", "--baud", "1234"}, "--baud: there is no rate of 1234; write 115200"},
      {{"mark10", "--link", taken},
       "--link: `" + taken + "` exists and is not a symbolic link; name another path"},
      {{"mark10", "--tick", "20"},
       "--tick: wants a time with its unit, got `20`; write it as `20 s`"},
      {{"mark10", "--tick", "0 s"}, "--tick: the time must be above 0 s; write `1 ms`"},
      {{"inverse3", "--service", "2.0"},
       "--service: there is no service `2.0`; write `3.1` or `3.5`"},
      {{"inverse3", "--port", "1", "--hand", bad},
       bad + ":1:1: `E0` is not a key here; known keys: device, hand, waypoint"},
  };
  for (const auto& row : rows) {
    Program program(row.arguments);
    EXPECT_EQ(program.error_line(), "palpate-emulator: " + row.message);
    EXPECT_EQ(program.wait(), 2) << row.message;
  }
  Program program({"mark10", "--tissue", broken});
  EXPECT_EQ(program.error_line().find("palpate-emulator: " + broken + ":1:"), 0U);
  EXPECT_EQ(program.wait(), 2);
  Program nothing({});
  EXPECT_EQ(nothing.wait(), 2);
}

}  // namespace
}  // namespace emulator::test
