// Programs that end well, badly, late, or are not there.
#include "plot/process.h"

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <string>

#include "base/text.h"
#include "patience.h"

namespace palpate::plot {
namespace {

using End = ProcessResult::End;

TEST(Process, OutputAndCode) {
  const ProcessResult result =
      run_process({.argv = {"sh", "-c", "pwd; cat; echo oops >&2; exit 3"}, .folder = "/"});
  EXPECT_EQ(result.end, End::exited);
  EXPECT_EQ(result.code, 3);
  EXPECT_EQ(result.output, "/\noops\n");
}

TEST(Process, MissingProgram) {
  EXPECT_EQ(run_process({.argv = {"palpate-no-such-program"}}).end, End::not_found);
}

TEST(Process, TimeLimit) {
  const auto start = std::chrono::steady_clock::now();
  for (const char* script : {"sleep 600", "exec >&- 2>&-; sleep 600"}) {
    const ProcessResult result = run_process({.argv = {"sh", "-c", script}, .limit = 0.2});
    EXPECT_EQ(result.end, End::timed_out) << script;
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count(), 300.0);  // twice 0.2 s, on a busy machine
}

// What a process runs; empty once it has ended, whether or not somebody has collected it.
std::string command_line(const std::string& process) {
  std::ifstream stream("/proc/" + process + "/cmdline");
  std::string text;
  std::getline(stream, text);
  return text;
}

TEST(Process, TimeLimitTakesTheChildrenToo) {
  const ProcessResult result =
      run_process({.argv = {"sh", "-c", "sleep 600 & echo $!; wait"}, .limit = 2.0});
  ASSERT_EQ(result.end, End::timed_out);
  const std::string child = trimmed(result.output);
  ASSERT_FALSE(child.empty());
  EXPECT_TRUE(test::seen([&] { return command_line(child).empty(); }));  // a signal takes a moment
}

TEST(Process, Signal) {
  const ProcessResult result = run_process({.argv = {"sh", "-c", "kill -9 $$"}});
  EXPECT_EQ(result.end, End::killed);
  EXPECT_EQ(result.code, 9);
}

TEST(Process, MuchOutput) {
  const ProcessResult result =
      run_process({.argv = {"sh", "-c", "head -c 1000000 /dev/zero"}});  // more than a pipe holds
  EXPECT_EQ(result.output.size(), 1000000U);
  const ProcessResult endless = run_process({.argv = {"sh", "-c", "yes | head -c 100000000"}});
  EXPECT_EQ(endless.code, 0) << "all of it was read";
  EXPECT_EQ(endless.output.size(), 1U << 20);
}

}  // namespace
}  // namespace palpate::plot
