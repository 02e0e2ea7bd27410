// Parts as text, and locks by flock, which the system releases when the process ends.
#include "sweep/shard.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "base/files.h"
#include "base/text.h"

namespace palpate::sweep {

std::string Shard::text() const { return std::to_string(number) + "-of-" + std::to_string(of); }

Shard parse_shard(const std::string& text) {
  const std::size_t slash = std::min(text.find('/'), text.size());
  const auto number = whole_number(text.substr(0, slash));
  const auto of = whole_number(text.substr(std::min(slash + 1, text.size())));
  constexpr double most = 1e8;  // as `--of`; a double beyond 2^64 has no whole number of its own
  if (!number || !of || *number < 1.0 || *number > *of || *of > most ||
      std::fmod(*number, 1.0) != 0.0 || std::fmod(*of, 1.0) != 0.0)
    throw InputError({}, "`--shard` wants a part and the number of parts, got `" + text +
                             "`; write `--shard 3/16`");
  return {static_cast<std::size_t>(*number), static_cast<std::size_t>(*of)};
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
