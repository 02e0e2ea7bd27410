// The lock of METIS, and the signals that it must not take.
#include "base/metis_lock.h"

#include <csignal>

// METIS handles SIGTERM and SIGABRT while it works, for all threads, by a jump back to its own
// caller, and then puts the handlers from before back for one signal only. This definition stands
// in front of the C library's for the libraries that palpate loads, of which METIS alone asks for
// it: the handlers stay those of the program.
extern "C" sighandler_t __sysv_signal(int, sighandler_t) noexcept { return SIG_DFL; }

namespace palpate {

std::mutex& metis_lock() {
  static std::mutex one_at_a_time;
  return one_at_a_time;
}

}  // namespace palpate
