// How often a chart times each variant.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <set>

#include "chart/chart.h"
#include "chart/journal.h"
#include "scenario_text.h"

namespace palpate::chart {
namespace {

struct Measured : testing::Test {
  std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("palpate-measure-" + std::to_string(::getpid()));
  ~Measured() override { std::filesystem::remove_all(folder_); }

  std::vector<Measurement> rows(const ChartOptions& options) {
    const Asked asked =
        read_for_chart("creep.toml",
                       scenario::creep +
                           "load_time = \"0.1 s\"\nrecovery_time = \"0.1 s\"\n[tissue.mesh]\nkind "
                           "= \"mirrored\"\ncells = [2, 2, 2]\n",
                       {});
    Journal journal(folder_.string(), "me", Replace::any);
    return measure(asked, options, journal, [](const ChartProgress&) {}).front().rows;
  }
};

TEST_F(Measured, TimingsAfterTheFirstEndWithTheirTime) {
  std::size_t measured = 0;
  for (const Measurement& one : rows({.repeats = 3, .again = -1.0, .longest = 1e3})) {
    if (one.status != Status::measured) continue;
    ++measured;
    EXPECT_EQ(one.timings.size(), 1U) << one.variant.name;
  }
  EXPECT_GT(measured, 5U);
  std::set<std::size_t> timings;
  for (const Measurement& one : rows({.repeats = 2, .budget = 1e3, .again = 1e3, .longest = 1e3}))
    if (one.status == Status::measured) timings.insert(one.timings.size());
  EXPECT_EQ(timings, std::set<std::size_t>{2});
}

}  // namespace
}  // namespace palpate::chart
