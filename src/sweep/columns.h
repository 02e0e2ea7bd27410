// The results of a sweep as columns of numbers: factors and outputs.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "record/table.h"
#include "scenario/design.h"

namespace palpate::sweep {

using DesignKind = scenario::Design::Kind;
using Scale = scenario::Interval::Scale;

// A factor of the design.
struct FactorChoice {
  std::string name = {};    // its key, for labels and sensitivity.csv
  std::string column = {};  // in results.csv
  Scale scale = Scale::linear;
  std::size_t levels = 0;  // of a grid
};

struct ColumnChoice {
  DesignKind kind = DesignKind::grid;
  std::vector<FactorChoice> factors = {};
  std::vector<std::string> show = {};  // columns chosen by the user; empty: the usual ones
};

struct FactorColumn {
  FactorChoice choice = {};
  std::vector<double> values = {};      // one per case: numbers, or indices into `words`
  std::vector<std::string> words = {};  // by first occurrence; empty: the factor is a number

  [[nodiscard]] bool is_number() const { return words.empty(); }
};

struct OutputColumn {
  std::string name = {};
  std::vector<double> values = {};  // one per case; NaN if the case failed or is missing
};

struct SweepColumns {
  DesignKind kind = DesignKind::grid;
  std::size_t cases = 0;
  std::vector<FactorColumn> factors = {};
  std::vector<OutputColumn> outputs = {};  // the most useful first
  std::vector<std::string> notes = {};     // sentences on outputs that were not taken
};

// The smallest and the largest finite value; `low` > `high`: there is none.
struct Ends {
  double low = INFINITY;
  double high = -INFINITY;
};
[[nodiscard]] Ends ends(std::span<const double> values);

// Collects columns row by row, without a table in memory. Outputs of unfinished cases are NaN.
class ColumnReader {
 public:
  // `header`: the names of the columns. Throws InputError, naming the nearest column, if `outcome`,
  // a factor's column or a column of `show` is missing.
  ColumnReader(const ColumnChoice& choice, std::span<const std::string> header);

  // Adds a row, as long as the header. Throws InputError if a column of `show` contains words.
  void add(std::span<const record::Cell> row);

  // Returns the columns. Without `show`, at most six outputs that every completed case has and that
  // vary: forces at indentations, peak force, parameters of fits, creep half time, peak strain.
  [[nodiscard]] SweepColumns finish();

 private:
  std::vector<std::size_t> factor_at_;
  std::vector<std::size_t> output_at_;
  std::size_t outcome_at_ = 0;
  std::size_t completed_ = 0;
  bool asked_ = false;
  SweepColumns columns_;
};

// Reads PLAN/merged/results.csv (number, id, one column per key, results), a part of the file at a
// time. A factor of several linked keys has the column of the first. Numbers from lists and CSV
// files get a logarithmic scale if they spread by more than a factor of 30; ranges have the scale
// of the design. Throws InputError like ColumnReader, and if the file cannot be read.
[[nodiscard]] SweepColumns read_sweep_columns(const std::string& path,
                                              const scenario::Design& design,
                                              const std::vector<std::string>& show);

// `force_at_1_mm_N` as "Force at 1 mm (N)", `force_indentation_power_n` as "n, power fit".
[[nodiscard]] std::string output_label(const std::string& column);

// `tissue.young_modulus_kPa` of the factor `tissue.young_modulus` as "Young's modulus (kPa)".
[[nodiscard]] std::string factor_label(const FactorChoice& factor);

// The column's name with `_` for all but letters and digits, for names of files.
[[nodiscard]] std::string file_word(const std::string& column);

// Whether values need a logarithmic scale: all positive, the largest over 30 times the smallest.
[[nodiscard]] bool spread_wide(std::span<const double> values);

}  // namespace palpate::sweep
