// The answer of a case in three plain sentences, as `run`, `explain` and reports show it.
#pragma once

#include <optional>
#include <string>

namespace palpate::record {

// Each member is one or more whole sentences for a reader who knows neither the program nor the
// theory. All are empty before the case has been judged.
struct Answer {
  std::string model;     // which model, and why: "Chosen: layer, ... hertz would be 14 % low: ..."
  std::string error;     // the largest force (or strain) if the case has run, with its stated error
  std::string left_out;  // which effects are left out, what each would change, and its remedy
  std::string verdict;   // of a live run: whether measured force and model agree
  bool complete = true;  // whether nothing worth a remark is left out
  std::optional<double> stated_error;  // relative, of the force or strain; empty if not estimated
};

}  // namespace palpate::record
