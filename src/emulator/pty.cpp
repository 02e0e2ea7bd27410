// A pseudo-terminal by posix_openpt and termios.
#include "emulator/pty.h"

#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <filesystem>

#include "base/error.h"
#include "base/index.h"

namespace emulator {
namespace {

using palpate::InputError;

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

}  // namespace

Pty::Pty(int baud, const std::string& link) : baud_(baud), link_(link) {
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

Pty::~Pty() {
  if (master_ >= 0) ::close(master_);
  if (slave_ >= 0) ::close(slave_);
  std::error_code ignored;
  if (!link_.empty() && std::filesystem::is_symlink(link_, ignored))
    std::filesystem::remove(link_, ignored);
}

bool Pty::same_rate() const {
  termios line{};
  if (::tcgetattr(master_, &line) != 0) return true;
  const speed_t code = code_of(baud_);
  return ::cfgetospeed(&line) == code && ::cfgetispeed(&line) == code;
}

std::string Pty::read_all() const {
  std::string bytes;
  std::array<char, 256> chunk{};
  for (;;) {
    const ssize_t got = ::read(master_, chunk.data(), chunk.size());
    if (got <= 0) return bytes;
    bytes.append(chunk.data(), palpate::as_index(got));
  }
}

// poll(2) of the client's end waits for bytes that the system still carries there (n_tty_poll).
bool Pty::is_read() const {
  pollfd unread{slave_, POLLIN, 0};
  return ::poll(&unread, 1, 0) == 0;
}

std::size_t Pty::write_some(const std::string& bytes) const {
  const ssize_t written = ::write(master_, bytes.data(), bytes.size());
  return written < 0 ? 0 : palpate::as_index(written);
}

}  // namespace emulator
