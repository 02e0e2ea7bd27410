// The loop of a device on a pseudo-terminal: bytes that arrive, the passage of time, and replies at
// the line's rate.
#pragma once

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
#include <optional>
#include <string>

#include "emulator/log.h"
#include "emulator/pty.h"
#include "emulator/serial_device.h"

namespace emulator {

struct PtyRun {
  std::string link = {};
  std::string log = {};
  std::optional<double> lifetime = {};  // s, real time; none: until SIGINT or SIGTERM
  int baud = 115200;
  Clock clock = Clock::real;
  Nanoseconds tick = 20'000'000;  // of a virtual clock
};

inline constexpr Nanoseconds wake = 2'000'000;  // ns, longest wait, for faults and output by time
inline constexpr Nanoseconds state_every =
    20'000'000;  // ns, between rows of the log with the state

inline Nanoseconds monotonic() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

inline int signals() {
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

// Prints one JSON line with the port when the port is ready, and again after an `unplug`, and one
// with the device's summary() at the end.
class PtyLoop {
 public:
  PtyLoop(const PtyRun& run, SerialDevice& device)
      : run_(run),
        device_(device),
        pty_(std::make_unique<Pty>(run.baud, run.link)),
        signals_(signals()) {
    say_port();
  }
  ~PtyLoop() { ::close(signals_); }
  PtyLoop(const PtyLoop&) = delete;
  PtyLoop& operator=(const PtyLoop&) = delete;

  int go() {
    while (!ended_) turn();
    device_.log_state();
    std::printf("{\"summary\":%s}\n", device_.summary().c_str());
    std::fflush(stdout);
    return 0;
  }

 private:
  [[nodiscard]] bool lockstep() const { return run_.clock == Clock::lockstep; }

  void say_port() const {
    std::printf("{\"port\":\"%s\",\"clock\":\"%s\",\"tick_s\":%.9g,\"baud\":%d,\"pid\":%d}\n",
                pty_->path().c_str(), lockstep() ? "virtual" : "real", seconds(run_.tick),
                run_.baud, static_cast<int>(::getpid()));
    std::fflush(stdout);
  }

  [[nodiscard]] SerialDevice::Rate side() const {
    return pty_->same_rate() ? SerialDevice::Rate::same : SerialDevice::Rate::other;
  }

  void turn() {
    wait();
    const Nanoseconds now = monotonic() - start_;
    if (run_.lifetime && now > nanoseconds(*run_.lifetime)) ended_ = true;
    if (pty_) device_.hears_at(side());
    // A stream of a virtual clock goes on when its last line has been read, so that an unplugged
    // line loses nothing.
    if (!lockstep() || (due_.empty() && (!pty_ || pty_->is_read()))) device_.pass(now);
    if (pty_) read(now);
    if (device_.unplugged()) unplug(now);
    queue(now);
    write_due(now);
    if (!lockstep() && now >= next_state_) {
      device_.log_state();
      next_state_ = now + state_every;
    }
  }

  void wait() {
    Nanoseconds longest = wake;
    if (!due_.empty() && !blocked_)
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
    for (const char byte : bytes) {
      in_.add(now, device_.byte_time());
      device_.take(byte, side());
      queue(now);
    }
  }

  void queue(Nanoseconds now) {
    for (const char byte : device_.give())
      due_.push_back(
          {lockstep() ? now : out_.add(std::max(now, in_.free_at), device_.byte_time()), byte});
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
    blocked_ = written == 0;
    // What nobody reads is lost, as on a real line.
    if (blocked_ && !lockstep()) due_.clear();
  }

  void unplug(Nanoseconds now) {
    pty_.reset();
    due_.clear();
    const auto again = device_.plugged_again_at();
    if (!again) {
      ended_ = true;
      return;
    }
    // An unplugged port receives no bytes that could advance a virtual clock; real time is used.
    if (!out_since_) out_since_ = now;
    const Nanoseconds away = lockstep() ? *again - device_.now() : *again - *out_since_;
    if (now - *out_since_ < away) return;
    out_since_.reset();
    device_.plug_in();
    pty_ = std::make_unique<Pty>(run_.baud, run_.link);
    say_port();
  }

  const PtyRun& run_;
  SerialDevice& device_;
  std::unique_ptr<Pty> pty_;
  int signals_;
  Nanoseconds start_ = monotonic();
  Nanoseconds next_state_ = 0;
  Line in_ = {};
  Line out_ = {};
  std::deque<DueByte> due_ = {};
  std::optional<Nanoseconds> out_since_ = {};
  bool blocked_ = false;  // the port takes no more bytes
  bool ended_ = false;
};

}  // namespace emulator
