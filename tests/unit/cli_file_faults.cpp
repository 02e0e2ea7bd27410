// Calls on files that fail, in verbs that replace a result: whatever fails, the old result or a
// whole new one stands, the exit code is a documented one, and an error has a sentence.
// PALPATE_EVERY_FAULT=1 tries every call in place of some.
#include <gtest/gtest.h>

#include <cerrno>
#include <random>

#include "program.h"
#include "result_verbs.h"

namespace palpate::test {
namespace {

using Faults = std::vector<std::pair<std::string, std::string>>;

class FileFaults : public Hindered {
 protected:
  // A run with faults; returns whether any was met.
  bool met(const Faults& faults, const std::string& what) {
    const fs::path mark = folder_ / "mark";
    Faults all = faults;
    all.emplace_back("PALPATE_TEST_MARK", mark.string());
    const Ended ended = hindered(all);
    EXPECT_EQ(ended.signal, 0) << what << ": " << ended.err;
    EXPECT_TRUE(ended.code == 0 || ended.code == 1 || ended.code == 2 || ended.code == 5)
        << what << ": " << ended.code << ended.err;
    EXPECT_TRUE(ended.code == 0 || !ended.err.empty()) << what << ": no sentence";
    if (ended.code == 0) {
      EXPECT_TRUE(is_new()) << what << ": exit code 0 and no result:" << others() << ended.err;
    }
    // The two files of a mesh are replaced one by one, and a pair of two meshes is refused.
    const bool pair = std::string(GetParam().name) == "convert" && ended.code != 0;
    EXPECT_TRUE(is_old() || is_new() || pair) << what << ": " << ended.err;
    if (!is_old()) restore();
    const bool seen = fs::exists(mark);
    fs::remove(mark);
    return seen;
  }
  void fail_each(int error, const Faults& more = {}) {
    const int step = every() ? 1 : 10 * GetParam().stride;
    // The first call differs from one error to the next, so that together they meet more calls.
    for (int call = 1 + error % step; call < 2000; call += step) {
      Faults faults = more;
      faults.emplace_back("PALPATE_TEST_FAIL_AT", std::to_string(call));
      faults.emplace_back("PALPATE_TEST_FAIL_WITH", std::to_string(error));
      if (!met(faults, std::string(std::strerror(error)) + " at call " + std::to_string(call)))
        return;
      if (HasFailure()) return;
    }
  }
};

TEST_P(FileFaults, OfADiskWithErrors) { fail_each(EIO); }
TEST_P(FileFaults, OfAFullDisk) { fail_each(ENOSPC, {{"PALPATE_TEST_STAYS", "1"}}); }
TEST_P(FileFaults, InterruptedCalls) { fail_each(EINTR); }

TEST_P(FileFaults, ShortReadsAndWritesChangeNothing) {
  const Ended ended = hindered({{"PALPATE_TEST_MOST_BYTES", "7"}});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(is_new());
}

TEST_P(FileFaults, ASlowDiskChangesNothing) {
  const Ended ended = hindered({{"PALPATE_TEST_WAIT_MS", "1"}});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(is_new());
}

TEST_P(FileFaults, AClockThatJumpsChangesNothing) {
  const Ended ended = hindered({{"PALPATE_TEST_CLOCK_JUMP", "100000000"}});
  EXPECT_EQ(ended.code, 0) << ended.err;
  EXPECT_TRUE(is_new());
}

TEST_P(FileFaults, OfMemory) {
  std::mt19937 random(22);
  const int tries = every() ? 200 : 4;
  for (int i = 0; i < tries && !HasFailure(); ++i) {
    // Of ten to a hundred thousand allocations one, of each size of number as often.
    const double exponent = 1.0 + 4.0 * static_cast<double>(random() % 1000) / 1000.0;
    const auto at = static_cast<long>(std::pow(10.0, exponent));
    met({{"PALPATE_TEST_FAIL_MEMORY", std::to_string(at)}}, "allocation " + std::to_string(at));
  }
}

INSTANTIATE_TEST_SUITE_P(Verbs, FileFaults, testing::ValuesIn(result_verbs()),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace palpate::test
