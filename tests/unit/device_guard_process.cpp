// The process that stops the stand when the program cannot: killed, stopped or silent.
#include "device/stop_guard.h"

#include <gtest/gtest.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <functional>
#include <string>

#include "patience.h"

namespace palpate::device {
namespace {

using Heed = GuardProcess::Heed;

// A program with a guard, as a child, and the line that the guard writes to.
class Guarded {
 public:
  explicit Guarded(
      const std::function<void(GuardProcess&)>& live, Heed heed = Heed::silence,
      const std::function<void(GuardProcess&)>& first = [](GuardProcess&) {}) {
    std::array<int, 2> ids{};
    EXPECT_EQ(::pipe(line_.data()), 0);
    EXPECT_EQ(::pipe(ids.data()), 0);
    program_ = ::fork();
    if (program_ == 0) {
      {
        GuardProcess guard(line_[1], heed);
        first(guard);  // before the test begins
        const pid_t id = guard.id();
        (void)!::write(ids[1], &id, sizeof id);
        live(guard);
      }
      ::_exit(0);
    }
    EXPECT_EQ(::read(ids[0], &guard_, sizeof guard_), static_cast<ssize_t>(sizeof guard_));
    for (const int file : {ids[0], ids[1], line_[1]}) ::close(file);
  }
  ~Guarded() {
    for (const pid_t id : {program_, guard_}) ::kill(id, SIGKILL);
    ::waitpid(program_, nullptr, 0);
    ::close(line_[0]);
  }
  Guarded(const Guarded&) = delete;
  Guarded& operator=(const Guarded&) = delete;

  void send_program(int signal) const { ::kill(program_, signal); }
  void send_guard(int signal) const { ::kill(guard_, signal); }
  // The first bytes on the line; empty if it is closed without any.
  [[nodiscard]] std::string heard() const {
    std::array<char, 16> bytes{};
    pollfd ready{line_[0], POLLIN, 0};
    const int most = static_cast<int>(test::patience / std::chrono::milliseconds(1));
    EXPECT_GT(::poll(&ready, 1, most), 0) << "nothing was sent";
    const ssize_t size = ::read(line_[0], bytes.data(), bytes.size());
    return {bytes.data(), size > 0 ? static_cast<std::size_t>(size) : 0};
  }
  // All bytes until nobody holds the line.
  [[nodiscard]] std::string rest() const {
    std::string all;
    for (std::string more = heard(); !more.empty(); more = heard()) all += more;
    return all;
  }
  [[nodiscard]] int code() const {
    int status = 0;
    ::waitpid(program_, &status, WUNTRACED);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  std::array<int, 2> line_{};
  pid_t program_ = -1;
  pid_t guard_ = -1;
};

void begin_a_motion(GuardProcess& guard) { guard.watch(true); }

void wait_for_ever(GuardProcess& guard) {
  for (;;) {
    guard.beat();
    ::poll(nullptr, 0, 1);
  }
}

TEST(GuardOfTheStand, StopsItWhenTheProgramIsKilled) {
  const Guarded pair(wait_for_ever, Heed::silence, begin_a_motion);
  pair.send_program(SIGKILL);
  EXPECT_EQ(pair.heard().front(), 's');
  // Again and again, for the case that the stop was lost or went to the gauge.
  EXPECT_GT(pair.rest().size(), 5U);
}

TEST(GuardOfTheStand, StopsItWhenTheProgramStandsStill) {
  const Guarded pair(wait_for_ever, Heed::silence, begin_a_motion);
  pair.send_program(SIGSTOP);
  EXPECT_EQ(pair.heard().front(), 's');
  pair.send_program(SIGKILL);
}

TEST(GuardOfTheStand, StopsItWhenTheProgramIsSilentInAMotion) {
  const Guarded pair([](GuardProcess& guard) {
    guard.watch(true);
    for (;;) ::pause();
  });
  EXPECT_EQ(pair.heard().front(), 's');
}

TEST(GuardOfTheStand, IsNotEndedByTheSignalsOfATerminal) {
  const Guarded pair(wait_for_ever, Heed::silence, begin_a_motion);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGTSTP, SIGTTOU, SIGUSR1, SIGPIPE})
    pair.send_guard(signal);
  pair.send_program(SIGKILL);
  EXPECT_EQ(pair.heard().front(), 's');
}

TEST(GuardOfTheStand, SaysThatItActed) {
  const Guarded pair([](GuardProcess& guard) {
    if (guard.has_acted()) ::_exit(1);
    guard.watch(true);
    if (!test::seen([&] { return guard.has_acted(); })) ::_exit(2);
    if (!test::seen([&] { return guard.has_acted(); })) ::_exit(3);  // it stops the stand again
    guard.watch(false);
    // What it does at that moment is its last act.
    ::_exit(test::seen([&] { return !guard.has_acted(); }) ? 7 : 4);
  });
  EXPECT_EQ(pair.code(), 7);
}

// Without a motion silence is harmless, and with a virtual clock it means nothing.
TEST(GuardOfTheStand, SaysNothingWhenTheProgramEndsAsItShould) {
  const auto silent = [](GuardProcess& guard) {
    ::poll(nullptr, 0, 300);
    (void)guard.alive();
  };
  EXPECT_EQ(Guarded(silent).rest(), "");
  const auto lockstep = [](GuardProcess& guard) {
    guard.watch(true);
    ::poll(nullptr, 0, 300);
  };
  EXPECT_EQ(Guarded(lockstep, Heed::end_only).rest(), "");
}

TEST(GuardOfTheStand, IsMissedWhenItIsKilled) {
  const Guarded pair([](GuardProcess& guard) {
    if (!guard.alive()) ::_exit(1);
    ::kill(guard.id(), SIGKILL);
    ::_exit(test::seen([&] { return !guard.alive(); }) ? 7 : 2);
  });
  EXPECT_EQ(pair.code(), 7);
}

TEST(GuardOfTheStand, IsMissedWhenItIsStopped) {
  const Guarded pair([](GuardProcess& guard) {
    ::kill(guard.id(), SIGSTOP);
    ::_exit(test::seen([&] { return !guard.alive(); }) ? 7 : 2);
  });
  EXPECT_EQ(pair.code(), 7);
}

}  // namespace
}  // namespace palpate::device
