// The arm's program on its sockets: handshake, one reply a message, ends as a client meets them.
#include <gtest/gtest.h>

#include "emulator_program.h"
#include "web_socket.h"

namespace emulator::test {
namespace {

using nlohmann::json;
using Socket = palpate::test::WebSocketClient;

std::string push(double z) {
  return R"({"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":{"vector":)" +
         json{{"x", 0.0}, {"y", 0.0}, {"z", z}}.dump() + "}}}]}";
}

// The force along z that a state message tells.
double told_force(const std::string& message) {
  return json::parse(message)["inverse3"][0]["state"]["current_cursor_force"]["z"];
}

json get(int port, const std::string& target, unsigned status) {
  const palpate::test::HttpAnswer answer = palpate::test::http_get(port, target);
  EXPECT_EQ(answer.status, status) << target;
  EXPECT_EQ(answer.type, "application/json");
  return json::parse(answer.body);
}

TEST(EmulatorService, GreetsAndAnswersEachMessageOnce) {
  Program program({"inverse3", "--clock", "virtual"});
  const json said = program.line();
  Socket socket(said["port"]);
  const json snapshot = json::parse(socket.hear());
  EXPECT_TRUE(snapshot["inverse3"][0].contains("config"));
  for (int i = 0; i < 100; ++i) {
    socket.say(push(1.0));
    EXPECT_EQ(told_force(socket.hear()), 1.0);
  }
  for (int i = 0; i < 3; ++i) socket.say(push(1.0));  // sent ahead
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(socket.hear().empty());
  // What comes next is the reply to this: nothing came unasked before it.
  socket.say(push(0.5));
  EXPECT_EQ(told_force(socket.hear()), 0.5);
  socket.close();
  Socket again(said["port"]);
  EXPECT_FALSE(again.hear().empty()) << "the next client is greeted too";
  program.send(SIGTERM);
  const json summary = program.line()["summary"];
  EXPECT_EQ(summary["messages"], 104);
  EXPECT_EQ(summary["time_s"], 0.104);
  EXPECT_EQ(summary["greatest_force_N"], 1.0);
  EXPECT_GT(summary["work_by_device_J"], 0.0);
  EXPECT_EQ(program.wait(), 0);
}

// docs.haply.co/inverseSDK/service/api/http, 3.5.x: GET /version, GET /devices.
TEST(EmulatorService, TellsVersionAndDevicesOverHttp) {
  Program newer({"inverse3"});
  const json said = newer.line();
  const json version = get(said["port"], "/version", 200);
  for (const char* key : {"build_time", "git_branch", "git_describe", "git_hash", "git_tag",
                          "project_name", "project_version"})
    EXPECT_TRUE(version[key].is_string()) << key;
  EXPECT_EQ(version["project_version"], "3.5.0.0");
  EXPECT_EQ(get(said["port"], "/devices", 200)["inverse3"][0]["device_id"], "049D");
  EXPECT_EQ(get(said["port"], "/nothing", 404)["ok"], false);
  Program older({"inverse3", "--service", "3.1"});
  EXPECT_EQ(get(older.line()["port"], "/3.1/version", 200)["git_tag"], "3.1.0");
}

TEST(EmulatorService, TheVirtualClockRepeatsItself) {
  const TemporaryFolder folder;
  const std::string hand = folder.file(
      "hand.toml",
      "[hand]\nmass = \"200 g\"\nstiffness = \"250 N/m\"\ndamping = \"5 N s/m\"\n"
      "start = [\"0 mm\", \"0 mm\", \"20 mm\"]\n[device]\nid = \"04BA\"\nforce_limit = \"4 N\"\n"
      "[[waypoint]]\nat = \"200 ms\"\nposition = [\"0 mm\", \"0 mm\", \"-10 mm\"]\n");
  std::array<std::string, 2> replies;
  std::array<std::string, 2> logs;
  for (std::size_t run = 0; run < 2; ++run) {
    const std::string log = folder / ("log" + std::to_string(run) + ".csv");
    Program program({"inverse3", "--clock", "virtual", "--hand", hand, "--log", log});
    Socket socket(program.line()["port"]);
    replies[run] += socket.hear();
    for (int i = 0; i < 300; ++i) {
      socket.say(R"({"inverse3":[{"device_id":"04BA","commands":{"probe_position":{}}}]})");
      replies[run] += socket.hear();
    }
    socket.close();
    EXPECT_EQ(program.end(), 0);
    logs[run] = read_file(log);
  }
  EXPECT_EQ(replies[0], replies[1]);
  EXPECT_EQ(logs[0], logs[1]);
  EXPECT_EQ(std::count(logs[0].begin(), logs[0].end(), '\n'), 1 + 300 + 1);  // and the end
  const std::size_t last = replies[0].rfind("\"cursor_position\"");
  EXPECT_NE(replies[0].find("\"z\":-0.0", last), std::string::npos) << "the hand went down";
}

std::string script(const TemporaryFolder& folder, const std::string& kind,
                   const std::string& more) {
  return folder.file(kind + ".toml",
                     "[[fault]]\nkind = \"" + kind + "\"\nafter_messages = 2\n" + more);
}

TEST(EmulatorService, ConnectionsEndAsTheScriptSays) {
  const TemporaryFolder folder;
  const struct {
    const char* kind;
    const char* end;
    int code;  // RFC 6455, section 7.4.1
  } rows[] = {
      {"rst", "reset", 0},
      {"reset", "reset", 0},
      {"close_1000", "closed", 1000},
      {"close_1011", "closed", 1011},
  };
  for (const auto& row : rows) {
    Program program({"inverse3", "--clock", "virtual", "--fault", script(folder, row.kind, "")});
    const json said = program.line();
    Socket socket(said["port"]);
    const int session = json::parse(socket.hear())["session_id"];
    for (int i = 0; i < 2; ++i) {
      socket.say(push(1.0));
      EXPECT_FALSE(socket.hear().empty()) << row.kind;
    }
    socket.say(push(1.0));
    EXPECT_EQ(socket.hear(), "") << row.kind;
    EXPECT_EQ(socket.end(), row.end) << row.kind;
    EXPECT_EQ(socket.close_code(), row.code) << row.kind;
    Socket again(said["port"]);
    const int next = json::parse(again.hear())["session_id"];
    EXPECT_EQ(next != session, std::string(row.kind) == "reset") << row.kind;
    again.say(push(1.0));
    EXPECT_FALSE(again.hear().empty()) << row.kind << ": it goes on after";
  }
}

TEST(EmulatorService, HalfOpenKeepsTheSocketAndSaysNothing) {
  const TemporaryFolder folder;
  Program program({"inverse3", "--fault", script(folder, "half_open", "duration = \"60 ms\"\n")});
  Socket socket(program.line()["port"]);
  EXPECT_FALSE(socket.hear().empty());
  for (int i = 0; i < 2; ++i) {
    socket.say(push(1.0));
    EXPECT_FALSE(socket.hear().empty());
  }
  const auto before = std::chrono::steady_clock::now();
  socket.say(push(1.0));
  socket.say(push(0.5));
  // The first of the two is never answered, the second when it reads on after its time.
  EXPECT_EQ(told_force(socket.hear()), 0.5);
  EXPECT_GE(std::chrono::steady_clock::now() - before, std::chrono::milliseconds(60));
}

TEST(EmulatorService, LateRepliesComeLaterAndInOrder) {
  const TemporaryFolder folder;
  Program program(
      {"inverse3", "--clock", "virtual", "--fault", script(folder, "late", "value = \"40 ms\"\n")});
  Socket socket(program.line()["port"]);
  EXPECT_FALSE(socket.hear().empty());
  for (int i = 0; i < 2; ++i) {
    socket.say(push(1.0));
    EXPECT_FALSE(socket.hear().empty());
  }
  const auto before = std::chrono::steady_clock::now();
  socket.say(push(0.25));
  socket.say(push(0.75));
  EXPECT_NE(socket.hear().find("\"z\":0.25"), std::string::npos);
  EXPECT_GE(std::chrono::steady_clock::now() - before, std::chrono::milliseconds(40));
  EXPECT_NE(socket.hear().find("\"z\":0.75"), std::string::npos);
}

TEST(EmulatorService, EventsComeOnTheirOwnPort) {
  const TemporaryFolder folder;
  Program program({"inverse3", "--clock", "virtual", "--fault", script(folder, "brake", "")});
  const json said = program.line();
  Socket events(said["events_port"]);
  Socket socket(said["port"]);
  EXPECT_FALSE(socket.hear().empty());
  for (int i = 0; i < 3; ++i) {
    socket.say(push(1.0));
    EXPECT_FALSE(socket.hear().empty());
  }
  EXPECT_EQ(json::parse(events.hear())["data"]["safety_type"], "ebrake_triggered");
}

TEST(EmulatorService, LetsGoInSilence) {
  const TemporaryFolder folder;
  const std::string hand = folder.file("hand.toml", "[device]\nidle_after = \"30 ms\"\n");
  Program program({"inverse3", "--hand", hand});
  const json said = program.line();
  Socket socket(said["port"]);
  EXPECT_FALSE(socket.hear().empty());
  socket.say(push(1.0));
  EXPECT_FALSE(socket.hear().empty());
  json state;  // over HTTP, which is no message of a session
  EXPECT_TRUE(seen([&] {
    state = get(said["port"], "/devices", 200)["inverse3"][0]["state"];
    return state["control_mode"] == "idle";
  }));
  EXPECT_EQ(state["current_cursor_force"]["z"], 0.0);
  // In all that time nothing came unasked: what comes next is the reply to this.
  socket.say(push(0.5));
  EXPECT_EQ(told_force(socket.hear()), 0.5);
}

TEST(EmulatorService, APortThatIsTakenIsRefused) {
  Program program({"inverse3"});
  const std::string port = std::to_string(program.line()["port"].get<int>());
  Program second({"inverse3", "--port", port});
  EXPECT_EQ(second.error_line(),
            "palpate-emulator: port " + port +
                ": it cannot be opened: Address already in use; write --port 0 for any free port");
  EXPECT_EQ(second.wait(), 2);
}

}  // namespace
}  // namespace emulator::test
