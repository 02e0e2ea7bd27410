// Every finding of docs/results.md has words on the page.
#include "report/finding_words.h"

#include <gtest/gtest.h>

#include <regex>
#include <set>

#include "base/files.h"

namespace palpate::report {
namespace {

TEST(FindingWords, KnowEveryFindingOfTheDocuments) {
  const std::string text = read_text(std::string(PALPATE_SOURCE_DIR) + "/docs/results.md");
  const std::string table =
      text.substr(text.find("## findings.csv"),
                  text.find("Warnings on validity") - text.find("## findings.csv"));
  const std::size_t last = finding_groups().size() - 1;
  std::size_t count = 0;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("| `")) continue;
    std::string cell = line.substr(2, line.find(" |", 2) - 2);
    const std::regex name("`([a-zA-Z0-9_]+)`");
    for (std::sregex_iterator at(cell.begin(), cell.end(), name), end; at != end; ++at) {
      const std::string word = (*at)[1];
      if (word == "force_at_1_mm_N") continue;  // named by the scenario
      EXPECT_NE(words_of_finding(word).group, last) << word;
      ++count;
    }
  }
  EXPECT_GT(count, 50U);
}

TEST(FindingWords, ValuesHaveFourDigitsAndUnits) {
  EXPECT_EQ(finding_text({"peak_force_N", 1.23456}), "1.235 N");
  EXPECT_EQ(finding_text({"stated_error", 0.03456}), "3.46 %");
  EXPECT_EQ(finding_text({"model", std::string("layer")}), "layer");
  EXPECT_EQ(finding_text({"force_at_1_mm_N", 2.0}), "2");
  EXPECT_EQ(finding_text({"peak_force_N", 1.23456}, 2), "1.2 N");
  EXPECT_EQ(finding_text({"peak_strain", 0.123456}, 2), "12 %");
  record::CaseRecord record;
  record.findings = {{"nodes", 12.0}, {"model", std::string("hertz")}};
  EXPECT_EQ(finding_number(record, "nodes"), 12.0);
  EXPECT_TRUE(std::isnan(finding_number(record, "model")));
  EXPECT_EQ(finding_word(record, "model"), "hertz");
}

// Two digits at 20 %, three at 5 %, four below 1 %, never more; and of an estimate, those that its
// interval leaves.
TEST(FindingWords, NumbersHaveTheDigitsThatTheirErrorWarrants) {
  const auto digits = [](std::optional<double> error) {
    record::Answer answer;
    answer.stated_error = error;
    return warranted_digits(answer);
  };
  EXPECT_EQ(digits(1.5), 2);
  EXPECT_EQ(digits(0.2), 2);
  EXPECT_EQ(digits(0.05), 3);
  EXPECT_EQ(digits(0.005), 4);
  EXPECT_EQ(digits(1e-7), 4);
  EXPECT_EQ(digits(std::nullopt), 3);
  EXPECT_EQ(warranted_text(60.1234, 55.0, 65.0), "60.1");
  EXPECT_EQ(warranted_text(60.1234, 59.9, 60.3), "60.12");
  EXPECT_EQ(warranted_text(60.1234, 60.1233, 60.1235), "60.12");
}

}  // namespace
}  // namespace palpate::report
