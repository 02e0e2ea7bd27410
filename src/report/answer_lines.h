// The answers of a run, as `run` and its page say them: short, however many cases a scenario has.
#pragma once

#include <string>
#include <vector>

#include "record/record.h"

namespace palpate::report {

struct NamedSentence {
  std::string name;  // of a case
  std::string sentence;
};

// One line per kind of sentence. Of sentences that differ in numbers only, the first is kept, with
// the number of others: `10 kPa, and so in 2 more cases: ...`.
[[nodiscard]] std::vector<std::string> said_once(const std::vector<NamedSentence>& all);

// One case: the three sentences of its answer. Several: the models, the range of the largest force
// (strain, stress) with its errors, and one line per kind of neglected effect.
[[nodiscard]] std::vector<std::string> answer_lines(const std::vector<record::CaseRecord>& records);

// The same of several cases before any has run: models, errors, neglected effects.
[[nodiscard]] std::vector<std::string> forecast_lines(
    const std::vector<record::CaseRecord>& records);

}  // namespace palpate::report
