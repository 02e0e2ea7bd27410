// Numbers computed independently of this project: tests/cases/physics.csv, rows by their id.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "record/csv.h"

namespace palpate::test {

struct Case {
  double value = 0.0;
  double rel_tol = 0.0;
};

inline Case find_case(const std::string& id) {
  static const record::Table table =
      record::read_csv(PALPATE_SOURCE_DIR "/tests/cases/physics.csv");
  for (const auto& row : table.rows)
    if (std::get<std::string>(row[0]) == id)
      return {std::get<double>(row[static_cast<std::size_t>(table.find("value"))]),
              std::get<double>(row[static_cast<std::size_t>(table.find("rel_tol"))])};
  ADD_FAILURE() << "no case " << id << " in tests/cases/physics.csv";
  return {};
}

// `got` within the case's own relative tolerance. The values are printed with eight significant
// digits, so that half a unit of the eighth is theirs too; rows with tolerance 0 are exact counts.
inline void expect_case(const std::string& id, double got) {
  const Case expected = find_case(id);
  const double size = std::abs(expected.value);
  const double printed =
      expected.rel_tol > 0.0 ? 0.5 * std::pow(10.0, std::floor(std::log10(size)) - 7.0) : 0.0;
  EXPECT_NEAR(got, expected.value, expected.rel_tol * size + printed) << id;
}

}  // namespace palpate::test
