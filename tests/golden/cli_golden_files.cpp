// Did anything change that was not meant? Every golden folder is run and compared.
#include <gtest/gtest.h>

#include "base/document.h"
#include "base/text.h"
#include "compare/compare.h"
#include "program.h"
#include "record/csv.h"

namespace palpate::test {
namespace {

// Folders below golden/ but for the meshes that they share.
std::vector<std::string> golden_folders() {
  std::vector<std::string> names;
  for (const std::string& name : names_in(project_file("golden")))
    if (name != "meshes") names.push_back(name);
  return names;
}

class Golden : public testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] static std::string file(const std::string& name) {
    return project_file("golden/" + GetParam() + "/" + name);
  }
};

TEST_P(Golden, gives_what_is_expected) {
  const TemporaryFolder folder;
  const Ended ran = palpate(folder.path(), {"run", file("scenario.toml"), "--quiet"});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const Ended compared = palpate(folder.path(), {"compare", "out/scenario", file("expected"),
                                                 "--tolerances", file("tolerances.toml")});
  EXPECT_EQ(compared.code, 0) << compared.out << compared.err;
}

TEST_P(Golden, says_why_it_is_there_and_what_it_allows) {
  const std::string scenario = read_file(file("scenario.toml"));
  EXPECT_TRUE(scenario.starts_with("# Why: ")) << "begin the scenario with its reason";
  EXPECT_NE(scenario.find("\n# May differ: "), std::string::npos);
  EXPECT_FALSE(names_in(file("expected")).empty());
  const Node baseline = read_toml(file("expected/baseline.toml"));
  EXPECT_FALSE(trimmed(baseline.find("reason")->value.text).empty());
  EXPECT_EQ(baseline.find("commit")->value.text.size(), 40U);
  const compare::Tolerances tolerances = compare::read_tolerances(file("tolerances.toml"));
  EXPECT_FALSE(tolerances.standard.reason.empty()) << "the default lacks a reason";
  EXPECT_LE(tolerances.standard.rel, 1e-6) << "what is wider names its column";
  for (const auto& [column, tolerance] : tolerances.columns) {
    EXPECT_FALSE(tolerance.reason.empty()) << column << " lacks a reason";
    EXPECT_LE(tolerance.rel, 1e-3) << column << " allows too much";
  }
}

// The check can fail: one number of the main curve, one part in a thousand off.
TEST_P(Golden, a_changed_number_is_found) {
  const TemporaryFolder folder;
  fs::copy(file("expected"), folder / "expected");
  const bool strains = fs::exists(folder / "expected/strain_time.csv");
  const fs::path path =
      folder / (strains ? "expected/strain_time.csv" : "expected/force_indentation.csv");
  record::Table table = record::read_csv(path.string());
  const auto column = static_cast<std::size_t>(table.find(strains ? "strain" : "force_N"));
  const auto stress = static_cast<std::size_t>(table.find(strains ? "stress_kPa" : "force_N"));
  // Where a strain is held the stress is the result.
  const bool relaxes = strains && table.rows.front()[column] == table.rows.back()[column];
  const std::size_t value = relaxes ? stress : column;
  std::size_t row = table.rows.size() / 4;  // within the first load, or at the start of a case
  if (std::get<double>(table.rows[row][value]) == 0.0) ++row;
  double& number = std::get<double>(table.rows[row][value]);
  ASSERT_NE(number, 0.0);
  number *= 1.001;
  write_file(path, record::csv_text(table));
  const Ended ended = palpate(folder.path(), {"compare", "expected", file("expected"),
                                              "--tolerances", file("tolerances.toml")});
  EXPECT_EQ(ended.code, 3) << ended.err;
  EXPECT_NE(ended.out.find("DIFFERS in 1 row; worst row " + std::to_string(row + 1) + ":"),
            std::string::npos)
      << ended.out;
}

INSTANTIATE_TEST_SUITE_P(of, Golden, testing::ValuesIn(golden_folders()),
                         [](const auto& one) { return one.param; });

}  // namespace
}  // namespace palpate::test
