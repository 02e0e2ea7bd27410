// The loop of the stand: bytes that arrive, the passage of time, and replies at the line's rate.
#include "emulator/mark10_link.h"

#include <poll.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <deque>
#include <memory>
#include <thread>

#include "emulator/pty.h"

namespace emulator {
namespace {

constexpr Nanoseconds wake = 2'000'000;          // ns, longest wait, for faults and output by time
constexpr Nanoseconds state_every = 20'000'000;  // ns, between rows of the log with the state

Nanoseconds monotonic() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

int signals() {
  sigset_t set;
  ::sigemptyset(&set);
  ::sigaddset(&set, SIGINT);
  ::sigaddset(&set, SIGTERM);
  ::sigprocmask(SIG_BLOCK, &set, nullptr);
  return ::signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC);
}

// One direction of the line, on which bytes follow each other.
struct Line {
  Nanoseconds free_at = 0;
  Nanoseconds add(Nanoseconds earliest, Nanoseconds duration) {
    return free_at = std::max(free_at, earliest) + duration;
  }
};

struct DueByte {
  Nanoseconds at;
  char byte;
};

class Loop {
 public:
  explicit Loop(const Mark10Run& run)
      : run_(run),
        log_(run.log, "position_m,travel_m,velocity_m_s,depth_m,force_N"),
        mark10_(run.settings, log_),
        pty_(std::make_unique<Pty>(run.settings.baud, run.link)),
        signals_(signals()) {
    say_port();
  }
  ~Loop() { ::close(signals_); }
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  int go() {
    while (!ended_) turn();
    mark10_.log_state();
    const Stand& stand = mark10_.stand();
    std::printf(
        "{\"summary\":{\"requests\":%lld,\"position_m\":%.9g,\"deepest_m\":%.9g,"
        "\"greatest_force_N\":%.9g,\"moving\":%s}}\n",
        static_cast<long long>(mark10_.requests()), stand.crosshead.position, stand.deepest,
        stand.greatest_force, moves(stand.crosshead) ? "true" : "false");
    std::fflush(stdout);
    return 0;
  }

 private:
  [[nodiscard]] bool lockstep() const { return run_.settings.clock == Clock::lockstep; }

  void say_port() const {
    std::printf("{\"port\":\"%s\",\"clock\":\"%s\",\"tick_s\":%.9g,\"baud\":%d,\"pid\":%d}\n",
                pty_->path().c_str(), lockstep() ? "virtual" : "real", seconds(run_.settings.tick),
                run_.settings.baud, static_cast<int>(::getpid()));
    std::fflush(stdout);
  }

  void turn() {
    wait();
    const Nanoseconds now = monotonic() - start_;
    if (run_.lifetime && now > nanoseconds(*run_.lifetime)) ended_ = true;
    mark10_.pass(now);
    if (pty_) read(now);
    if (mark10_.unplugged()) unplug(now);
    queue(now);
    write_due(now);
    if (!lockstep() && now >= next_state_) {
      mark10_.log_state();
      next_state_ = now + state_every;
    }
  }

  void wait() {
    Nanoseconds longest = wake;
    if (!due_.empty())
      longest = std::clamp<Nanoseconds>(due_.front().at - (monotonic() - start_), 0, wake);
    const timespec timeout{.tv_sec = 0, .tv_nsec = longest};
    std::array<pollfd, 2> ready{pollfd{signals_, POLLIN, 0},
                                pollfd{pty_ ? pty_->descriptor() : -1, POLLIN, 0}};
    ::ppoll(ready.data(), ready.size(), &timeout, nullptr);
    signalfd_siginfo signal{};
    if (::read(signals_, &signal, sizeof signal) > 0) ended_ = true;
  }

  void read(Nanoseconds now) {
    const std::string bytes = pty_->read_all();
    if (bytes.empty()) return;
    const auto rate = pty_->same_rate() ? Mark10::Rate::same : Mark10::Rate::other;
    for (const char byte : bytes) {
      in_.add(now, mark10_.byte_time());
      mark10_.take(byte, rate);
      queue(now);
    }
  }

  void queue(Nanoseconds now) {
    for (const char byte : mark10_.give())
      due_.push_back(
          {lockstep() ? now : out_.add(std::max(now, in_.free_at), mark10_.byte_time()), byte});
  }

  void write_due(Nanoseconds now) {
    std::string bytes;
    for (const DueByte& due : due_) {
      if (due.at > now) break;
      bytes += due.byte;
    }
    if (bytes.empty() || !pty_) return;
    const auto written = static_cast<std::ptrdiff_t>(pty_->write_some(bytes));
    due_.erase(due_.begin(), due_.begin() + written);
  }

  void unplug(Nanoseconds now) {
    pty_.reset();
    due_.clear();
    const auto again = mark10_.plugged_again_at();
    if (!again) {
      ended_ = true;
      return;
    }
    // An unplugged port receives no bytes that could advance a virtual clock; real time is used.
    if (!out_since_) out_since_ = now;
    const Nanoseconds away = lockstep() ? *again - mark10_.now() : *again - *out_since_;
    if (now - *out_since_ < away) return;
    out_since_.reset();
    mark10_.plug_in();
    pty_ = std::make_unique<Pty>(run_.settings.baud, run_.link);
    say_port();
  }

  const Mark10Run& run_;
  Log log_;
  Mark10 mark10_;
  std::unique_ptr<Pty> pty_;
  int signals_;
  Nanoseconds start_ = monotonic();
  Nanoseconds next_state_ = 0;
  Line in_ = {};
  Line out_ = {};
  std::deque<DueByte> due_ = {};
  std::optional<Nanoseconds> out_since_ = {};
  bool ended_ = false;
};

}  // namespace

int run_mark10(const Mark10Run& run) { return Loop(run).go(); }

}  // namespace emulator
