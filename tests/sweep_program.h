// Sweeps by the program itself: plans, runs that are stopped, what is merged.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "program.h"

namespace palpate::test {

using Words = std::vector<std::string>;

// Nothing but formulas: a case takes no time.
inline const std::string quick_sweep =
    "[tissue]\nshape = { kind = \"half_space\" }\n"
    "[[step]]\nkind = \"indent\"\nto = \"0.2 mm\"\n[output]\ninterval = \"5 ms\"\n"
    "[sweep]\n\"tissue.young_modulus\" = [\"10 kPa\", \"20 kPa\", \"0.1 MPa\"]\n"
    "\"tissue.poisson_ratio\" = [0.3, 0.45]\n";

// A mesh that takes a while: `count` cases that press to 0.01 mm and a little more, each with 2000
// rows, which are 50 ms of work or so.
inline std::string slow_sweep(int count) {
  std::string values;
  for (int i = 0; i < count; ++i)
    values += (i > 0 ? ", \"" : "\"") + std::to_string(0.01 + i * 1e-5) + " mm\"";
  return "[tissue]\nmesh = { kind = \"kuhn\", cells = [2, 2, 2] }\n"
         "[solver]\nmodel = \"mass_spring\"\n"
         "[[step]]\nkind = \"indent\"\nto = \"0.005 mm\"\nrate = \"0.0005 mm/s\"\n"
         "[output]\ninterval = \"10 ms\"\nfits = false\npressure_maps = false\n"
         "[sweep]\n\"step.1.to\" = [" +
         values + "]\n";
}

class SweepProgram : public testing::Test {
 protected:
  [[nodiscard]] Invocation call(const Words& words) const {
    Words arguments{"sweep"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    return {.arguments = arguments, .folder = folder_.path()};
  }
  [[nodiscard]] Ended sweep(const Words& words) const { return run_program(call(words)); }

  // out/s_sweep
  void plan(const std::string& text, const Words& more = {}) const {
    write_file(folder_ / "s.toml", text);
    Words words{"plan", "s.toml"};
    words.insert(words.end(), more.begin(), more.end());
    const Ended ended = sweep(words);
    ASSERT_EQ(ended.code, 0) << ended.err;
  }
  // The merged table of what there is.
  [[nodiscard]] std::string merged() const {
    (void)sweep({"merge", "out/s_sweep", "--force"});
    return read_file(folder_ / "out/s_sweep/merged/results.csv");
  }
  // What a run without trouble gives, by a plan of the same text elsewhere.
  [[nodiscard]] std::string expected(const std::string& text) const {
    write_file(folder_ / "calm/s.toml", text);
    const fs::path place = folder_ / "calm";
    for (const Words& words : {Words{"sweep", "plan", "s.toml"},
                               {"sweep", "run", "out/s_sweep"},
                               {"sweep", "merge", "out/s_sweep"}}) {
      const Ended ended = palpate(place, words);
      EXPECT_EQ(ended.code, 0) << ended.err;
    }
    return read_file(place / "out/s_sweep/merged/results.csv");
  }
  // Rows that are on the disk, whole lines of all files but their first.
  [[nodiscard]] std::size_t rows() const {
    std::size_t count = 0;
    if (!fs::exists(folder_ / "out/s_sweep/results")) return 0;
    for (const auto& entry : fs::directory_iterator(folder_ / "out/s_sweep/results")) {
      const std::string text = read_file(entry.path());
      const auto lines = static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
      count += lines > 0 ? lines - 1 : 0;
    }
    return count;
  }
  // Of all those files.
  [[nodiscard]] std::uintmax_t bytes() const {
    std::uintmax_t sum = 0;
    if (!fs::exists(folder_ / "out/s_sweep/results")) return 0;
    for (const auto& entry : fs::directory_iterator(folder_ / "out/s_sweep/results"))
      sum += entry.file_size();
    return sum;
  }

  TemporaryFolder folder_;
};

}  // namespace palpate::test
