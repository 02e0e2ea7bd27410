// What the cases of a sweep say together of their models, errors and neglected effects.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "sweep/columns.h"
#include "sweep/row.h"

namespace palpate::sweep {

// Collects rows one by one, without keeping them.
class SweepAnswer {
 public:
  std::string tolerance;  // of the errors, `5 %`; empty where cases have their own

  // `number`: of the case, from 1. Rows of cases that did not end as they should count for nothing.
  void see(const SweepRow& row, std::size_t number);

  // `± 3 % (tolerance 5 %)`, `± 3 % to 41 %, not counting viscosity` of the completed cases; a
  // sentence's part where an error is not known.
  [[nodiscard]] std::string error() const;

  // The models, then one line per neglected effect with its largest change. Empty without cases.
  [[nodiscard]] std::vector<std::string> lines() const;

 private:
  // An effect that cases neglect in the same words, but for numbers.
  struct Effect {
    std::string bare;  // the sentence without its numbers
    std::size_t cases = 0;
    double largest = 0.0;    // per cent
    std::string sentence{};  // of the case with the largest change
    std::size_t number = 0;  // of that case
  };
  void see_effect(const std::string& sentence, std::size_t number);

  std::size_t cases_ = 0;
  std::size_t unknown_ = 0;  // cases without a stated error
  std::size_t uncounted_cases_ = 0;
  std::string uncounted_;  // the longest sentence on what an error does not contain
  std::map<std::string, std::size_t> models_;
  Ends errors_;  // as parts of 1
  std::vector<Effect> effects_;
};

}  // namespace palpate::sweep
