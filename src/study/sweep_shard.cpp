// flock: a lock that dies with its process.
#include "study/sweep_shard.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>

#include "base/error.h"
#include "base/text.h"

namespace palpate::study {
namespace {

// Decimal digits and nothing else, not 0; else 0.
std::size_t whole(std::string_view text) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value : 0;
}

std::string holder(int file) {
  std::array<char, 256> text{};
  const ssize_t got = ::pread(file, text.data(), text.size(), 0);
  const std::string who = trimmed(std::string_view(text.data(), got > 0 ? std::size_t(got) : 0));
  return who.empty() ? "another process" : who;
}

}  // namespace

std::string Shard::text() const { return std::to_string(number) + "-of-" + std::to_string(of); }

Shard parse_shard(const std::string& text) {
  const std::size_t slash = text.find('/');
  Shard shard{0, 0};
  if (slash != std::string::npos)
    shard = {whole(std::string_view(text).substr(0, slash)),
             whole(std::string_view(text).substr(slash + 1))};
  if (shard.number == 0 || shard.of == 0 || shard.number > shard.of)
    throw InputError({}, "`--shard` wants a part and the number of parts, got `" + text +
                             "`; write `--shard 3/16`");
  return shard;
}

std::string host_name() {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return "unknown";
  std::string text = name.data();
  for (char& c : text)
    if (c == '/') c = '_';
  return text;
}

FolderLock::FolderLock(const std::string& folder, const std::string& name) {
  namespace fs = std::filesystem;
  std::error_code error;
  fs::create_directories(fs::path(folder) / "locks", error);
  const std::string path = (fs::path(folder) / "locks" / (name + ".lock")).string();
  file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) throw SystemError(path + " cannot be made: " + std::strerror(errno));
  if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
    const int reason = errno;
    const std::string who = holder(file_);
    ::close(file_);
    if (reason == EWOULDBLOCK)
      throw InputError({folder, 0, 0}, "part " + name + " is run already, by " + who +
                                           "; wait for it, or run another `--shard`");
    throw SystemError(path + " cannot be locked: " + std::strerror(reason));
  }
  const std::string who = "process " + std::to_string(::getpid()) + " on " + host_name() + "\n";
  // What is written is for people: a full disk shall not keep anybody from locking.
  if (::ftruncate(file_, 0) != 0 || ::pwrite(file_, who.data(), who.size(), 0) < 0) return;
}

FolderLock::~FolderLock() { ::close(file_); }

}  // namespace palpate::study
