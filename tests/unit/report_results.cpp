// What the folder of a result does while cases run, so that its end is quick.
#include "report/results.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "record/csv.h"
#include "temporary_folder.h"

namespace palpate::report {
namespace {

constexpr const char* three_cases =
    "schema = 1\n[[step]]\nkind = \"indent\"\n[output]\nfigures = false\nreport = false\n"
    "[sweep]\n\"step.1.to\" = [\"1 mm\", \"2 mm\", \"3 mm\"]\n";

// Whatever the order in which cases end, and whatever runs on at an interrupt: the rows are in the
// order of the cases. They are those of keep(), and are not made again by finish().
TEST(ResultFolders, HaveTheRowsOfKeptCasesInTheirOrder) {
  const test::TemporaryFolder folder;
  const scenario::Family family = scenario::parse(three_cases, "three.toml", {});
  ResultFolder result(folder.path().string(), family, Replace::incomplete, "origin");
  result.open();
  std::vector<record::CaseRecord> records(3);
  for (std::size_t i = 0; i < 3; ++i) {
    records[i].name = family.cases[i].name;
    records[i].add(record::ContactRow{.step = 1, .force = 1.0 + static_cast<double>(i)});
  }
  records[1].outcome = record::Outcome::interrupted;
  const std::string expected = record::csv_text(record::contact_table({records[0], records[2]}));
  for (const std::size_t i : {2, 1, 0}) result.keep(i, records[i]);
  records.erase(records.begin() + 1);
  for (record::CaseRecord& record : records) record.contact.clear();
  (void)result.finish(records, {}, {});
  EXPECT_EQ(test::read_file(folder / "three/force_indentation.csv"), expected);
  const std::string list = test::read_file(folder / "three/contents.sha256");
  EXPECT_NE(list.find(sha256(expected) + "  force_indentation.csv\n"), std::string::npos) << list;
}

// Of 1000 cases that take 2.1 ms each, a kill would lose two seconds of work; a folder for each of
// them would take as long to write and remove.
TEST(ResultFolders, KeepQuickCasesTogether) {
  const test::TemporaryFolder folder;
  scenario::Family family = scenario::parse(
      "schema = 1\n[[step]]\nkind = \"indent\"\n[sweep]\n\"step.1.to\" = { from = \"1 mm\", to = "
      "\"2 "
      "mm\", points = 60 }\n",
      "many.toml", {});
  ResultFolder result(folder.path().string(), family, Replace::incomplete, "origin");
  result.open();
  for (std::size_t i = 0; i < family.cases.size(); ++i) {
    record::CaseRecord record;
    record.name = family.cases[i].name;
    record.seconds = 2.1e-3;
    record.findings = {{"peak_force_N", 1.0}};
    record.add(record::ContactRow{.step = 1});
    record.add(record::ContactRow{.step = 1, .time = 1.0});
    result.keep(i, record);
  }
  std::set<std::string> kept;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    for (const auto& one : std::filesystem::directory_iterator(entry))
      if (one.is_directory()) kept.insert(one.path().string());
  ASSERT_EQ(kept.size(), 2U);  // 24 and 24, and 12 that are not worth it
  for (const std::string& one : kept) {
    EXPECT_EQ(record::read_csv(one + "/findings.csv").rows.size(), 24U);
    EXPECT_EQ(record::read_csv(one + "/force_indentation.csv").rows.size(), 48U);
  }
}

}  // namespace
}  // namespace palpate::report
