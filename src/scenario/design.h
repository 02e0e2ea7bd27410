// What a [sweep] varies: its factors, and the settings of each of its cases.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/document.h"
#include "scenario/case_table.h"

namespace palpate::scenario {

// Values between two ends, both included.
struct Interval {
  enum class Scale { linear, logarithmic };
  Node from, to;      // as written
  double low = 0.0;   // `from` as a number, in `unit`; above `high` where the range descends
  double high = 0.0;  // `to` likewise
  std::string unit;   // "kPa", as written; empty for pure numbers
  Scale scale = Scale::linear;
  std::size_t points = 0;  // how many of them a grid takes; 0 where a sample chooses
};

// The values of one key.
struct Varied {
  std::string key;
  Place place;
  std::vector<Node> levels;          // a list; empty for a range and for a column of a CSV
  std::optional<Interval> interval;  // or a range
  std::optional<std::string> unit;   // that all values are written in, empty for pure numbers;
                                     // nothing where they are no numbers or of several units
  Node given;                        // as written, for the echo
};

// What changes by itself: one key, or several that change together.
struct Factor {
  std::string name;  // its key; linked keys are joined by ` + `
  std::vector<Varied> keys;
  bool row = false;  // written as [[sweep.rows]]

  // How many; 0 where a sample chooses from a range, and in a CSV.
  [[nodiscard]] std::size_t levels() const;
};

// What a sampled design is drawn with.
struct Sampling {
  std::size_t samples = 0;
  std::uint64_t seed = 1;  // of `lhs` alone
};

class Design {
 public:
  // How cases come from factors, i being the case's number from 0, d the number of factors:
  // grid      every level with every other; the last factor varies fastest
  // lhs       a Latin hypercube of `samples` cases
  // sobol     the Sobol sequence without its first point, `samples` cases
  // saltelli  blocks of d + 2 cases, a block a sample: case i belongs to sample j = i / (d + 2);
  //           k = i % (d + 2) is 0: the row of A; 1: of B; 2 + f: of A with factor f from B
  //           (cases are equal where A and B share a coordinate, as all do in the first block)
  // list      the i-th level of every factor
  // csv       the i-th row of a file, a factor a column
  enum class Kind { grid, lhs, sobol, saltelli, list, csv };

  Design() = default;  // no sweep: one case without settings
  Design(Kind kind, std::vector<Factor> factors, Sampling sampling = {});  // not csv
  explicit Design(CaseTable table);

  [[nodiscard]] Kind kind() const { return kind_; }
  [[nodiscard]] std::size_t count() const { return count_; }  // of cases
  [[nodiscard]] bool empty() const { return factors_.empty(); }
  [[nodiscard]] const std::vector<Factor>& factors() const { return factors_; }
  // Every swept key, linked ones too, in the order of the file.
  [[nodiscard]] const std::vector<std::string>& keys() const { return keys_; }
  [[nodiscard]] const Sampling& sampling() const { return sampling_; }
  [[nodiscard]] const CaseTable& table() const { return table_; }  // of a csv design

  // The settings of case i < count(), in the order of keys(). Safe from several threads.
  [[nodiscard]] std::vector<Setting> settings(std::size_t i) const;

  // What a factor alone is tried with: every value of a list, the ends of a range; nothing of a
  // CSV, whose rows belong together.
  [[nodiscard]] std::vector<std::vector<Setting>> extremes(std::size_t factor) const;

  // Whether cases are named by their words, or else by their number, `0001`.
  [[nodiscard]] bool named_by_words() const { return named_by_words_; }
  [[nodiscard]] std::string case_name(
      std::size_t i, const std::vector<std::pair<std::string, std::string>>& swept) const;

  // The design that makes case i only.
  [[nodiscard]] Design only(std::size_t i) const;

  // The [sweep] that reads back to this design; files by their bare name. Empty without a sweep.
  [[nodiscard]] std::string toml() const;

 private:
  [[nodiscard]] double coordinate(std::size_t i, std::size_t factor) const;

  Kind kind_ = Kind::grid;
  std::vector<Factor> factors_;
  std::vector<std::string> keys_;
  std::size_t count_ = 1;
  bool named_by_words_ = true;
  Sampling sampling_;
  std::vector<double> points_;  // of a sampled design, in [0, 1): a row a sample, a column a factor
  CaseTable table_;
};

// The words of `design`, in the order of Design::Kind.
[[nodiscard]] const std::vector<std::string>& design_words();

// More cases than any plan takes; and more numbers than lie in memory, 8 bytes each: one a sample
// and factor, of `saltelli` two.
inline constexpr double most_planned = 1e9;
inline constexpr double most_samples = 1e7;
inline constexpr double most_drawn = 1e8;

// Takes [sweep] out of the document; files are looked for from `folder`. Throws InputError, at its
// place, for what is no design.
[[nodiscard]] Design take_design(Node& document, const std::string& folder);

// In the echo files lie beside it, whatever folder they came from: paths of `material` and `file`
// become bare names, in `node` and below; `key` is the node's own.
void use_copies(Node& node, const std::string& key);

}  // namespace palpate::scenario
