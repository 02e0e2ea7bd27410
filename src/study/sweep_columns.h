// The results of a sweep as columns of numbers: what varied, and what came of it.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "record/table.h"
#include "scenario/design.h"

namespace palpate::study {

using DesignKind = scenario::Design::Kind;
using Scale = scenario::Interval::Scale;

// What is known of a factor before results are looked at.
struct FactorChoice {
  std::string name = {};    // for people and for sensitivity.csv: its key
  std::string column = {};  // of results.csv: numbers, or words where it is no number
  Scale scale = Scale::linear;
  std::size_t levels = 0;  // of a grid
};

struct ColumnChoice {
  DesignKind kind = DesignKind::grid;
  std::vector<FactorChoice> factors = {};
  std::vector<std::string> show = {};  // columns; empty: those that a sweep is usually made for
};

struct FactorColumn {
  FactorChoice choice = {};
  std::vector<double> values = {};      // one a case; of words their number in `words`
  std::vector<std::string> words = {};  // in the order of their coming; empty: it is a number

  [[nodiscard]] bool is_number() const { return words.empty(); }
};

struct OutputColumn {
  std::string name = {};
  std::vector<double> values = {};  // one a case; no number where the case failed or is missing
};

struct SweepColumns {
  DesignKind kind = DesignKind::grid;
  std::size_t cases = 0;
  std::vector<FactorColumn> factors = {};
  std::vector<OutputColumn> outputs = {};  // first the most telling
  std::vector<std::string> notes = {};     // sentences, of outputs that were not taken
};

// Collects columns row by row, so that the whole table need not be in memory. Of a case whose
// `outcome` is not `completed` no output counts.
class ColumnReader {
 public:
  // `header`: the columns of the rows to come, `outcome` among them. Throws InputError where a
  // factor's column or one of `show` is not there, naming the nearest.
  ColumnReader(const ColumnChoice& choice, std::span<const std::string> header);

  // A row, as long as the header. Throws InputError where a column of `show` holds words.
  void add(std::span<const record::Cell> row);

  // Without `show`: at most six outputs, those that every completed case has and that vary: forces
  // at indentations, the greatest force, a and b of the press, tau and half of creep and
  // relaxation.
  [[nodiscard]] SweepColumns finish();

 private:
  std::vector<std::size_t> factor_at_;
  std::vector<std::size_t> output_at_;
  std::size_t outcome_at_ = 0;
  std::size_t completed_ = 0;
  bool asked_ = false;
  SweepColumns columns_;
};

// The same of a whole table.
[[nodiscard]] SweepColumns sweep_columns(const ColumnChoice& choice, const record::Table& table);

// Of PLAN/merged/results.csv: number, id, a column a key of the design, then results. A factor of
// linked keys is its first one. Numbers of lists and CSV files that spread over more than a decade
// and a half are shown by their logarithms, ranges as they were asked for. Reads a part of the file
// at a time. Throws InputError as ColumnReader does, and where the file cannot be read.
[[nodiscard]] SweepColumns read_sweep_columns(const std::string& path,
                                              const scenario::Design& design,
                                              const std::vector<std::string>& show);

}  // namespace palpate::study
