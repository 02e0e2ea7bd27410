// The stop reaches the wire on every way out of a program that a program can see.
#include "device/stop_guard.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <functional>
#include <stdexcept>
#include <string>

namespace palpate::device {
namespace {

struct Way {
  std::string wire;  // all bytes that were written
  int status = 0;    // as waitpid gives it
};

// What a child writes that leaves by `leave` with a guard in place.
Way left_by(const std::function<void(int)>& leave) {
  int wire[2] = {-1, -1};
  EXPECT_EQ(::pipe2(wire, O_CLOEXEC), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit no_core{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    ::close(2);  // sanitizers and asserts talk
    for (const int signal : {SIGSEGV, SIGABRT, SIGINT, SIGTERM, SIGHUP}) ::signal(signal, SIG_DFL);
    leave(wire[1]);
    ::_exit(42);
  }
  ::close(wire[1]);
  Way way;
  char bytes[64];
  for (ssize_t size = 0; (size = ::read(wire[0], bytes, sizeof bytes)) > 0;)
    way.wire.append(bytes, static_cast<std::size_t>(size));
  ::close(wire[0]);
  ::waitpid(child, &way.status, 0);
  return way;
}

TEST(Stop, IsSentAtTheEndOfItsScope) {
  const Way way = left_by([](int wire) { const StopGuard guard(wire, "s"); });
  EXPECT_EQ(way.wire, "s");
  EXPECT_EQ(WEXITSTATUS(way.status), 42);
}

TEST(Stop, IsSentByAnException) {
  const Way way = left_by([](int wire) {
    try {
      const StopGuard guard(wire, "s");
      throw std::runtime_error("");
    } catch (const std::exception&) {
    }
  });
  EXPECT_EQ(way.wire, "s");
}

TEST(Stop, IsSentByExit) {
  const Way way = left_by([](int wire) {
    const StopGuard guard(wire, "s");
    std::exit(3);
  });
  EXPECT_EQ(way.wire, "s");
  EXPECT_EQ(WEXITSTATUS(way.status), 3);
}

TEST(Stop, IsSentByAnExceptionThatNobodyCatches) {
  const Way way = left_by([](int wire) {
    const StopGuard guard(wire, "s");
    std::terminate();
  });
  EXPECT_EQ(way.wire, "s");
  EXPECT_EQ(WTERMSIG(way.status), SIGABRT);
}

class StopBySignal : public testing::TestWithParam<int> {};

TEST_P(StopBySignal, IsSentAndTheSignalGoesItsWay) {
  const int signal = GetParam();
  const Way way = left_by([signal](int wire) {
    const StopGuard guard(wire, "s");
    ::raise(signal);
  });
  EXPECT_EQ(way.wire, "s");
  EXPECT_TRUE(WIFSIGNALED(way.status));
  EXPECT_EQ(WTERMSIG(way.status), signal);
}

INSTANTIATE_TEST_SUITE_P(Signals, StopBySignal,
                         testing::Values(SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGSEGV, SIGBUS, SIGFPE,
                                         SIGILL, SIGABRT));

volatile std::sig_atomic_t heard = 0;

TEST(Stop, PassesASignalOnToWhoHadIt) {
  const Way way = left_by([](int wire) {
    ::signal(SIGTERM, [](int) { heard = 1; });
    {
      const StopGuard guard(wire, "s");
      ::raise(SIGTERM);
      if (heard != 1) ::_exit(1);
    }
    heard = 0;
    ::raise(SIGTERM);  // the guard is gone, its owner is not
    ::_exit(heard == 1 ? 7 : 2);
  });
  EXPECT_EQ(way.wire, "ss");
  EXPECT_EQ(WEXITSTATUS(way.status), 7);
}

TEST(Stop, LeavesAnIgnoredSignalIgnored) {
  const Way way = left_by([](int wire) {
    ::signal(SIGHUP, SIG_IGN);
    const StopGuard guard(wire, "s");
    ::raise(SIGHUP);
    ::write(wire, "-", 1);
  });
  EXPECT_EQ(way.wire, "-s");  // by the end of the scope alone
}

TEST(Stop, ClosesAnotherDevicesChannelFirst) {
  const Way way = left_by([](int wire) {
    const StopGuard guard(wire, "s");
    StopGuard::open_channel("\\");
    ::raise(SIGTERM);
  });
  EXPECT_EQ(way.wire, "\\s");
  const Way closed = left_by([](int wire) {
    const StopGuard guard(wire, "s");
    StopGuard::open_channel("\\");
    StopGuard::close_channel();
    ::raise(SIGTERM);
  });
  EXPECT_EQ(closed.wire, "s");
}

}  // namespace
}  // namespace palpate::device
