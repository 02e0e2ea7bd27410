// The faults of a serial line.
#include "emulator/serial_device.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/signalfd.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <memory>
#include <utility>

#include "base/error.h"
#include "base/index.h"

namespace emulator {

char SerialDevice::noise(char byte) {
  return static_cast<char>((static_cast<unsigned char>(byte) * 37U + 11U) | 0x80U);
}

Nanoseconds SerialDevice::byte_time() const {
  const Nanoseconds usual = (10'000'000'000 + baud_ / 2) / baud_;
  return faults_.lasts("slow", now_) ? 10 * usual : usual;
}

std::string SerialDevice::give() {
  if (faults_.lasts("stall", now_)) return {};
  return std::exchange(out_, {});
}

void SerialDevice::plug_in() {
  unplugged_ = false;
  again_.reset();
}

void SerialDevice::go_to(Nanoseconds time, std::int64_t messages) {
  const auto reach = [&](Nanoseconds at) {
    advance_to(std::max(now_, at));
    for (const Fault& fault : faults_.begin(now_, messages)) {
      log_row("fault", fault.kind);
      if (fault.kind != "unplug") {
        begin(fault);
        continue;
      }
      unplugged_ = true;
      out_.clear();
      if (fault.duration) again_ = now_ + *fault.duration;
    }
  };
  for (auto next = faults_.next_time(); next && *next <= time; next = faults_.next_time())
    reach(*next);
  reach(time);
}

std::string SerialDevice::spoilt(std::string reply, const std::string& another, std::size_t end) {
  if (faults_.spoils("glue")) std::erase_if(reply, [](char c) { return c == '\r' || c == '\n'; });
  if (faults_.spoils("truncate") && reply.size() > end)
    reply.erase((reply.size() - end) / 2, reply.size() - end - (reply.size() - end) / 2);
  if (faults_.spoils("duplicate")) reply += reply;
  if (faults_.spoils("unsolicited")) reply = another + reply;
  if (faults_.spoils("nul")) {
    std::string wide;
    for (const char byte : reply) (wide += byte) += '\0';
    reply = wide;
  }
  if (faults_.spoils("garbage") && reply.size() > end)
    std::transform(reply.begin(), reply.end() - static_cast<std::ptrdiff_t>(end), reply.begin(),
                   noise);
  if (faults_.spoils("drop")) reply.clear();
  return reply;
}

void SerialDevice::send(const std::string& bytes) {
  if (bytes.empty()) return;
  log_row("out", bytes);
  const bool garbled = other_rate_ || faults_.lasts("wrong_baud", now_);
  for (const char byte : bytes) out_ += garbled ? noise(byte) : byte;
}

// A pseudo-terminal in place of a serial port, by posix_openpt and termios, and its loop.

namespace {

struct Baud {
  int rate;
  speed_t code;
};
constexpr std::array bauds{Baud{2400, B2400},     Baud{4800, B4800},     Baud{9600, B9600},
                           Baud{19200, B19200},   Baud{38400, B38400},   Baud{57600, B57600},
                           Baud{115200, B115200}, Baud{230400, B230400}, Baud{460800, B460800},
                           Baud{921600, B921600}};

speed_t code_of(int rate) {
  for (const Baud& baud : bauds)
    if (baud.rate == rate) return baud.code;
  throw InputError({"--baud"}, "there is no rate of " + std::to_string(rate) + "; write 115200");
}

void make_link(const std::string& link, const std::string& path) {
  std::error_code error;
  const auto there = std::filesystem::symlink_status(link, error);
  if (std::filesystem::exists(there) && !std::filesystem::is_symlink(there))
    throw InputError({"--link"},
                     "`" + link + "` exists and is not a symbolic link; name another path");
  std::filesystem::remove(link, error);
  std::filesystem::create_symlink(path, link, error);
  if (error)
    throw InputError({"--link"},
                     "`" + link + "` cannot be made; name a path in a folder that exists");
}

class Pty {
 public:
  // Opens a pair, raw, at `baud`; a `link` that is not empty becomes a symbolic link to the port.
  // Throws InputError if the pair cannot be opened, `baud` is unknown, or `link` is another file.
  Pty(int baud, const std::string& link) : baud_(baud), link_(link) {
    const speed_t code = code_of(baud);
    master_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    std::array<char, 128> name{};
    if (master_ < 0 || ::grantpt(master_) != 0 || ::unlockpt(master_) != 0 ||
        ::ptsname_r(master_, name.data(), name.size()) != 0)
      throw InputError(palpate::Place{},
                       "no pseudo-terminal can be opened here; is /dev/pts mounted?");
    path_ = name.data();
    slave_ = ::open(path_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    termios line{};
    if (slave_ < 0 || ::tcgetattr(slave_, &line) != 0)
      throw InputError({path_}, "the port cannot be opened; is /dev/pts mounted?");
    ::cfmakeraw(&line);
    ::cfsetspeed(&line, code);
    ::tcsetattr(slave_, TCSANOW, &line);
    if (!link_.empty()) make_link(link_, path_);
  }
  ~Pty() {
    if (master_ >= 0) ::close(master_);
    if (slave_ >= 0) ::close(slave_);
    std::error_code ignored;
    if (!link_.empty() && std::filesystem::is_symlink(link_, ignored))
      std::filesystem::remove(link_, ignored);
  }
  Pty(const Pty&) = delete;
  Pty& operator=(const Pty&) = delete;

  [[nodiscard]] int descriptor() const { return master_; }
  [[nodiscard]] const std::string& path() const { return path_; }

  // Whether the port still has the rate with which it was opened.
  [[nodiscard]] bool same_rate() const {
    termios line{};
    if (::tcgetattr(master_, &line) != 0) return true;
    const speed_t code = code_of(baud_);
    return ::cfgetospeed(&line) == code && ::cfgetispeed(&line) == code;
  }

  [[nodiscard]] std::string read_all() const {
    std::string bytes;
    std::array<char, 256> chunk{};
    for (;;) {
      const ssize_t got = ::read(master_, chunk.data(), chunk.size());
      if (got <= 0) return bytes;
      bytes.append(chunk.data(), palpate::as_index(got));
    }
  }

  // Whether the client has read all that was written: poll(2) of its end waits for bytes that the
  // system still carries there (n_tty_poll).
  [[nodiscard]] bool is_read() const {
    pollfd unread{slave_, POLLIN, 0};
    return ::poll(&unread, 1, 0) == 0;
  }

  // Returns the number of bytes that were accepted.
  [[nodiscard]] std::size_t write_some(const std::string& bytes) const {
    const ssize_t written = ::write(master_, bytes.data(), bytes.size());
    return written < 0 ? 0 : palpate::as_index(written);
  }

 private:
  int baud_;
  std::string link_;
  std::string path_ = {};
  int master_ = -1;
  int slave_ = -1;  // kept open, so that clients can disconnect and reconnect
};

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
  static constexpr Nanoseconds wake = 2'000'000;  // longest wait, for faults and output by time
  static constexpr Nanoseconds state_every = 20'000'000;  // between rows of the log with the state

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

}  // namespace

int run_on_pty(const PtyRun& run, SerialDevice& device) { return PtyLoop(run, device).go(); }

}  // namespace emulator
