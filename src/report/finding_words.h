// Findings, their numbers and digits, as a person reads them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "record/record.h"

namespace palpate::report {

// One group of findings on a page, with a sentence that introduces it.
struct FindingGroup {
  std::string_view heading;
  std::string_view sentence;
};
[[nodiscard]] const std::vector<FindingGroup>& finding_groups();

// A finding in words: its group (an index of finding_groups()) and a label; a finding that this
// program does not know by name is in the last group under its name.
struct FindingWords {
  std::size_t group = 0;
  std::string label = {};
  std::string unit = {};
};
[[nodiscard]] FindingWords words_of_finding(const std::string& name);

// The value of a finding as on a page: so many digits, shares in per cent, and its unit.
[[nodiscard]] std::string finding_text(const record::Finding& finding, int digits = 4);

// As many digits of a force or strain as its stated error warrants: two at 20 %, three at 5 %, four
// below 1 %, and three where none is stated.
[[nodiscard]] int warranted_digits(const record::Answer& answer);
// An estimate with as many digits as its interval warrants, four at most.
[[nodiscard]] std::string warranted_text(double value, double low, double high);

// A number of a record's findings; NaN if the record has no such number.
[[nodiscard]] double finding_number(const record::CaseRecord& record, std::string_view name);
// A word of a record's findings; empty if the record has no such word.
[[nodiscard]] std::string finding_word(const record::CaseRecord& record, std::string_view name);

}  // namespace palpate::report
