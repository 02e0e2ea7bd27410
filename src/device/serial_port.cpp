// A serial port by termios and poll. It is locked by TIOCEXCL, which root may ignore, and by flock
// on a file in /run/lock. A lock file that is left behind does not lock the port.
#include "device/serial_port.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <ctime>

#include "base/error.h"
#include "base/index.h"
#include "base/text.h"
#include "device/clock.h"
#include "device/tap.h"

namespace palpate::device {
namespace {

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw LinkError("palpate: the port `" + path + "` " + why);
}

[[noreturn]] void refuse_open(const std::string& path, int error) {
  switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
      refuse(
          path,
          "is not there; plug the device in and look for it with `ls /dev/ttyUSB* /dev/ttyACM*`");
    case EACCES:
    case EPERM:
      refuse(path,
             "may not be opened by this user; join the group that owns it, as with `sudo usermod "
             "-aG dialout $USER`, and log in again");
    case EBUSY: refuse(path, "is held by another program; close that one first");
    default: refuse(path, std::string("cannot be opened: ") + std::strerror(error));
  }
}

struct Rate {
  int baud;
  speed_t code;
};
constexpr std::array rates{Rate{300, B300},       Rate{600, B600},       Rate{1200, B1200},
                           Rate{2400, B2400},     Rate{4800, B4800},     Rate{9600, B9600},
                           Rate{19200, B19200},   Rate{38400, B38400},   Rate{57600, B57600},
                           Rate{115200, B115200}, Rate{230400, B230400}, Rate{460800, B460800},
                           Rate{500000, B500000}, Rate{921600, B921600}, Rate{1000000, B1000000}};

speed_t speed_of(const std::string& path, int baud) {
  for (const Rate& rate : rates)
    if (rate.baud == baud) return rate.code;
  refuse(path, "cannot be set to " + std::to_string(baud) + " baud; take " + known_rates());
}

tcflag_t bits_of(const LineFormat& format) {
  using Parity = LineFormat::Parity;
  tcflag_t bits = format.data_bits == 7 ? CS7 : CS8;
  if (format.parity != Parity::none) bits |= PARENB;
  if (format.parity == Parity::odd) bits |= PARODD;
  return bits;
}

// The guard process of a run that was killed holds the port for half a second.
constexpr double held_time = 1.0;  // s, for which a port that is held is asked for again
constexpr timespec held_pause{.tv_sec = 0, .tv_nsec = 10'000'000};

// Opens and locks the lock file of a device. Its name is that of the resolved path, so that a
// symbolic link and its target have the same lock.
Descriptor lock_for(const std::string& path, double until) {
  char real[PATH_MAX];
  std::string name = ::realpath(path.c_str(), real) != nullptr ? real : path;
  for (char& c : name)
    if (c == '/') c = '_';
  for (const char* folder : {"/run/lock", "/tmp"}) {
    const std::string file = std::string(folder) + "/palpate" + name + ".lock";
    Descriptor lock = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (lock < 0) continue;
    while (true) {
      if (::flock(lock, LOCK_EX | LOCK_NB) == 0) return lock;
      if (errno != EWOULDBLOCK || wire_time() > until) break;
      ::nanosleep(&held_pause, nullptr);
    }
    if (errno == EWOULDBLOCK) refuse(path, "is held by another palpate; end that one first");
  }
  return {};  // neither folder is writable; TIOCEXCL alone locks the port
}

}  // namespace

bool is_known_rate(int baud) {
  return std::ranges::any_of(rates, [&](const Rate& rate) { return rate.baud == baud; });
}

std::string known_rates() {
  std::vector<std::string> list;
  for (const Rate& rate : rates) list.push_back(std::to_string(rate.baud));
  return alternatives(list);
}

SerialPort::SerialPort(const std::string& path, const LineFormat& format, Use use) : use_(use) {
  const speed_t speed = speed_of(path, format.baud);
  const double until = wire_time() + held_time;
  do {
    file_ = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  } while (file_ < 0 && errno == EBUSY && wire_time() < until &&
           ::nanosleep(&held_pause, nullptr) == 0);
  if (file_ < 0) refuse_open(path, errno);
  if (::isatty(file_) != 1)
    refuse(path, "is no serial line; give that of the device, such as `/dev/ttyUSB0`");
  if (use == Use::alone) lock_ = lock_for(path, until);
  if (use == Use::alone) ::ioctl(file_, TIOCEXCL);
  termios line{};
  bool set = ::tcgetattr(file_, &line) == 0;
  if (set) {
    ::cfmakeraw(&line);
    line.c_cflag &= ~static_cast<tcflag_t>(CSIZE | CSTOPB | PARENB | PARODD | CRTSCTS | HUPCL);
    line.c_cflag |= CLOCAL | CREAD | bits_of(format);
    line.c_cc[VMIN] = 0;
    line.c_cc[VTIME] = 0;
    ::cfsetispeed(&line, speed);
    ::cfsetospeed(&line, speed);
    set = ::tcsetattr(file_, TCSANOW, &line) == 0;
  }
  if (!set) {
    const int error = errno;
    unlock();
    refuse(path, std::string("cannot be set up as a serial line: ") + std::strerror(error));
  }
  // The output is not flushed: it may still contain the stop of the program that used it before.
  ::tcflush(file_, TCIFLUSH);
}

SerialPort::~SerialPort() { unlock(); }

void SerialPort::unlock() {
  if (file_ >= 0 && use_ == Use::alone) ::ioctl(file_, TIOCNXCL);
}

bool SerialPort::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t taken = ::write(file_, bytes.data(), bytes.size());
    if (taken > 0) {
      if (tap_) tap_->note(Tap::Way::sent, bytes.substr(0, as_index(taken)));
      bytes.remove_prefix(as_index(taken));
    } else if (taken < 0 && errno == EINTR) {
      continue;
    } else {
      // A full queue is temporary; any other error (EIO, ENXIO) means an unplugged device.
      if (taken < 0 && errno != EAGAIN) lost_ = true;
      return false;
    }
  }
  return true;
}

SerialPort::Read SerialPort::read(std::span<char> into, double until) {
  if (lost_) return {Outcome::lost, 0};
  while (true) {
    const timespec wait = timespec_of(std::max(0.0, until - wire_time()));
    pollfd one{file_, POLLIN, 0};
    const int ready = ::ppoll(&one, 1, &wait, nullptr);
    if (ready < 0 && errno == EINTR) continue;
    if (ready == 0) return {Outcome::nothing, 0};
    const ssize_t size = ready < 0 ? -1 : ::read(file_, into.data(), into.size());
    if (size > 0) {
      const auto got = as_index(size);
      if (tap_) tap_->note(Tap::Way::received, {into.data(), got});
      return {Outcome::bytes, got};
    }
    if (size < 0 && errno == EINTR) continue;
    if (size < 0 && errno == EAGAIN && (one.revents & (POLLHUP | POLLERR | POLLNVAL)) == 0)
      return {Outcome::nothing, 0};
    // End of file, EIO, ENXIO or a hang-up without bytes: the device was unplugged.
    lost_ = true;
    return {Outcome::lost, 0};
  }
}

namespace {

bool is_end(char c) { return c == '\r' || c == '\n'; }

}  // namespace

void LineBuffer::feed(std::string_view bytes) {
  if (bytes.size() > bytes_.size()) {
    dropped_ += bytes.size() - bytes_.size();
    bytes.remove_prefix(bytes.size() - bytes_.size());
  }
  const std::size_t waiting = end_ - begin_;
  const std::size_t room = bytes_.size() - bytes.size();
  if (waiting > room) {
    dropped_ += waiting - room;
    begin_ += waiting - room;
  }
  std::memmove(bytes_.data(), bytes_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  std::ranges::copy(bytes, bytes_.begin() + static_cast<std::ptrdiff_t>(end_));
  end_ += bytes.size();
}

std::optional<std::string_view> LineBuffer::next() {
  while (begin_ < end_ && is_end(bytes_[begin_])) ++begin_;
  std::size_t at = begin_;
  while (at < end_ && !is_end(bytes_[at]) && at - begin_ < longest_line) ++at;
  if (at == end_) return std::nullopt;
  const std::string_view line(bytes_.data() + begin_, at - begin_);
  begin_ = at;
  return without_outer_spaces(line);
}

std::string_view LineBuffer::rest() const { return {bytes_.data() + begin_, end_ - begin_}; }

void LineBuffer::clear() { begin_ = end_ = 0; }

constexpr std::size_t diagnosis_bytes = 400;
constexpr int most_reads = 64;  // of 256 bytes: twice what 115200 baud carry in 0.7 s

SerialLines::SerialLines(const std::string& path, const LineFormat& format, Tap* tap,
                         SerialPort::Use use)
    : port(path, format, use) {
  port.tap(tap);
  first_bytes.reserve(diagnosis_bytes);
}

std::string_view SerialLines::read(std::span<char> bytes, double until) {
  const auto read = port.read(bytes, until);
  if (read.outcome != SerialPort::Outcome::bytes) return {};
  const std::string_view got(bytes.data(), read.size);
  first_bytes += got.substr(0, diagnosis_bytes - first_bytes.size());
  return got;
}

bool SerialLines::receive(double until) {
  std::array<char, 256> bytes;
  const std::string_view got = read(bytes, until);
  lines.feed(got);
  return !got.empty();
}

std::size_t SerialLines::drain() {
  std::array<char, 256> bytes;
  std::size_t size = lines.rest().size();
  lines.clear();
  for (int reads = 0; reads < most_reads; ++reads) {
    const std::string_view got = read(bytes, 0.0);
    if (got.empty()) break;
    size += got.size();
  }
  return size;
}

std::string_view without_outer_spaces(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

double garbage_share(std::string_view bytes) {
  if (bytes.empty()) return 0.0;
  const auto odd = std::ranges::count_if(bytes, [](char c) {
    return !is_end(c) &&
           (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e);
  });
  return static_cast<double>(odd) / static_cast<double>(bytes.size());
}

std::string printable(std::string_view bytes) {
  std::string text;
  for (const char c : bytes.substr(0, 40)) text += c >= ' ' && c <= '~' ? c : '.';
  return text;
}

}  // namespace palpate::device
