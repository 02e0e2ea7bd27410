// Exceptions are rethrown after all calls, so that the reported one does not depend on timing.
#include "run/share_out.h"

#include <atomic>
#include <exception>
#include <thread>
#include <vector>

#include "base/stop_scope.h"

namespace palpate::run {

void share_out(std::size_t count, int workers, const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::exception_ptr> failures(count);
  const auto take = [&, limits = StopScope::limits()] {
    const StopScope scope(limits);
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
      } catch (...) {
        failures[i] = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> others;
    for (int worker = 1; worker < workers; ++worker) others.emplace_back(take);
    take();
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace palpate::run
