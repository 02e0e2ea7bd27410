// SIGKILL before every system call that changes a file, in verbs that replace a result: the old
// result or the new one stands, whole, and the same call then succeeds.
#include <gtest/gtest.h>

#include <map>

#include "program.h"

namespace palpate::test {
namespace {

using Words = std::vector<std::string>;
using Content = std::map<std::string, std::string>;

// The files of a result, without the times in run.json and what is no part of it.
Content content(const fs::path& folder) {
  Content files;
  if (!fs::exists(folder)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(entry.path(), folder).string();
    const bool other = name == "run.json" || name == "contents.sha256" ||
                       name.ends_with(".replaced") || name.find(".part") != std::string::npos;
    if (entry.is_regular_file() && !other) files[name] = read_file(entry.path());
  }
  return files;
}

struct Verb {
  const char* name;
  Words call;           // makes the result; the word SETTING is replaced
  const char* result;   // its folder
  const char* old_one;  // the setting of the old result
  const char* new_one;
};
void PrintTo(const Verb& verb, std::ostream* out) { *out << verb.name; }

class Kills : public testing::TestWithParam<Verb> {
 protected:
  void SetUp() override {
    write_file(folder_ / "s.toml",
               "[tissue]\nshape = { kind = \"half_space\" }\nyoung_modulus = \"20 kPa\"\n"
               "[finger]\nmaterial = \"rigid\"\nradius = \"5 mm\"\n"
               "[[step]]\nkind = \"indent\"\nto = \"0.4 mm\"\n"
               "[output]\ninterval = \"50 ms\"\nfigures = false\npressure_maps = false\n");
    write_file(folder_ / "data.csv",
               "travel_mm,force_N\n0.1,0.0040\n0.2,0.0113\n0.3,0.0208\n0.4,0.0320\n");
  }
  [[nodiscard]] Ended run(const char* setting, int kill_before = 0) const {
    Words words;
    for (const std::string& word : GetParam().call)
      words.push_back(word == "SETTING" ? setting : word);
    Invocation call{.arguments = words, .folder = folder_.path()};
    if (kill_before > 0)
      call.set = {{"LD_PRELOAD", PALPATE_FILE_FAULTS},
                  {"PALPATE_TEST_KILL_BEFORE", std::to_string(kill_before)}};
    return run_program(call);
  }
  TemporaryFolder folder_;
};

TEST_P(Kills, LeaveTheOldResultOrTheNewOne) {
  const fs::path place = folder_ / GetParam().result;
  fs::create_directories(place);
  const Ended first = run(GetParam().new_one);
  ASSERT_EQ(first.code, 0) << first.err;
  const Content after = content(place);
  fs::remove_all(place);
  fs::create_directories(place);
  ASSERT_EQ(run(GetParam().old_one).code, 0);
  const Content before = content(place);
  ASSERT_NE(before, after);
  ASSERT_FALSE(before.empty());
  int kills = 0;
  for (int call = 1; call < 1000; ++call) {
    const Ended ended = run(GetParam().new_one, call);
    if (ended.signal != SIGKILL) {
      EXPECT_EQ(ended.code, 0) << ended.err;
      break;
    }
    ++kills;
    const Content now = content(place);
    const bool whole = now == before || now == after;
    // Of two files side by side one may be new: such a pair is refused, and nothing of it is lost.
    const bool pair = std::string(GetParam().name) == "mesh" && !whole;
    if (pair) {
      const Ended refused = palpate(folder_.path(), {"mesh", "m/m.ele", "--unit", "m"});
      EXPECT_EQ(refused.code, 2) << refused.out;
      EXPECT_TRUE(says(refused, "belongs to other nodes")) << refused.err;
      EXPECT_EQ(read_file(place / "m.node.replaced"), before.at("m.node"));
    }
    EXPECT_TRUE(whole || pair) << "before call " << call;
    if (now == before) continue;
    ASSERT_EQ(run(GetParam().old_one).code, 0) << "after the kill before call " << call;
    EXPECT_EQ(content(place), before);
  }
  EXPECT_GT(kills, 4) << "calls that change files";
  EXPECT_EQ(content(place), after);
}

Words replacing(Words words) {
  for (const char* word : {"--set", "SETTING", "--force", "--quiet"}) words.emplace_back(word);
  return words;
}

const char* const box = "tissue.shape={kind=\"cuboid\",size=[\"20 mm\",\"20 mm\",\"10 mm\"]}";

INSTANTIATE_TEST_SUITE_P(
    Verbs, Kills,
    testing::Values(
        Verb{"run", replacing({"run", "s.toml"}), "out/s", "step.1.to=0.3 mm", "step.1.to=0.4 mm"},
        Verb{"identify",
             replacing({"identify", "data.csv", "s.toml", "--x", "travel_mm", "--y", "force_N",
                        "--unknown", "tissue.young_modulus=2 kPa..60 kPa"}),
             "out/s_identified", "tissue.poisson_ratio=0.3", "tissue.poisson_ratio=0.45"},
        Verb{"mesh",
             replacing({"mesh", "s.toml", "--set", box, "--set", "solver.model=mass_spring",
                        "--out", "m/m.node"}),
             "m", "tissue.mesh={kind=\"kuhn\",cells=[2,2,2]}",
             "tissue.mesh={kind=\"kuhn\",cells=[2,2,3]}"}),
    [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace palpate::test
