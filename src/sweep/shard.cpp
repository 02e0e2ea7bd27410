// Parts as text, and locks by flock, which the system releases when the process ends.
#include "sweep/shard.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>

#include "base/files.h"
#include "base/text.h"

namespace palpate::sweep {
namespace {

// The number if the text consists of decimal digits only, otherwise 0.
std::size_t whole(std::string_view text) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? value : 0;
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

FolderLock::FolderLock(const std::string& folder, const std::string& name) {
  make_folders(folder + "/locks");
  const std::string path = folder + "/locks/" + name + ".lock";
  file_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (file_ < 0) throw SystemError(path + " cannot be made: " + std::strerror(errno));
  if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
    const int reason = errno;
    if (reason == ENOSYS || reason == ENOLCK || reason == EOPNOTSUPP) {
      warning_ = folder + ": its file system has no locks, so that two processes may run part " +
                 name + " at once, which costs time and does no harm";
      return;
    }
    ::close(file_);
    const std::string text = trimmed(read_text(path));
    const std::string who = text.empty() ? "another process" : text;
    if (reason == EWOULDBLOCK)
      throw PartIsRun({folder, 0, 0}, "part " + name + " is run already, by " + who +
                                          "; wait for it, or run another `--shard`");
    throw SystemError(path + " cannot be locked: " + std::strerror(reason));
  }
  const std::string who = "process " + std::to_string(::getpid()) + " on " + host_name() + "\n";
  // The text only informs users: if it cannot be written, the lock holds all the same.
  if (::ftruncate(file_, 0) != 0 || ::pwrite(file_, who.data(), who.size(), 0) < 0) return;
}

FolderLock::~FolderLock() { ::close(file_); }

}  // namespace palpate::sweep
