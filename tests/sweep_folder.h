// A folder of its own for plans of sweeps, and plans that cost little to run.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "base/error.h"
#include "study/sweep_merge.h"
#include "study/sweep_plan.h"
#include "study/sweep_run.h"
#include "temporary_folder.h"

namespace palpate::study {

namespace fs = std::filesystem;

// 6 cases of nothing but formulas.
inline const std::string formulas =
    "[tissue]\nshape = { kind = \"half_space\" }\n"
    "[[step]]\nkind = \"indent\"\nto = \"0.2 mm\"\n[output]\ninterval = \"5 ms\"\n"
    "[sweep]\n\"tissue.young_modulus\" = [\"10 kPa\", \"20 kPa\", \"0.1 MPa\"]\n"
    "\"tissue.poisson_ratio\" = [0.3, 0.45]\n";

class SweepFolder : public testing::Test {
 protected:
  static std::string read(const fs::path& path) {
    std::ifstream stream(path, std::ios::binary);
    EXPECT_TRUE(stream.good()) << path;
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  static void write(const fs::path& path, const std::string& text) {
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
  }

  // What an error says, without the test's own folder.
  template <class Work>
  [[nodiscard]] std::string refusal(const Work& work) const {
    try {
      work();
      return "accepted";
    } catch (const std::exception& error) {
      std::string text = error.what();
      const std::string folder = root_.string() + "/";
      for (std::size_t at = text.find(folder); at != std::string::npos; at = text.find(folder))
        text.erase(at, folder.size());
      return text;
    }
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
    return read(fs::path(merge_sweep(plan, results, count_results(plan, results), Replace::any)) /
                name);
  }

  test::TemporaryFolder folder_;
  fs::path root_ = folder_.path();
};

}  // namespace palpate::study
