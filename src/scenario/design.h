// The design of a [sweep]: its factors, and the settings of each of its cases.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/document.h"

namespace palpate::scenario {

// `samples` points of the Sobol sequence in [0, 1)^dimensions, one row per point, with the
// direction numbers of Joe and Kuo (SIAM J. Sci. Comput. 30, 2635, 2008), in the order of Gray
// codes, not scrambled. The first point, the origin, is excluded: the sequence begins with (1/2,
// 1/2, ...). 1 <= dimensions <= most_sobol_dimensions.
[[nodiscard]] std::vector<double> sobol_points(std::size_t samples, std::size_t dimensions);
inline constexpr std::size_t most_sobol_dimensions = 3667;

// A Latin hypercube in [0, 1)^dimensions (McKay, Beckman and Conover, Technometrics 21, 239, 1979),
// one row per point: in every dimension each of the `samples` strata [k, k + 1) / samples contains
// one point, uniformly distributed in it. The numbers are those of std::mt19937_64, which the C++
// standard fixes; distributions of the library, which differ, are not used. For one dimension after
// the other, the strata are permuted (Fisher and Yates, from the last to the second), then a place
// in each is drawn. samples <= 2^24.
[[nodiscard]] std::vector<double> latin_hypercube(std::size_t samples, std::size_t dimensions,
                                                  std::uint64_t seed);

// The value of one key in one case, as if it were written in the document.
struct Setting {
  std::string key;   // dotted path
  Place place;       // of the key in [sweep] or in the CSV's header
  Node value;        // with a place of its own
  std::string word;  // for the case's name and `swept`: the value as written, without folders
};

// Whether the value of a key, given as a dotted path or its last word, may name a file.
[[nodiscard]] bool names_file(std::string_view key);

// The word for a swept value: files without their folder, lists as `3 x 4 x 6` or the one value
// that they repeat, tables as their number in the list (from 1; `index` is counted from 0).
[[nodiscard]] std::string value_word(const std::string& key, const Node& value, std::size_t index);

// Keeps the text of the file and parses a row when it is requested, so that a million rows need no
// more memory than their file.
class CaseTable {
 public:
  struct Column {
    std::string key;
    Place place;
    std::string unit;  // from the header, `key [unit]`; may be empty
  };

  CaseTable() = default;

  // `path` names the file in messages. Header cells are `key` or `key [unit]`; cells are separated
  // by commas, and quoted by RFC 4180 if they contain one. Throws InputError, with the place of the
  // cell, for rows of different length, empty cells, repeated columns, a file without rows, and a
  // file that is not text.
  CaseTable(std::string text, std::string path);

  [[nodiscard]] std::size_t size() const { return rows_.size(); }
  [[nodiscard]] const std::vector<Column>& columns() const { return columns_; }
  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const std::string& path() const { return path_; }

  // The settings of row i < size(), from 0. Cells are numbers, `true` or `false`, TOML if they
  // begin with `[` or `{`, and otherwise texts; a number below a unit in the header becomes a text.
  [[nodiscard]] std::vector<Setting> row(std::size_t i) const;

 private:
  struct Row {
    std::size_t at = 0;  // position of its first byte
    int line = 0;
  };

  std::string text_;
  std::string path_;
  std::vector<Column> columns_;
  std::vector<Row> rows_;
};

// A range of values, both ends included.
struct Interval {
  enum class Scale { linear, logarithmic };
  Node from, to;      // as written
  double low = 0.0;   // `from` as a number, in `unit`; above `high` if the range descends
  double high = 0.0;  // `to` likewise
  std::string unit;   // "kPa", as written; empty for pure numbers
  Scale scale = Scale::linear;
  std::size_t points = 0;  // number of values in a grid; 0 in a sampled design
};

// The values of one key.
struct Varied {
  std::string key;
  Place place;
  std::vector<Node> levels;          // a list; empty for a range and for a column of a CSV file
  std::optional<Interval> interval;  // or a range
  Node given;                        // as written, for the echo
};

// An independent factor of the design: one key, or several keys that change together.
struct Factor {
  std::string name;  // its key; linked keys are joined by ` + `
  std::vector<Varied> keys;
  bool row = false;  // written as [[sweep.rows]]

  // The number of values; 0 for a range in a sampled design, and for a CSV file.
  [[nodiscard]] std::size_t levels() const;
};

// The parameters of a sampled design.
struct Sampling {
  std::size_t samples = 0;
  std::uint64_t seed = 1;  // for `lhs` only
};

class Design {
 public:
  // How cases follow from d factors; i is the number of the case, from 0:
  // grid      all combinations of levels; the last factor varies fastest
  // lhs       a Latin hypercube of `samples` cases
  // sobol     the Sobol sequence without its first point, `samples` cases
  // saltelli  one block of d + 2 cases per sample: case i belongs to sample j = i / (d + 2);
  //           k = i % (d + 2) is 0: the row of A; 1: of B; 2 + f: of A with factor f from B
  //           (cases are equal where A and B share a coordinate, as all do in the first block)
  // list      the i-th level of every factor
  // csv       the i-th row of a file, one factor per column
  enum class Kind { grid, lhs, sobol, saltelli, list, csv };

  Design() = default;  // no sweep: one case without settings
  Design(Kind kind, std::vector<Factor> factors, Sampling sampling = {});  // for all kinds but csv
  explicit Design(CaseTable table);

  [[nodiscard]] Kind kind() const { return kind_; }
  [[nodiscard]] std::size_t count() const { return count_; }  // number of cases
  [[nodiscard]] bool empty() const { return factors_.empty(); }
  [[nodiscard]] const std::vector<Factor>& factors() const { return factors_; }
  // Every swept key, with linked keys, in the order of the file.
  [[nodiscard]] const std::vector<std::string>& keys() const { return keys_; }
  [[nodiscard]] const Sampling& sampling() const { return sampling_; }
  [[nodiscard]] const CaseTable& table() const { return table_; }  // of a csv design

  // The settings of case i < count(), in the order of keys(). Thread-safe.
  [[nodiscard]] std::vector<Setting> settings(std::size_t i) const;

  // The settings with which a factor is checked by itself: every value of a list, both ends of a
  // range, and none for a CSV file, in which the values of a row belong together.
  [[nodiscard]] std::vector<std::vector<Setting>> extremes(std::size_t factor) const;

  // By the words of its values, or by its number, `0001`.
  [[nodiscard]] std::string case_name(
      std::size_t i, const std::vector<std::pair<std::string, std::string>>& swept) const;

  // The design with case i as its only case.
  [[nodiscard]] Design only(std::size_t i) const;

  // The [sweep] table that reads back as this design, with bare file names; empty without a sweep.
  [[nodiscard]] std::string toml() const;

 private:
  [[nodiscard]] double coordinate(std::size_t i, std::size_t factor) const;

  Kind kind_ = Kind::grid;
  std::vector<Factor> factors_;
  std::vector<std::string> keys_;
  std::size_t count_ = 1;
  bool named_by_words_ = true;
  Sampling sampling_;
  std::vector<double> points_;  // in [0, 1), one row per sample, one column per factor
  CaseTable table_;
};

// The values of the key `design`, in the order of Design::Kind.
[[nodiscard]] const std::vector<std::string>& design_words();

// Limits of a sweep: the number of cases of a plan, of samples, and of random numbers, which are
// kept in memory with 8 bytes each: one per sample and factor, two for `saltelli`.
inline constexpr double most_planned = 1e9;
inline constexpr double most_samples = 1e7;
inline constexpr double most_drawn = 1e8;

// Removes [sweep] from the document and returns its design. Relative files are looked for in
// `folder`. Throws InputError, with its place, if [sweep] is not valid.
[[nodiscard]] Design take_design(Node& document, const std::string& folder);

// The echo has its files beside it: shortens the paths of `material` and `file` in `node` and below
// to bare names. `key` is the key of `node`.
void use_copies(Node& node, const std::string& key);

}  // namespace palpate::scenario
