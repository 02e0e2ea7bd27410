// Signal handlers that use two atomic numbers only.
#include "cli/interrupt.h"

#include <unistd.h>

#include <csignal>
#include <string_view>

namespace palpate::cli {
namespace {

std::atomic<bool> stop_requested = false;
std::atomic<int> code_at_once = 0;

void request_stop(int) {
  // A second signal ends the program without waiting for the step.
  if (stop_requested.exchange(true)) ::_exit(code_at_once.load());
}

void end_at_once(int) {
  constexpr std::string_view sentence = "palpate: interrupted\n";
  (void)!::write(STDERR_FILENO, sentence.data(), sentence.size());
  ::_exit(code_at_once.load());
}

void handle(const std::vector<int>& signals, void (*handler)(int)) {
  for (const int signal : signals) {
    struct sigaction before {};
    ::sigaction(signal, nullptr, &before);
    if (before.sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = handler;
    ::sigaction(signal, &action, nullptr);
  }
}

}  // namespace

void end_at_interrupts(int code) {
  code_at_once = code;
  handle({SIGINT, SIGTERM}, end_at_once);
}

const std::atomic<bool>& listen_for_interrupts(int code, const std::vector<int>& more) {
  code_at_once = code;
  std::vector<int> signals{SIGINT, SIGTERM};
  signals.insert(signals.end(), more.begin(), more.end());
  handle(signals, request_stop);
  return stop_requested;
}

}  // namespace palpate::cli
