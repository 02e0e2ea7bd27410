// Keeps what a long computation is at.
#include "base/doing.h"

#include <mutex>
#include <utility>

namespace palpate {
namespace {

struct Now {
  std::mutex mutex;
  Doing doing;
};

Now& now() {
  static Now one;
  return one;
}

}  // namespace

void set_doing(Doing next) {
  const std::scoped_lock lock(now().mutex);
  now().doing = std::move(next);
}

Doing doing() {
  const std::scoped_lock lock(now().mutex);
  return now().doing;
}

}  // namespace palpate
