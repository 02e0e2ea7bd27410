// A forked child: its answer, its ways to fail, and that it leaves nothing behind.
#include "meshing/child_process.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <stdexcept>

namespace palpate::meshing {
namespace {

constexpr ChildLimits limits{10.0, 1e9};

template <typename Kind>
Kind expect(const ChildResult& result) {
  EXPECT_TRUE(std::holds_alternative<Kind>(result)) << "alternative " << result.index();
  return std::holds_alternative<Kind>(result) ? std::get<Kind>(result) : Kind{};
}

TEST(ChildProcess, brings_back_every_byte) {
  std::string long_text;  // many times a pipe's 64 KiB
  for (int i = 0; i < 3000000; ++i) long_text += static_cast<char>(i % 251);
  EXPECT_EQ(expect<ChildAnswer>(run_in_child([&] { return long_text; }, limits)).bytes, long_text);
  EXPECT_EQ(expect<ChildAnswer>(run_in_child([] { return ""; }, limits)).bytes, "");
}

TEST(ChildProcess, tells_exit_codes_and_exceptions) {
  const auto leave = []() -> std::string { _exit(5); };
  const auto fail = []() -> std::string { throw std::runtime_error("no"); };
  EXPECT_EQ(expect<ChildExit>(run_in_child(leave, limits)).code, 5);
  EXPECT_EQ(expect<ChildExit>(run_in_child(fail, limits)).code, 1);
}

TEST(ChildProcess, tells_signals) {
  const auto crash = []() -> std::string {
    std::raise(SIGSEGV);
    return "";
  };
  EXPECT_EQ(expect<ChildSignal>(run_in_child(crash, limits)).number, SIGSEGV);
}

TEST(ChildProcess, is_ended_at_its_time) {
  const auto wait = []() -> std::string {
    while (true) pause();
  };
  expect<ChildTimeout>(run_in_child(wait, {0.05, 1e9}));
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a child is left";
}

TEST(ChildProcess, memory_has_a_limit) {
  const auto hoard = [] { return std::string(2000000000, 'x'); };  // bytes
  expect<ChildExit>(run_in_child(hoard, {10.0, 5e8}));
}

TEST(ChildProcess, neither_talks_nor_repeats_what_waits_in_a_buffer) {
  testing::internal::CaptureStdout();
  std::printf("once ");  // waits in the buffer that the child copies
  const auto talk = [] {
    std::printf("from the child");
    std::fflush(stdout);
    return std::string("answer");
  };
  EXPECT_EQ(expect<ChildAnswer>(run_in_child(talk, limits)).bytes, "answer");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "once ");
}

}  // namespace
}  // namespace palpate::meshing
