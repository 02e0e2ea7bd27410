// The system's calls by their numbers, after a look at what shall go wrong.
#include "file_faults.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace palpate::test {
namespace {

// A program that is started by the one under test, such as gnuplot, is let alone.
FileFaults from_environment() {
  FileFaults faults;
  if (std::string_view(program_invocation_short_name) != "palpate") return faults;
  if (const char* kill = std::getenv("PALPATE_TEST_KILL_BEFORE"))
    faults.kill_before = std::atoi(kill);
  faults.has_exchange = std::getenv("PALPATE_TEST_NO_EXCHANGE") == nullptr;
  return faults;
}

void count() {
  if (++file_faults.calls != file_faults.kill_before) return;
  ::kill(::getpid(), SIGKILL);
  for (;;) ::pause();
}

int result(long code) { return static_cast<int>(code); }

}  // namespace

FileFaults file_faults = from_environment();

}  // namespace palpate::test

using palpate::test::count;
using palpate::test::result;

extern "C" {

int renameat2(int from_folder, const char* from, int to_folder, const char* to,
              unsigned int flags) noexcept {
  if ((flags & RENAME_EXCHANGE) != 0 && !palpate::test::file_faults.has_exchange) {
    errno = EINVAL;
    return -1;
  }
  count();
  return result(::syscall(SYS_renameat2, from_folder, from, to_folder, to, flags));
}
int open(const char* name, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const mode_t mode = (flags & O_CREAT) != 0 ? va_arg(more, mode_t) : 0;
  va_end(more);
  if ((flags & (O_CREAT | O_TRUNC)) != 0) count();
  return result(::syscall(SYS_openat, AT_FDCWD, name, flags, mode));
}
// Of a file, not of a stream: those come first.
ssize_t write(int file, const void* bytes, size_t size) {
  if (file > STDERR_FILENO) count();
  return ::syscall(SYS_write, file, bytes, size);
}
int rename(const char* from, const char* to) noexcept {
  return renameat2(AT_FDCWD, from, AT_FDCWD, to, 0);
}
int unlinkat(int folder, const char* name, int flags) noexcept {
  count();
  return result(::syscall(SYS_unlinkat, folder, name, flags));
}
int unlink(const char* name) noexcept { return unlinkat(AT_FDCWD, name, 0); }
int rmdir(const char* name) noexcept { return unlinkat(AT_FDCWD, name, AT_REMOVEDIR); }
int remove(const char* name) noexcept {
  if (unlink(name) == 0) return 0;
  return errno == EISDIR ? rmdir(name) : -1;
}
int mkdir(const char* name, mode_t mode) noexcept {
  count();
  return result(::syscall(SYS_mkdirat, AT_FDCWD, name, mode));
}
}
