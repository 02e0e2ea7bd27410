// The system's calls by their numbers, after a look at what shall go wrong.
#include "file_faults.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace palpate::test {
namespace {

int number_of(const char* variable) {
  const char* text = std::getenv(variable);
  return text == nullptr ? 0 : std::atoi(text);
}

// A program that is started by the one under test, such as gnuplot, is let alone.
FileFaults from_environment() {
  FileFaults faults;
  if (std::string_view(program_invocation_short_name) != "palpate") return faults;
  faults.kill_before = number_of("PALPATE_TEST_KILL_BEFORE");
  faults.killed = ::getpid();
  faults.fail_at = number_of("PALPATE_TEST_FAIL_AT");
  faults.fail_with = number_of("PALPATE_TEST_FAIL_WITH");
  faults.stays = number_of("PALPATE_TEST_STAYS") != 0;
  faults.most_bytes = number_of("PALPATE_TEST_MOST_BYTES");
  faults.wait_ms = number_of("PALPATE_TEST_WAIT_MS");
  faults.has_exchange = std::getenv("PALPATE_TEST_NO_EXCHANGE") == nullptr;
  return faults;
}

enum class Call { reads, changes, removes };

void mark() {
  const char* name = std::getenv("PALPATE_TEST_MARK");
  if (name == nullptr) return;
  const long file = ::syscall(SYS_openat, AT_FDCWD, name, O_WRONLY | O_CREAT, 0600);
  ::syscall(SYS_close, file);
}

// Counts the call. Returns whether it fails, with errno set. Signals interrupt only calls that may
// wait (POSIX: open, read, write, fsync), not those that change a folder.
bool fails(Call call, bool may_wait = false) {
  FileFaults& faults = file_faults;
  ++faults.calls;
  if (faults.wait_ms > 0) ::poll(nullptr, 0, faults.wait_ms);
  if (call != Call::reads && ++faults.changes == faults.kill_before &&
      (faults.killed == 0 || faults.killed == ::getpid())) {
    ::kill(::getpid(), SIGKILL);
    for (;;) ::pause();
  }
  if (faults.fail_at == 0 || faults.calls < faults.fail_at) return false;
  if (faults.fail_with == EINTR && !may_wait) {
    if (faults.calls == faults.fail_at) ++faults.fail_at;  // the next one then
    return false;
  }
  if (faults.calls == faults.fail_at) mark();
  const bool full = faults.stays && call == Call::changes;
  if (faults.calls > faults.fail_at && !full) return false;
  errno = faults.fail_with;
  return true;
}

std::size_t at_most(std::size_t size) {
  const auto most = static_cast<std::size_t>(file_faults.most_bytes);
  return most == 0 ? size : std::min(size, most);
}

int result(long code) { return static_cast<int>(code); }

bool makes(int flags) { return (flags & O_CREAT) != 0 || (flags & O_TMPFILE) == O_TMPFILE; }

int opened(const char* name, int flags, mode_t mode) {
  const bool changes = makes(flags) || (flags & O_TRUNC) != 0;
  if (fails(changes ? Call::changes : Call::reads, true)) return -1;
  return result(::syscall(SYS_openat, AT_FDCWD, name, flags, mode));
}

}  // namespace

FileFaults file_faults = from_environment();

}  // namespace palpate::test

using palpate::test::at_most;
using palpate::test::Call;
using palpate::test::fails;
using palpate::test::result;

extern "C" {

int renameat2(int from_folder, const char* from, int to_folder, const char* to,
              unsigned int flags) noexcept {
  if ((flags & RENAME_EXCHANGE) != 0 && !palpate::test::file_faults.has_exchange) {
    errno = EINVAL;
    return -1;
  }
  if (fails(Call::changes)) return -1;
  return result(::syscall(SYS_renameat2, from_folder, from, to_folder, to, flags));
}
int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) noexcept {
  if (fails(Call::changes)) return -1;
  return result(::syscall(SYS_linkat, from_folder, from, to_folder, to, flags));
}
int open(const char* name, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = palpate::test::makes(flags) ? va_arg(more, mode_t) : 0;
  va_end(more);
  return palpate::test::opened(name, flags, mode);
}
// Of a file, not of a stream: those come first.
ssize_t write(int file, const void* bytes, size_t size) {
  if (file > STDERR_FILENO) {
    if (fails(Call::changes, true)) return -1;
    size = at_most(size);
  }
  return ::syscall(SYS_write, file, bytes, size);
}
ssize_t read(int file, void* bytes, size_t size) {
  if (file > STDERR_FILENO) {
    if (fails(Call::reads, true)) return -1;
    size = at_most(size);
  }
  return ::syscall(SYS_read, file, bytes, size);
}
int fsync(int file) {
  if (fails(Call::reads, true)) return -1;
  return result(::syscall(SYS_fsync, file));
}
int rename(const char* from, const char* to) noexcept {
  return renameat2(AT_FDCWD, from, AT_FDCWD, to, 0);
}
int unlinkat(int folder, const char* name, int flags) noexcept {
  if (fails(Call::removes)) return -1;
  return result(::syscall(SYS_unlinkat, folder, name, flags));
}
int unlink(const char* name) noexcept { return unlinkat(AT_FDCWD, name, 0); }
int rmdir(const char* name) noexcept { return unlinkat(AT_FDCWD, name, AT_REMOVEDIR); }
int remove(const char* name) noexcept {
  if (unlink(name) == 0) return 0;
  return errno == EISDIR ? rmdir(name) : -1;
}
int mkdir(const char* name, mode_t mode) noexcept {
  if (fails(Call::changes)) return -1;
  return result(::syscall(SYS_mkdirat, AT_FDCWD, name, mode));
}
}
