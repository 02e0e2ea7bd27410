// Children: their answers, their ways to fail, and that they leave nothing behind.
#include "base/child_process.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>

#include "base/text.h"
#include "patience.h"

namespace palpate {
namespace {

constexpr ChildLimits limits{10.0, 1e9};

using End = ChildResult::End;

std::string answer(const std::function<std::string()>& work) {
  const ChildResult result = run_in_child(work, limits);
  EXPECT_EQ(result.end, End::exited);
  EXPECT_EQ(result.code, 0);
  return result.output;
}

void expect_code(const ChildResult& result, End end, int code) {
  EXPECT_EQ(result.end, end);
  EXPECT_EQ(result.code, code);
}

TEST(ChildProcess, brings_back_every_byte) {
  std::string long_text;  // many times a pipe's 64 KiB
  for (int i = 0; i < 3000000; ++i) long_text += static_cast<char>(i % 251);
  EXPECT_EQ(answer([&] { return long_text; }), long_text);
  EXPECT_EQ(answer([] { return ""; }), "");
}

TEST(ChildProcess, tells_exit_codes_and_exceptions) {
  const auto leave = []() -> std::string { _exit(5); };
  const auto fail = []() -> std::string { throw std::runtime_error("no"); };
  expect_code(run_in_child(leave, limits), End::exited, 5);
  expect_code(run_in_child(fail, limits), End::exited, 1);
}

TEST(ChildProcess, tells_signals) {
  const auto crash = []() -> std::string {
    std::raise(SIGSEGV);
    return "";
  };
  expect_code(run_in_child(crash, limits), End::killed, SIGSEGV);
}

TEST(ChildProcess, is_ended_at_its_time) {
  const auto wait = []() -> std::string {
    while (true) pause();
  };
  EXPECT_EQ(run_in_child(wait, {0.05, 1e9}).end, End::timed_out);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a child is left";
}

TEST(ChildProcess, memory_has_a_limit) {
  const auto hoard = [] { return std::string(2000000000, 'x'); };  // bytes
  expect_code(run_in_child(hoard, {10.0, 5e8}), End::exited, 1);
}

TEST(ChildProcess, neither_talks_nor_repeats_what_waits_in_a_buffer) {
  testing::internal::CaptureStdout();
  std::printf("once ");  // waits in the buffer that the child copies
  const auto talk = [] {
    std::printf("from the child");
    std::fflush(stdout);
    return std::string("answer");
  };
  EXPECT_EQ(answer(talk), "answer");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "once ");
}

TEST(Process, OutputAndCode) {
  const ChildResult result =
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
    const ChildResult result = run_process({.argv = {"sh", "-c", script}, .limit = 0.2});
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
  const ChildResult result =
      run_process({.argv = {"sh", "-c", "sleep 600 & echo $!; wait"}, .limit = 2.0});
  ASSERT_EQ(result.end, End::timed_out);
  const std::string child = trimmed(result.output);
  ASSERT_FALSE(child.empty());
  EXPECT_TRUE(test::seen([&] { return command_line(child).empty(); }));  // a signal takes a moment
}

TEST(Process, Signal) {
  const ChildResult result = run_process({.argv = {"sh", "-c", "kill -9 $$"}});
  EXPECT_EQ(result.end, End::killed);
  EXPECT_EQ(result.code, 9);
}

TEST(Process, MuchOutput) {
  const ChildResult result =
      run_process({.argv = {"sh", "-c", "head -c 1000000 /dev/zero"}});  // more than a pipe holds
  EXPECT_EQ(result.output.size(), 1000000U);
  const ChildResult endless = run_process({.argv = {"sh", "-c", "yes | head -c 100000000"}});
  EXPECT_EQ(endless.code, 0) << "all of it was read";
  EXPECT_EQ(endless.output.size(), 1U << 20);
}

}  // namespace
}  // namespace palpate
