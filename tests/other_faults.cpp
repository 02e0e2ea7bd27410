// By LD_PRELOAD: the allocation PALPATE_TEST_FAIL_MEMORY fails, and the clock of the day is set
// back and forth by PALPATE_TEST_CLOCK_JUMP seconds.
#include <dlfcn.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <ctime>
#include <string_view>

namespace {

// The loader allocates before the environment is there for us.
long value_of(const char* variable) {
  if (environ == nullptr || program_invocation_short_name == nullptr ||
      std::string_view(program_invocation_short_name) != "palpate")
    return 0;
  const char* text = std::getenv(variable);
  return text == nullptr ? 0 : std::atol(text);
}

std::atomic<bool> main_has_begun = false;
int (*real_main)(int, char**, char**) = nullptr;

}  // namespace

extern "C" {

// Libraries allocate before main(), where nobody can catch anything: what counts begins with it.
using Main = int (*)(int, char**, char**);
int __libc_start_main(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
int counted_main(int count, char** words, char** environment) {
  main_has_begun = true;
  return real_main(count, words, environment);
}
int __libc_start_main(Main program, int count, char** words, void (*begin)(), void (*end)(),
                      void (*loader_end)(), void* stack) {
  real_main = program;
  const auto next =
      reinterpret_cast<decltype(&__libc_start_main)>(::dlsym(RTLD_NEXT, "__libc_start_main"));
  return next(&counted_main, count, words, begin, end, loader_end, stack);
}

#ifndef __SANITIZE_ADDRESS__  // which has a malloc of its own
void* __libc_malloc(std::size_t size);
void* malloc(std::size_t size) {
  static const long fail_at = value_of("PALPATE_TEST_FAIL_MEMORY");
  static std::atomic<long> count = 0;
  if (main_has_begun && fail_at > 0 && ++count == fail_at) {
    errno = ENOMEM;
    return nullptr;
  }
  return __libc_malloc(size);
}
#endif

int clock_gettime(clockid_t clock, timespec* time) noexcept {
  static const long jump = value_of("PALPATE_TEST_CLOCK_JUMP");
  static std::atomic<long> calls = 0;
  const long code = ::syscall(SYS_clock_gettime, clock, time);
  if (clock == CLOCK_REALTIME && code == 0 && ++calls % 2 == 0) time->tv_sec -= jump;
  return static_cast<int>(code);
}
}
