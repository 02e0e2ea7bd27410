// A folder of its own for plans of sweeps, and plans that cost little to run.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <string>

#include "refusal.h"
#include "sweep/merge.h"
#include "sweep/plan.h"
#include "sweep/run.h"
#include "temporary_folder.h"

namespace palpate::sweep {

namespace fs = std::filesystem;

// 6 cases of nothing but formulas.
inline const std::string formulas =
    "[tissue]\nshape = { kind = \"half_space\" }\n"
    "[[step]]\nkind = \"indent\"\nto = \"0.2 mm\"\n[output]\ninterval = \"5 ms\"\n"
    "[sweep]\n\"tissue.young_modulus\" = [\"10 kPa\", \"20 kPa\", \"0.1 MPa\"]\n"
    "\"tissue.poisson_ratio\" = [0.3, 0.45]\n";

class SweepFolder : public testing::Test {
 protected:
  static std::string read(const fs::path& path) { return test::read_file(path); }
  static void write(const fs::path& path, const std::string& text) { test::write_file(path, text); }

  // What an error says, without the test's own folder.
  template <class Work>
  [[nodiscard]] std::string refusal(const Work& work) const {
    std::string text = test::refusal<std::exception>(work);
    const std::string folder = root_.string() + "/";
    for (std::size_t at = text.find(folder); at != std::string::npos; at = text.find(folder))
      text.erase(at, folder.size());
    return text;
  }

  [[nodiscard]] SweepOrder order(const std::string& text) const {
    write(root_ / "s.toml", text);
    return {.scenario = (root_ / "s.toml").string(),
            .out = (root_ / "out").string(),
            .program = "this one"};
  }
  // The plan of a text, as it is read back.
  [[nodiscard]] SweepPlan plan(const std::string& text) const {
    return read_plan(plan_sweep(order(text)).folder, "this one");
  }

  static SweepEnd run(const SweepPlan& plan, const SweepTask& task = {}) {
    const std::atomic<bool> never = false;
    return run_sweep(plan, task, never, [](const SweepProgress&) {});
  }
  // results.csv of what there is.
  static std::string merged(const SweepPlan& plan, const char* name = "results.csv") {
    const SweepResults results(plan);
    WholeFolder folder(plan.folder + "/merged", "merged sweep", Replace::any);
    folder.open();
    merge_sweep(plan, results, count_results(plan, results), folder);
    EXPECT_TRUE(folder.put(WholeFolder::State::complete).empty());
    return read(fs::path(folder.path()) / name);
  }

  test::TemporaryFolder folder_;
  fs::path root_ = folder_.path();
};

}  // namespace palpate::sweep
