// The echo reads back to the same run: the same echo, and every value with the same bits.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>
#include <unistd.h>

#include <bit>
#include <cstdint>
#include <filesystem>

#include "base/files.h"
#include "scenario/resolved.h"
#include "scenario_text.h"

namespace palpate::scenario {
namespace {

namespace fs = std::filesystem;

// Every value that counts, by its path and its bits; made from the fields, so that none is left
// out.
class Dump final : public FieldVisitor {
 public:
  std::string dumped;

  void real(const Key& key, std::optional<double>& value, const Real&) override {
    put(key, value ? bits(*value) : "empty");
  }
  void whole(const Key& key, std::optional<int>& value, const Whole&) override {
    put(key, value ? std::to_string(*value) : "empty");
  }
  void either(const Key& key, Target& target, const Unit&, const Unit&, const Range&) override {
    put(key, bits(target.value) + (target.second ? " second" : " first"));
  }
  void text(const Key& key, std::string& value) override { put(key, value); }
  void flag(const Key& key, bool& value) override { put(key, value ? "true" : "false"); }
  void quantities(const Key& key, std::span<double> si, const Unit&, const Range&) override {
    for (const double value : si) put(key, bits(value));
  }
  void counts(const Key& key, std::span<int> values, const Range&) override {
    for (const int value : values) put(key, std::to_string(value));
  }
  void quantity_list(const Key& key, std::vector<double>& si, const Unit&, const Range&) override {
    for (const double value : si) put(key, bits(value));
  }
  void numbers_by_name(const Key& key, std::map<std::string, double>& values,
                       const Range&) override {
    for (const auto& [name, value] : values) put(key, name + " " + bits(value));
  }
  void choice_of(const Key& key, int& index, std::span<const Word>) override {
    put(key, std::to_string(index));
  }
  void table(const Key& key, const Fields& fields) override {
    if (!key.use.used) return;
    put(key, "{");
    fields(*this);
  }
  void tables(const Key& key, int size, const std::function<void(int)>&,
              const std::function<void(FieldVisitor&, int)>& fields) override {
    for (int i = 0; i < size; ++i) {
      put(key, "[");
      fields(*this, i);
    }
  }
  void kind(int chosen, std::span<const Word>, const std::function<Fields(int)>& choose) override {
    dumped += "kind " + std::to_string(chosen) + "\n";
    choose(chosen)(*this);
  }

 private:
  static std::string bits(double value) {
    return std::to_string(std::bit_cast<std::uint64_t>(value));
  }
  void put(const Key& key, const std::string& value) {
    if (key.use.used) dumped += std::string(key.name) + " " + value + "\n";
  }
};

std::string values_of(const Family& family) {
  std::string all;
  for (const Case& one : family.cases) {
    Scenario scenario = filled(one);
    Dump dump;
    fields(dump, scenario);
    all += "case " + one.name + "\n" + dump.dumped;
  }
  return all;
}

// `path` names both, so that a family without a sweep has the same case name.
void expect_reads_back(const std::string& text, const std::string& path = "press.toml") {
  SCOPED_TRACE(text);
  try {
    const Family family = parse(text, path, {});
    const std::string written = echo(family);
    SCOPED_TRACE(written);
    const Family again = parse(written, path, {});
    EXPECT_EQ(echo(again), written);
    EXPECT_EQ(values_of(again), values_of(family));
  } catch (const InputError& error) {
    ADD_FAILURE() << error.what();
  }
}

const std::string source = PALPATE_SOURCE_DIR;
const std::string short_creep = "[[step]]\nkind = \"creep\"\nload_time = \"0.3 s\"\n";

TEST(Echo, OfEveryScenarioOfOursReadsBack) {
  int found = 0;
  for (const auto& entry : fs::directory_iterator(source + "/scenarios"))
    if (entry.path().extension() == ".toml") {
      expect_reads_back(read_text(entry.path().string()), entry.path().string());
      ++found;
    }
  EXPECT_GE(found, 4);
}

// Collects the words of every choice and kind, so that a new one brings its test along.
std::vector<std::pair<std::string, std::string>> all_choices(const std::string& manual_text) {
  std::vector<std::pair<std::string, std::string>> choices;
  std::string table;
  std::size_t from = 0;
  while (from < manual_text.size()) {
    const std::size_t end = std::min(manual_text.find('\n', from), manual_text.size());
    const std::string line = manual_text.substr(from, end - from);
    from = end + 1;
    if (line.starts_with("## `")) {
      const std::size_t close = line.find('`', 4);
      table = line.substr(4, close - 4);
      std::erase_if(table, [](char c) { return c == '[' || c == ']'; });
      const std::size_t kind = line.find("kind = \"");
      if (kind != std::string::npos)
        choices.emplace_back(table + ".kind",
                             line.substr(kind + 8, line.find('"', kind + 8) - kind - 8));
    }
    if (!line.starts_with("| `")) continue;
    const std::string key = line.substr(3, line.find('`', 3) - 3);
    for (std::size_t at = line.find("`\""); at != std::string::npos;
         at = line.find("`\"", at + 2)) {
      const std::size_t close = line.find("\"`", at);
      choices.emplace_back(table + "." + key, line.substr(at + 2, close - at - 2));
    }
  }
  return choices;
}

TEST(Echo, OfEveryChoiceReadsBack) {
  const auto choices = all_choices(manual());
  EXPECT_GT(choices.size(), 30U);
  int read = 0;
  for (const auto& [key, word] : choices) {
    if (key.starts_with("step.") || word == "file") continue;  // below
    for (const std::string& steps : {press, short_creep}) {
      const std::string setting = key + "=\"" + word + "\"";
      Family family;
      try {
        family = parse(steps, "press.toml", {setting});
      } catch (const InputError&) {
        continue;  // this choice does not go with these steps
      }
      SCOPED_TRACE(setting);
      const std::string written = echo(family);
      const Family again = parse(written, "press.toml", {});
      EXPECT_EQ(echo(again), written);
      EXPECT_EQ(values_of(again), values_of(family));
      ++read;
    }
  }
  EXPECT_GT(read, 40);
}

TEST(Echo, OfEveryStepReadsBack) {
  expect_reads_back(press +
                    "[[step]]\nkind = \"hold\"\ntime = \"0.1 s\"\n[[step]]\nkind = "
                    "\"retract\"\nto = \"-0.7 mm\"\n[[step]]\nto = \"1.1 N\"\n");
  expect_reads_back(short_creep + "[[step]]\nkind = \"relax\"\nstrain = 0.1\n");
}

TEST(Echo, OfAListOfDepthsReadsBack) {
  expect_reads_back(press +
                    "[output]\nforce_at = [\"1 mm\", \"0.7 mm\", \"0.33333333333333331 mm\"]\n");
}

TEST(Echo, OfAwkwardTextsReadsBack) {
  expect_reads_back("title = \"a \\\"b\\\" \\\\ \\t \\r\\n \\u0001 \\u00b5 #\"\n" + press);
  expect_reads_back(
      press + "[output]\ndisplay_scale = { \"a b\" = 0.1 }\n[sweep]\n\"title\" = [\"a b\"]\n");
}

TEST(Echo, OfASweptChoiceKeepsWhatTheOtherCasesNeed) {
  // Written out, the first case's viscosity would misplace the second's keys, and a mesh that the
  // first does not read would be lost to the second.
  expect_reads_back(press + "[sweep]\n\"tissue.viscosity\" = [\"kelvin_voigt\", \"nodal_drag\"]\n");
  expect_reads_back(press +
                    "[tissue]\nmesh = { kind = \"kuhn\", cells = [2, 2, 2] }\n[sweep]\n"
                    "\"solver.model\" = [\"hertz\", \"mass_spring\"]\n");
  expect_reads_back(press + "[sweep]\n\"solver.model\" = [\"mass_spring\", \"hertz\"]\n");
  expect_reads_back(press + "[sweep]\n\"tissue.mesh.kind\" = [\"kuhn\", \"tetgen\"]\n");
  expect_reads_back(press +
                    "[sweep]\n\"tissue.mesh\" = [{ kind = \"kuhn\" }, { kind = \"tetgen\" }]\n");
}

TEST(Echo, OfASweptMaterialLeavesItsPropertiesToTheCases) {
  expect_reads_back(press +
                    "[sweep]\n\"tissue.material\" = [\"skin\", \"bone\"]\n"
                    "\"finger.radius\" = [\"11 mm\", \"0.7 cm\"]\n");
  expect_reads_back(press + "[sweep]\n\"finger.material\" = [\"finger\", \"rigid\"]\n");
}

TEST(Echo, OfEveryDesignReadsBack) {
  const std::string ranges =
      "\"tissue.young_modulus\" = { from = \"10 kPa\", to = \"90 kPa\", scale = \"log\" }\n"
      "\"contact.friction\" = { from = 0, to = 1 }\n\"tissue.material\" = [\"skin\", \"bone\"]\n";
  for (const char* design :
       {"lhs\"\nsamples = 5\nseed = 77", "sobol\"\nsamples = 5", "saltelli\"\nsamples = 2"})
    expect_reads_back(press + "[sweep]\ndesign = \"" + design + "\n" + ranges);
  expect_reads_back(
      press +
      "[sweep]\n\"tissue.young_modulus\" = { points = 4, scale = \"log\", from = \"10 "
      "kPa\", to = \"90 kPa\" }\nfinger.radius = [\"8 mm\", \"9 mm\"]\n");
  expect_reads_back(press +
                    "[sweep]\ndesign = \"list\"\n\"contact.friction\" = [0, 0.5]\n"
                    "\"finger.radius\" = [\"8 mm\", \"9 mm\"]\n");
  // Rows keep their place among the other factors, also at the front.
  expect_reads_back(
      press +
      "[sweep]\nrows = [{ \"tissue.material\" = [\"skin\", \"bone\"], title = [\"a\", "
      "\"b\"] }, { \"contact.friction\" = [0, 0.1] }]\n\"finger.radius\" = [\"8 mm\", "
      "\"9 mm\"]\n");
  expect_reads_back(press +
                    "[sweep]\n\"finger.radius\" = [\"8 mm\", \"9 mm\"]\n[[sweep.rows]]\n"
                    "\"tissue.material\" = [\"skin\", \"bone\"]\ntitle = [\"a\", \"b\"]\n");
}

TEST(Echo, RefersToCopiesByTheirBareName) {
  const fs::path folder =
      fs::path(testing::TempDir()) / ("palpate_echo_" + std::to_string(::getpid()));
  fs::create_directories(folder / "data");
  const std::string gel =
      "[gel]\ndensity = { value = \"1000 kg/m^3\", source = \"s\" }\nyoung_modulus = { value = "
      "\"12.3 kPa\", source = \"s\" }\npoisson_ratio = { value = 0.45, source = \"s\" }\n";
  write_atomically((folder / "data/my.toml").string(), gel);
  write_atomically((folder / "data/box.node").string(), "1");
  write_atomically((folder / "data/box.ele").string(), "2");
  const std::string path = (folder / "press.toml").string();
  const Family family =
      parse(press +
                "[tissue]\nviscosity = \"none\"\nmesh = { file = \"data/box.node\", unit = "
                "\"mm\" }\n[sweep]\n\"tissue.material\" = [\"data/my.toml#gel\", \"skin\"]\n",
            path, {});
  const std::string written = echo(family);
  EXPECT_EQ(written.find("data/"), std::string::npos) << written;
  EXPECT_NE(written.find("\"my.toml#gel\""), std::string::npos) << written;
  EXPECT_NE(written.find("\"box.node\""), std::string::npos) << written;

  fs::create_directories(folder / "result");  // as a result folder holds it
  for (std::size_t i = 1; i < family.inputs.size(); ++i)
    write_atomically((folder / "result" / family.inputs[i].name).string(),
                     family.inputs[i].content);
  const Family again = parse(written, (folder / "result/press.toml").string(), {});
  EXPECT_EQ(echo(again), written);
  ASSERT_EQ(again.cases.size(), 2U);
  EXPECT_EQ(again.cases[0].name, "my.toml#gel");
  EXPECT_EQ(filled(again.cases[0]).tissue.young_modulus, 12300.0);
  EXPECT_EQ(filled(again.cases[1]).tissue.young_modulus, 72400.0);
  fs::remove_all(folder);
}

TEST(Echo, OfATableOfCasesReadsBack) {
  const fs::path folder =
      fs::path(testing::TempDir()) / ("palpate_echo_csv_" + std::to_string(::getpid()));
  fs::create_directories(folder / "data");
  const std::string table = "tissue.young_modulus [kPa],contact.friction\n10,0\n20,0.5\n";
  write_atomically((folder / "data/cases.csv").string(), table);
  const Family family = parse(press + "[sweep]\ndesign = \"csv\"\nfile = \"data/cases.csv\"\n",
                              (folder / "press.toml").string(), {});
  const std::string written = echo(family);
  EXPECT_NE(written.find("file = \"cases.csv\"\n"), std::string::npos) << written;
  ASSERT_EQ(family.inputs.size(), 2U);
  fs::create_directories(folder / "result");
  write_atomically((folder / "result" / family.inputs[1].name).string(), family.inputs[1].content);
  const Family again = parse(written, (folder / "result/press.toml").string(), {});
  EXPECT_EQ(echo(again), written);
  EXPECT_EQ(values_of(again), values_of(family));
  fs::remove_all(folder);
}

RC_GTEST_PROP(Echo, QuantitiesKeepTheirBits, ()) {
  const auto any = [](double low, double high) {
    const auto part = *rc::gen::inRange(0, 1 << 30);
    return low + (high - low) * static_cast<double>(part) / static_cast<double>(1 << 30);
  };
  Family family = parse(press, "press.toml", {});
  Scenario& scenario = family.cases[0].scenario;
  scenario.tissue.young_modulus = any(1.0, 1e6);
  scenario.tissue.poisson_ratio = any(-0.9, 0.49);
  scenario.tissue.density = any(1.0, 2000.0);
  scenario.finger.radius = any(0.005, 0.02);
  scenario.tissue.retardation_time = any(1e-6, 1.0);
  std::get<Indent>(scenario.steps[0]).rate = any(1e-4, 1.0);
  const Family again = parse(echo(family), "press.toml", {});
  RC_ASSERT(values_of(again) == values_of(family));
}

}  // namespace
}  // namespace palpate::scenario
