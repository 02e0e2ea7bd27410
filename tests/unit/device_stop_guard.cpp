// The stop reaches the wire on every way out of a program that a program can see.
#include "device/stop_guard.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include <array>
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

// What a child writes that leaves by `leave` with a guard in place, into wire[1].
Way left_by(const std::function<void(int)>& leave, const std::array<int, 2>& wire) {
  const pid_t child = ::fork();
  if (child == 0) {
    const rlimit no_core{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    ::close(2);  // sanitizers and asserts talk
    for (int signal = 1; signal < NSIG; ++signal) ::signal(signal, SIG_DFL);
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

Way left_by(const std::function<void(int)>& leave) {
  std::array<int, 2> wire{-1, -1};
  EXPECT_EQ(::pipe2(wire.data(), O_CLOEXEC), 0);
  return left_by(leave, wire);
}

// A serial line as the stand has one: a pseudo-terminal, whose far end we hold.
std::array<int, 2> raw_line() {
  const int far = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  EXPECT_EQ(::grantpt(far), 0);
  EXPECT_EQ(::unlockpt(far), 0);
  const int near = ::open(::ptsname(far), O_RDWR | O_NOCTTY | O_CLOEXEC);
  termios raw{};
  EXPECT_EQ(::tcgetattr(near, &raw), 0);
  ::cfmakeraw(&raw);
  EXPECT_EQ(::tcsetattr(near, TCSANOW, &raw), 0);
  return {far, near};
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

// All signals whose action is to end a process, but SIGKILL: signal(7).
INSTANTIATE_TEST_SUITE_P(Signals, StopBySignal,
                         testing::Values(SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGSEGV, SIGBUS, SIGFPE,
                                         SIGILL, SIGABRT, SIGTRAP, SIGPIPE, SIGUSR1, SIGUSR2,
                                         SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU, SIGXFSZ, SIGSYS,
                                         SIGPOLL, SIGPWR, SIGSTKFLT, 40));

class StopByPause : public testing::TestWithParam<int> {};

// The process stops after the stop was sent, and both happen again when it has continued.
TEST_P(StopByPause, IsSentEveryTime) {
  std::array<int, 2> wire{-1, -1};
  ASSERT_EQ(::pipe2(wire.data(), O_CLOEXEC), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    ::setpgid(0, 0);  // a group without a shell is not stopped by these signals
    ::signal(GetParam(), SIG_DFL);
    const StopGuard guard(wire[1], "s");
    for (int i = 0; i < 2; ++i) ::raise(GetParam());
    ::_exit(StopGuard::signals_passed() == 2 ? 7 : 8);
  }
  ::close(wire[1]);
  int status = 0;
  for (int i = 0; i < 2; ++i) {
    ASSERT_EQ(::waitpid(child, &status, WUNTRACED), child);
    EXPECT_TRUE(WIFSTOPPED(status));
    char byte = 0;
    EXPECT_EQ(::read(wire[0], &byte, 1), 1);
    EXPECT_EQ(byte, 's');
    ::kill(child, SIGCONT);
  }
  ::waitpid(child, &status, 0);
  ::close(wire[0]);
  EXPECT_EQ(WEXITSTATUS(status), 7);
}

INSTANTIATE_TEST_SUITE_P(Signals, StopByPause, testing::Values(SIGTSTP, SIGTTIN, SIGTTOU));

// Of its children the program may have others.
TEST(Stop, IsSentWhenTheWatchedChildEnds) {
  const auto ends = [](int wire, bool watched) {
    const pid_t child = ::fork();
    if (child == 0) {
      ::pause();
      ::_exit(0);
    }
    const StopGuard guard(wire, "s");
    StopGuard::watch_child(watched ? child : 1);
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    ::write(wire, "-", 1);
  };
  EXPECT_EQ(left_by([&](int wire) { ends(wire, true); }).wire, "s-s");
  EXPECT_EQ(left_by([&](int wire) { ends(wire, false); }).wire, "-s");
}

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

// Calls itself till the stack is used up; what it gives depends on every depth of it.
int descend(int depth) {
  volatile char frame[4096];
  for (char volatile& byte : frame) byte = static_cast<char>(depth);
  return depth == -1 ? 0 : descend(depth + 1) + frame[depth & 4095];
}

TEST(Stop, IsSentFromAStackThatIsUsedUp) {
  const Way way = left_by(
      [](int wire) {
        const rlimit small{1 << 20, 1 << 20};  // bytes, so that it is soon over
        ::setrlimit(RLIMIT_STACK, &small);
        const StopGuard guard(wire, "s");
        StopGuard::open_channel("\\");
        ::_exit(descend(0) == 0 ? 43 : 44);
      },
      raw_line());
  EXPECT_EQ(way.wire, "\\s");
  EXPECT_TRUE(WIFSIGNALED(way.status));
  EXPECT_EQ(WTERMSIG(way.status), SIGSEGV);
}

// A thread has one such stack: the guard takes away its own, and nobody else's.
TEST(Stop, LeavesTheHandlersStackAsItWas) {
  const auto used = [] {
    stack_t stack{};
    ::sigaltstack(nullptr, &stack);
    return stack;
  };
  const stack_t before = used();
  {
    const StopGuard guard(-1, "s");
    EXPECT_EQ(used().ss_flags & SS_DISABLE, 0);
  }
  EXPECT_EQ(used().ss_flags, before.ss_flags);
  static std::array<char, 65536> mine;
  stack_t stack{};
  stack.ss_sp = mine.data();
  stack.ss_size = mine.size();
  ::sigaltstack(&stack, nullptr);
  {
    const StopGuard guard(-1, "s");
    EXPECT_EQ(used().ss_sp, mine.data());
  }
  EXPECT_EQ(used().ss_sp, mine.data());
  ::sigaltstack(&before, nullptr);
}

// A device that takes nothing leaves the line full: what waits there gives way to the stop.
TEST(Stop, IsSentThroughAFullLine) {
  const auto [far, near] = raw_line();
  ::fcntl(near, F_SETFL, O_NONBLOCK);
  ::fcntl(far, F_SETFL, O_NONBLOCK);
  while (::write(near, "xxxxxxxx", 8) > 0 || ::write(near, "x", 1) > 0) {
  }
  { const StopGuard guard(near, "s"); }
  std::string all;
  char bytes[4096];
  for (ssize_t size = 0; (size = ::read(far, bytes, sizeof bytes)) > 0;)
    all.append(bytes, static_cast<std::size_t>(size));
  EXPECT_EQ(all.back(), 's') << all.size();
  ::close(near);
  ::close(far);
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
