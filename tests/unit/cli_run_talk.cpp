// Who hears what: stdout for data, stderr for talk, nothing that a terminal alone understands.
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "program.h"

namespace palpate::test {
namespace {

const std::string sweep_given =
    "[solver]\nmodel = \"hertz\"\n[[step]]\nkind = \"indent\"\n"
    "[output]\ninterval = \"100 ms\"\nfigures = false\n"
    "[sweep]\n\"tissue.material\" = [\"skin\", \"bone\"]\n";

class RunTalk : public testing::Test {
 protected:
  RunTalk() { write_file(folder_ / "press.toml", sweep_given); }
  Ended run(const std::vector<std::string>& more) {
    return palpate(folder_.path(), {"run", "press.toml", "--jobs", "1"}, more);
  }
  TemporaryFolder folder_;
};

TEST_F(RunTalk, stdout_is_empty_and_stderr_plain) {
  const Ended ended = run({});
  EXPECT_EQ(ended.code, 0);
  EXPECT_EQ(ended.out, "");
  EXPECT_NE(ended.err.find("out/press: 2 of 2 cases\n"), std::string::npos) << ended.err;
  EXPECT_EQ(ended.err.find('\033'), std::string::npos) << "no colour, no progress";
  EXPECT_EQ(ended.err.find('\r'), std::string::npos) << "no progress";
}

TEST_F(RunTalk, what_all_cases_share_is_said_once) {
  write_file(folder_ / "press.toml",
             "[solver]\nmodel = \"hertz\"\n[[step]]\nkind = \"indent\"\n"
             "[output]\ninterval = \"100 ms\"\nfigures = false\n[sweep]\n"
             "\"tissue.young_modulus\" = [\"10 kPa\", \"20 kPa\", \"30 kPa\"]\n");
  const std::string said = run({}).err;
  const std::string warning = "\nNeglected in `10 kPa`, and so in 2 more cases: ";
  EXPECT_NE(said.find(warning), std::string::npos) << said;
  EXPECT_EQ(said.find("\nNeglected"), said.rfind("\nNeglected")) << said;
}

// The exit code of the program, and what it wrote to a terminal as stderr. It gets SIGTERM as soon
// as it has written `until`.
struct Seen {
  int code = 0;
  std::string seen = {};
};
Seen on_terminal(const std::vector<std::string>& arguments, const fs::path& folder,
                 const std::string& until = "never") {
  const int terminal = ::posix_openpt(O_RDWR | O_NOCTTY);
  EXPECT_GE(terminal, 0);
  EXPECT_EQ(::grantpt(terminal), 0);
  EXPECT_EQ(::unlockpt(terminal), 0);
  const std::string name = ::ptsname(terminal);
  Running running({.arguments = arguments, .folder = folder, .before = [&] {
                     ::setenv("TERM", "xterm", 1);
                     ::unsetenv("NO_COLOR");
                     ::dup2(::open(name.c_str(), O_RDWR | O_NOCTTY), 2);
                   }});
  Seen all;
  std::array<char, 4096> part{};
  // It reads nothing once the program has closed the other side.
  for (ssize_t got = 0; (got = ::read(terminal, part.data(), part.size())) > 0;) {
    all.seen.append(part.data(), static_cast<std::size_t>(got));
    if (all.seen.find(until) != std::string::npos) running.send(SIGTERM);  // many times
  }
  ::close(terminal);
  all.code = running.wait().code;
  return all;
}

// On a terminal a press of seconds says which mesh it is at, and how deep.
TEST_F(RunTalk, a_long_press_says_where_it_is) {
  write_file(folder_ / "press.toml",
             "[solver]\nmodel = \"solid\"\ntolerance = 0.005\n[tissue]\nviscosity = "
             "\"none\"\n[finger]\nmaterial = "
             "\"rigid\"\nx = \"25 mm\"\ny = \"27 mm\"\n[[step]]\nkind = \"indent\"\nto = \"1 "
             "mm\"\n[output]\nfigures = false\n");
  const auto [code, seen] = on_terminal({"run", "press.toml"}, folder_.path(), " nodes, press to ");
  EXPECT_EQ(code, 130);
  EXPECT_NE(seen.find("/100, "), std::string::npos) << seen;  // of all meshes
  EXPECT_NE(seen.find(" nodes, press to "), std::string::npos) << seen;
}

// A table of one's own without a time constant runs as elastic.
TEST_F(RunTalk, an_elastic_tissue_is_said_not_to_relax_in_a_hold) {
  write_file(folder_ / "mine.toml",
             "[gel]\ndensity = \"1000 kg/m^3\"\nyoung_modulus = \"5 kPa\"\npoisson_ratio = 0.45\n");
  const auto said = [&](const std::string& material, const std::string& then) {
    write_file(folder_ / "press.toml", "[tissue]\nmaterial = \"" + material +
                                           "\"\n[[step]]\nkind = \"indent\"\n[[step]]\nkind = \"" +
                                           then +
                                           "\n[output]\ninterval = \"100 ms\"\nfigures = false\n");
    return run({"--force"}).err.find("nothing relaxes or creeps during `hold`") !=
           std::string::npos;
  };
  EXPECT_TRUE(said("mine.toml#gel", "hold\"\ntime = \"1 s\""));
  EXPECT_FALSE(said("muscle", "hold\"\ntime = \"1 s\""));
  EXPECT_FALSE(said("mine.toml#gel", "retract\""));
}

// A person is told the next step of the path, and sees errors in red; a file and `--no-color` see
// neither.
TEST_F(RunTalk, a_terminal_gets_the_next_step_and_colours) {
  write_file(folder_ / "my press.toml", read_file(folder_ / "press.toml"));
  const auto ended = on_terminal({"run", "my press.toml"}, folder_.path());
  EXPECT_EQ(ended.code, 0);
  EXPECT_NE(ended.seen.find("\nnext: palpate open 'out/my press'"), std::string::npos)
      << ended.seen;
  EXPECT_EQ(run({"--force"}).err.find("next: "), std::string::npos);
  ASSERT_EQ(palpate(folder_.path(), {"sweep", "plan", "press.toml"}).code, 0);
  const auto planned = on_terminal({"sweep", "status", "out/press_sweep"}, folder_.path());
  EXPECT_NE(planned.seen.find("next: palpate sweep run out/press_sweep"), std::string::npos)
      << planned.seen;
  ASSERT_EQ(palpate(folder_.path(), {"sweep", "run", "out/press_sweep"}).code, 0);
  const auto done = on_terminal({"sweep", "status", "out/press_sweep"}, folder_.path());
  EXPECT_NE(done.seen.find("next: palpate sweep merge out/press_sweep"), std::string::npos)
      << done.seen;
  const auto red = on_terminal({"run", "none.toml"}, folder_.path());
  EXPECT_TRUE(red.seen.starts_with("\x1b[31mnone.toml")) << red.seen;
  const auto plain = on_terminal({"--no-color", "run", "none.toml"}, folder_.path());
  EXPECT_TRUE(plain.seen.starts_with("none.toml")) << plain.seen;
}

TEST_F(RunTalk, quiet_is_silent) {
  const Ended ended = run({"--quiet"});
  EXPECT_EQ(ended.code, 0);
  EXPECT_EQ(ended.out, "");
  EXPECT_EQ(ended.err, "");
}

TEST_F(RunTalk, quiet_still_tells_errors) {
  ASSERT_EQ(run({"--quiet"}).code, 0);
  const Ended again = run({"--quiet", "--set", "finger.radius=8 mm"});
  EXPECT_EQ(again.code, 2);
  EXPECT_NE(again.err.find("holds a finished result of other inputs"), std::string::npos);
}

TEST_F(RunTalk, json_is_one_object_a_line) {
  const Ended ended = run({"--json"});
  EXPECT_EQ(ended.code, 0);
  ASSERT_FALSE(ended.out.empty());
  EXPECT_EQ(ended.out.back(), '\n');
  std::vector<std::string> events;
  for (const std::string& line : split(trimmed(ended.out), '\n')) {
    const auto object = nlohmann::json::parse(line, nullptr, false);
    ASSERT_TRUE(object.is_object()) << line;
    events.push_back(object["event"]);
    EXPECT_EQ(object["scenario"], "press");
  }
  EXPECT_EQ(events, (std::vector<std::string>{"case", "case", "result"}));
  const auto last = nlohmann::json::parse(split(trimmed(ended.out), '\n').back());
  EXPECT_TRUE(fs::exists(folder_.path() / std::string(last["folder"]) / "run.json"));
}

TEST_F(RunTalk, json_keeps_stdout_clean_on_errors) {
  ASSERT_EQ(run({"--quiet"}).code, 0);
  const Ended again =
      run({"--json", "--set", "finger.radius=9 mm"});  // another result stands there
  EXPECT_EQ(again.code, 2);
  EXPECT_EQ(again.out, "");
}

}  // namespace
}  // namespace palpate::test
