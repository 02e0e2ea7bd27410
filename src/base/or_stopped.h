// Lets a signal end a long computation of a library, which knows no StopScope.
#pragma once

#include <chrono>
#include <future>
#include <thread>
#include <utility>

#include "base/stop_scope.h"

namespace palpate {

// The result of `work`, which owns all that it uses. Where the thread has a flag for signals,
// another thread computes while this one waits for the result or the flag; then it throws Stopped,
// and the other thread ends with its work or the program.
template <typename Result, typename Work>
Result or_stopped(Work work) {
  const StopScope::Limits limits = StopScope::limits();
  if (limits.flag == nullptr) return work();
  std::packaged_task<Result()> task(std::move(work));
  std::future<Result> result = task.get_future();
  std::thread thread(std::move(task));
  constexpr std::chrono::milliseconds until_next_look(50);
  while (result.wait_for(until_next_look) != std::future_status::ready) {
    if (!limits.flag->load(std::memory_order_relaxed)) continue;
    thread.detach();
    throw Stopped();
  }
  thread.join();
  return result.get();
}

}  // namespace palpate
