// What stands for std::condition_variable::wait() in programs with Ceres (src/fit/ceres_fit.cpp).
#include <gtest/gtest.h>

#include <condition_variable>
#include <mutex>
#include <thread>

namespace palpate::fit {
namespace {

// Two threads take turns a thousand times: each waits without the lock and has it again afterwards.
TEST(CeresWait, GivesTheLockAwayAndTakesItAgain) {
  constexpr int turns = 1000;
  std::mutex mutex;
  std::condition_variable signal;
  int turn = 0;
  const auto take = [&](int mine) {
    for (int i = 0; i < turns; ++i) {
      std::unique_lock lock(mutex);
      signal.wait(lock, [&] { return turn % 2 == mine; });
      ASSERT_TRUE(lock.owns_lock());
      ++turn;
      signal.notify_one();
    }
  };
  std::jthread other(take, 1);
  take(0);
  other.join();
  EXPECT_EQ(turn, 2 * turns);
}

}  // namespace
}  // namespace palpate::fit
