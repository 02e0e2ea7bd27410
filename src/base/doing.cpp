// Keeps what a long computation is at.
#include "base/doing.h"

#include <mutex>
#include <utility>

namespace palpate {
namespace {

struct Doing {
  std::mutex mutex;
  std::string text;
};

Doing& now_doing() {
  static Doing doing;
  return doing;
}

}  // namespace

void set_doing(std::string text) {
  const std::scoped_lock lock(now_doing().mutex);
  now_doing().text = std::move(text);
}

std::string doing() {
  const std::scoped_lock lock(now_doing().mutex);
  return now_doing().text;
}

}  // namespace palpate
