// Signal handlers that use two atomic numbers only.
#include "cli/interrupt.h"

#include <unistd.h>

#include <csignal>

namespace palpate::cli {
namespace {

std::atomic<bool> stop_requested = false;
std::atomic<int> code_at_once = 0;

void request_stop(int) {
  // A second signal ends the program without waiting for the row.
  if (stop_requested.exchange(true)) ::_exit(code_at_once.load());
}

}  // namespace

const std::atomic<bool>& listen_for_interrupts(int code, const std::vector<int>& more) {
  code_at_once = code;
  std::vector<int> signals{SIGINT, SIGTERM};
  signals.insert(signals.end(), more.begin(), more.end());
  for (const int signal : signals) {
    struct sigaction before {};
    ::sigaction(signal, nullptr, &before);
    if (before.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = request_stop;
    ::sigaction(signal, &action, nullptr);
  }
  return stop_requested;
}

}  // namespace palpate::cli
