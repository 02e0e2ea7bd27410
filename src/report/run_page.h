// report.html of a run.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/whole_folder.h"
#include "fit/case_fits.h"
#include "plot/figure.h"
#include "record/record.h"
#include "scenario/family.h"

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

// What the page of a run shows.
struct RunShown {
  const scenario::Family& family;
  const std::vector<record::CaseRecord>& records;
  const std::vector<fit::NamedFit>& fits;
  const std::vector<plot::Figure>& figures;  // that were drawn, or tried, in the folder
};

// Writes the page into the folder of the result, whose other data files are there already: the
// answer, figures, findings, fits, pressure maps, the scene, the scenario and how to repeat it.
void write_run_page(const RunShown& shown, WholeFolder& folder);

}  // namespace palpate::report
