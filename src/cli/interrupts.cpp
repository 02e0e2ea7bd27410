// Signal handlers, which reach nothing but one flag.
#include "cli/interrupts.h"

#include <unistd.h>

#include <csignal>

#include "cli/program.h"

namespace palpate::cli {
namespace {

std::atomic<bool> stop_requested = false;

void request_stop(int) {
  // A second signal does not wait for the row to end.
  if (stop_requested.exchange(true)) ::_exit(exit_interrupted);
}

}  // namespace

const std::atomic<bool>& interrupt_flag() { return stop_requested; }

void listen_for_interrupts() {
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction before {};
    ::sigaction(signal, nullptr, &before);
    if (before.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = request_stop;
    ::sigaction(signal, &action, nullptr);
  }
}

}  // namespace palpate::cli
