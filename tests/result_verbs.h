// Verbs that replace a result, for tests that hinder them: what stands at its place is whole.
#pragma once

#include <map>

#include "base/files.h"
#include "base/text.h"
#include "program.h"

namespace palpate::test {

using Words = std::vector<std::string>;
using Content = std::map<std::string, std::string>;

// The files of a result, without the times in run.json and what is no part of it.
inline Content content(const fs::path& folder) {
  Content files;
  if (!fs::exists(folder)) return files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(entry.path(), folder).string();
    // An old file that could not be read is kept as `NAME.before`: it might be somebody's.
    const bool other = name == "run.json" || name == "contents.sha256" ||
                       name.ends_with(".replaced") || name.find(".before") != std::string::npos ||
                       name.find(".part") != std::string::npos ||
                       name.find(".palpate-part") != std::string::npos;
    if (entry.is_regular_file() && !other) files[name] = read_file(entry.path());
  }
  return files;
}

// Whether every file that a result lists is there with the content whose hash it lists.
inline bool is_whole(const fs::path& folder) {
  std::size_t good = 0;
  std::size_t listed = 0;
  for (const std::string& line : split(read_text((folder / "contents.sha256").string()), '\n')) {
    if (line.empty() || line.starts_with('#')) continue;
    ++listed;
    const std::string name = line.substr(std::min<std::size_t>(66, line.size()));
    good += fs::exists(folder / name) && line.starts_with(sha256(read_file(folder / name))) ? 1 : 0;
  }
  return listed > 1 && good == listed;
}

struct ResultVerb {
  const char* name;
  Words call;                       // makes the result; the word SETTING is replaced
  const char* result;               // its folder
  const char* old_one;              // the setting of the old result
  const char* new_one;              // may be the same where the result takes no setting
  int stride;                       // every how-manyth call is hindered in a short test
  std::vector<Words> prepare = {};  // calls beforehand
  bool varies = false;              // times are among the results
};
inline void PrintTo(const ResultVerb& verb, std::ostream* out) { *out << verb.name; }

class Hindered : public testing::TestWithParam<ResultVerb> {
 protected:
  void SetUp() override {
    write_file(folder_ / "s.toml",
               "[tissue]\nshape = { kind = \"half_space\" }\nyoung_modulus = \"20 kPa\"\n"
               "[finger]\nmaterial = \"rigid\"\nradius = \"5 mm\"\n"
               "[[step]]\nkind = \"indent\"\nto = \"0.4 mm\"\n"
               "[output]\ninterval = \"50 ms\"\nfigures = false\npressure_maps = false\n");
    write_file(folder_ / "sweep.toml", read_file(folder_ / "s.toml") +
                                           "[sweep]\n\"tissue.young_modulus\" = [\"10 kPa\", "
                                           "\"20 kPa\", \"30 kPa\"]\n");
    write_file(folder_ / "block.toml",
               "[tissue]\nmaterial = \"skin\"\n"
               "shape = { kind = \"cuboid\", size = [\"30 mm\", \"30 mm\", \"20 mm\"] }\n"
               "mesh = { kind = \"kuhn\", cells = [1, 1, 1] }\n"
               "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n[output]\nfigures = false\n");
    write_file(folder_ / "data.csv",
               "travel_mm,force_N\n0.1,0.0040\n0.2,0.0113\n0.3,0.0208\n0.4,0.0320\n");
    for (const Words& words : GetParam().prepare) {
      const Ended ended = palpate(folder_.path(), words);
      ASSERT_EQ(ended.code, 0) << ended.err;
    }
    fs::create_directories(place());
    const Ended first = run(GetParam().new_one);
    ASSERT_EQ(first.code, 0) << first.err;
    after_ = content(place());
    fs::remove_all(place());
    restore();
    ASSERT_FALSE(before_.empty());
    if (std::string(GetParam().old_one) != GetParam().new_one) {
      ASSERT_NE(before_, after_);
    }
  }

  [[nodiscard]] fs::path place() const { return folder_ / GetParam().result; }
  [[nodiscard]] Ended run(const char* setting,
                          const std::vector<std::pair<std::string, std::string>>& set = {}) const {
    Words words;
    for (const std::string& word : GetParam().call)
      words.push_back(word == "SETTING" ? setting : word);
    return run_program({.arguments = words, .folder = folder_.path(), .set = set});
  }
  // Runs the call with the new setting and faults.
  [[nodiscard]] Ended hindered(std::vector<std::pair<std::string, std::string>> faults) const {
    faults.emplace_back("LD_PRELOAD", PALPATE_FILE_FAULTS);
    faults.emplace_back("ASAN_OPTIONS", "verify_asan_link_order=0");
    return run(GetParam().new_one, faults);
  }
  // Puts the old result in place, whatever stands there or was left beside it.
  void restore() {
    for (const std::string& name : names_in(place().parent_path()))
      if (name.starts_with(place().filename().string() + "."))
        fs::remove_all(place().parent_path() / name);
    fs::remove_all(place());
    if (!before_.empty()) {
      fs::copy(folder_ / "saved", place(), fs::copy_options::recursive);
      return;
    }
    fs::create_directories(place());
    const Ended ended = run(GetParam().old_one);
    ASSERT_EQ(ended.code, 0) << ended.err;
    before_ = content(place());
    fs::copy(place(), folder_ / "saved", fs::copy_options::recursive);
  }
  // What stands there is the old result or a new one.
  [[nodiscard]] bool is_old() const { return content(place()) == before_; }
  [[nodiscard]] bool is_new() const {
    return GetParam().varies ? is_whole(place()) : content(place()) == after_;
  }
  // The names of files that are not those of the new result.
  [[nodiscard]] std::string others() const {
    std::string names;
    const Content now = content(place());
    for (const auto& [name, bytes] : now)
      if (!after_.contains(name) || after_.at(name) != bytes) names += " " + name;
    for (const auto& [name, bytes] : after_)
      if (!now.contains(name)) names += " no " + name;
    return names;
  }
  // Whether every call of a verb is hindered in turn, in place of some.
  [[nodiscard]] static bool every() { return std::getenv("PALPATE_EVERY_FAULT") != nullptr; }

  TemporaryFolder folder_;
  Content before_;
  Content after_;
};

inline Words replacing(Words words) {
  for (const char* word : {"--set", "SETTING", "--force", "--quiet"}) words.emplace_back(word);
  return words;
}

inline std::vector<ResultVerb> result_verbs() {
  const char* const box = "tissue.shape={kind=\"cuboid\",size=[\"20 mm\",\"20 mm\",\"10 mm\"]}";
  const Words plan{"sweep", "plan", "sweep.toml"};
  return {
      {"run", replacing({"run", "s.toml"}), "out/s", "step.1.to=0.3 mm", "step.1.to=0.4 mm", 1},
      {"identify",
       replacing({"identify", "data.csv", "s.toml", "--x", "travel_mm", "--y", "force_N",
                  "--unknown", "tissue.young_modulus=2 kPa..60 kPa"}),
       "out/s_identified", "tissue.poisson_ratio=0.3", "tissue.poisson_ratio=0.45", 3},
      {"convert",
       replacing({"convert", "s.toml", "--set", box, "--set", "solver.model=mass_spring", "--out",
                  "m/m.node"}),
       "m", "tissue.mesh={kind=\"kuhn\",cells=[2,2,2]}",
       "tissue.mesh={kind=\"kuhn\",cells=[2,2,3]}", 1},
      {"chart",
       replacing({"chart", "s.toml", "--repeats", "1"}),
       "out/s_chart",
       "step.1.to=0.3 mm",
       "step.1.to=0.4 mm",
       8,
       {},
       true},
      {"stability", replacing({"stability", "block.toml"}), "out/block_stability",
       "tissue.young_modulus=20 kPa", "tissue.young_modulus=30 kPa", 16},
      {"merge",
       {"sweep", "merge", "out/sweep_sweep", "--force", "--quiet"},
       "out/sweep_sweep/merged",
       "",
       "",
       1,
       {plan, {"sweep", "run", "out/sweep_sweep"}}},
      {"convert_results",
       {"convert", "SETTING", "--to", "csv-si", "--out", "e", "--force", "--quiet"},
       "e",
       "one/s",
       "two/s",
       1,
       {{"run", "s.toml", "--out", "one"},
        {"run", "s.toml", "--out", "two", "--set", "step.1.to=0.3 mm"}}},
      {"fit",
       {"fit", "data.csv", "data.csv", "--model", "hertz", "--radius", "5 mm", "--poisson",
        "SETTING", "--x", "travel_mm", "--y", "force_N", "--out", "f", "--force", "--quiet"},
       "f",
       "0.5",
       "0.45",
       1,
       {},
       true},  // a curve that cannot be read is a row with the reason
  };
}

}  // namespace palpate::test
