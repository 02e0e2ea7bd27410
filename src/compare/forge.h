// Comparisons in the forms that forges and build servers show: JUnit XML and annotations.
#pragma once

#include <span>
#include <string>

#include "compare/compare.h"

namespace palpate::compare {

// The comparison of one result with what is wanted, or the reason why there is none.
struct Check {
  std::string name;                  // of the result or the scenario
  std::string want;                  // path of the wanted folder or file
  bool one_file = false;             // whether it is a file
  FolderComparison comparison = {};  // empty if `error` is not
  std::string error = {};            // a sentence

  [[nodiscard]] bool equal() const { return error.empty() && comparison.equal(); }
};

// JUnit XML: a test suite per check and a test case per column, whose `classname` is the name of
// the check and the file. A column that differs has a failure, whose message names the file, the
// case, the row and both values; an ignored column is skipped; a check with an error has one test
// case, with that error. Contains no time, so that the same comparison gives the same bytes.
[[nodiscard]] std::string junit_text(std::span<const Check> checks);

// One line per check that is not equal, in the form of GitHub's workflow commands, `::error
// file=...`: its first difference by rank_of(), with the number of further ones. The file is the
// wanted one, the line that of the worst row. Each line ends with `\n`.
[[nodiscard]] std::string github_annotations(std::span<const Check> checks);

}  // namespace palpate::compare
