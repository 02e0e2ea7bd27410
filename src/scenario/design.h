// What a [sweep] varies: its factors, and the settings of each of its cases.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/document.h"

namespace palpate::scenario {

// One key of one case, as if it stood in the document.
struct Setting {
  std::string key;   // dotted path
  Place place;       // of the key in [sweep]
  Node value;        // with its own place
  std::string word;  // in the case's name and in `swept`: the value as written, without folders
};

// Values between two ends, both included.
struct Interval {
  enum class Scale { linear, logarithmic };
  Node from, to;      // as written
  double low = 0.0;   // `from` as a number, in `unit`; above `high` where it descends
  double high = 0.0;  // `to` likewise
  std::string unit;   // "kPa", as written; empty for pure numbers
  Scale scale = Scale::linear;
  std::size_t points = 0;  // how many of them a grid takes; 0 where a sample chooses
};

// The values of one key.
struct Varied {
  std::string key;
  Place place;
  std::vector<Node> levels;          // a list; empty for an interval and for a CSV column
  std::optional<Interval> interval;  // or a range
  Node given;                        // as written, for the echo
};

// What changes by itself: one key, or several that change together.
struct Factor {
  std::string name;  // its key; linked keys are joined by ` + `
  std::vector<Varied> keys;
  bool row = false;  // written as [[sweep.rows]]

  [[nodiscard]] std::size_t levels() const;  // how many; 0 where a sample chooses from a range
};

class Design {
 public:
  // How cases come from factors, i being the case's number from 0, d the number of factors:
  // grid      every level with every other; the last factor varies fastest
  // lhs       a Latin hypercube of `samples` cases
  // sobol     the Sobol sequence without its first point, `samples` cases
  // saltelli  blocks of d + 2 cases, a block a sample: case i belongs to sample j = i / (d + 2);
  //           k = i % (d + 2) is 0: the row of A; 1: of B; 2 + f: of A with factor f from B
  // list      the i-th level of every factor
  // csv       the i-th row of a file, a factor a column
  enum class Kind { grid, lhs, sobol, saltelli, list, csv };

  Design() = default;  // no sweep: one case without settings
  Design(Kind kind, std::vector<Factor> factors);

  [[nodiscard]] Kind kind() const { return kind_; }
  [[nodiscard]] std::size_t count() const { return count_; }  // of cases
  [[nodiscard]] bool empty() const { return factors_.empty(); }
  [[nodiscard]] const std::vector<Factor>& factors() const { return factors_; }
  // Every swept key, linked ones too, in the order of the file.
  [[nodiscard]] const std::vector<std::string>& keys() const { return keys_; }

  // The settings of case i < count(), in the order of keys(). Safe from several threads.
  [[nodiscard]] std::vector<Setting> settings(std::size_t i) const;

  // Whether cases are named by their words, or else by their number, `0001`.
  [[nodiscard]] bool named_by_words() const { return named_by_words_; }
  [[nodiscard]] std::string case_name(std::size_t i, const std::vector<Setting>& settings) const;

  // The design that makes case i only.
  [[nodiscard]] Design only(std::size_t i) const;

  // The [sweep] that reads back to this design; files by their bare name. Empty without a sweep.
  [[nodiscard]] std::string toml() const;

 private:
  [[nodiscard]] Setting setting(const Varied& varied, std::size_t level) const;
  void count_cases();

  Kind kind_ = Kind::grid;
  std::vector<Factor> factors_;
  std::vector<std::string> keys_;
  std::size_t count_ = 1;
  bool named_by_words_ = true;
};

// More cases than any plan takes; designs say so before they count on.
inline constexpr double most_planned = 1e9;

// Takes [sweep] out of the document. Throws InputError, at its place, for what is no design.
[[nodiscard]] Design take_design(Node& document);

// In the echo files lie beside it, whatever folder they came from: paths of `material` and `file`
// become bare names, in `node` and below; `key` is the node's own.
void use_copies(Node& node, const std::string& key);

}  // namespace palpate::scenario
