// Computes the settings of a case from its number.
#include "scenario/design.h"

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numeric>
#include <random>
#include <set>

#include "base/index.h"
#include "base/text.h"

namespace palpate::scenario {
namespace {

// The `bits` highest bits of a number in [0, 2^64), as a fraction of 1.
double part_of_one(std::uint64_t number, int bits) {
  return std::ldexp(static_cast<double>(number >> (64 - bits)), -bits);
}

// Uniformly in [0, count); numbers above the last whole multiple of `count` are drawn again.
std::uint64_t below(std::uint64_t count, std::mt19937_64& generator) {
  constexpr std::uint64_t last = std::numeric_limits<std::uint64_t>::max();
  const std::uint64_t beyond = (last % count + 1) % count;
  std::uint64_t number = generator();
  while (number > last - beyond) number = generator();
  return number % count;
}

}  // namespace

std::vector<double> sobol_points(std::size_t samples, std::size_t dimensions) {
  boost::random::sobol sequence(dimensions);
  std::vector<double> points(samples * dimensions);
  for (double& coordinate : points) coordinate = part_of_one(sequence(), 53);
  return points;
}

std::vector<double> latin_hypercube(std::size_t samples, std::size_t dimensions,
                                    std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::vector<double> points(samples * dimensions);
  std::vector<std::size_t> strata(samples);
  for (std::size_t d = 0; d < dimensions; ++d) {
    std::iota(strata.begin(), strata.end(), std::size_t{0});
    for (std::size_t i = samples; i-- > 1;) std::swap(strata[i], strata[below(i + 1, generator)]);
    // 29 bits inside a stratum and 24 for its number: the sum is exact and below `samples`.
    for (std::size_t i = 0; i < samples; ++i)
      points[i * dimensions + d] = (static_cast<double>(strata[i]) + part_of_one(generator(), 29)) /
                                   static_cast<double>(samples);
  }
  return points;
}

namespace {

struct Cell {
  std::string text;
  int column = 0;  // of its first byte in the line, from 1
};

// The cells of one line. Throws InputError for a quote that is not closed.
std::vector<Cell> cells_of(std::string_view line, const Place& place) {
  std::vector<Cell> cells;
  std::size_t at = 0;
  while (true) {
    while (at < line.size() && line[at] == ' ') ++at;
    Cell cell{{}, static_cast<int>(at) + 1};
    if (at < line.size() && line[at] == '"') {
      for (++at; at < line.size(); ++at) {
        if (line[at] != '"') {
          cell.text += line[at];
        } else if (at + 1 < line.size() && line[at + 1] == '"') {
          cell.text += line[at++];
        } else {
          break;
        }
      }
      const std::size_t comma = std::min(line.find(',', at), line.size());
      if (at == line.size() || !trimmed(line.substr(at + 1, comma - at - 1)).empty())
        throw InputError({place.file, place.line, cell.column},
                         "a quoted cell does not end before its comma; close it by `\"`, and "
                         "double the quotes inside it");
      at = comma;
    } else {
      const std::size_t comma = std::min(line.find(',', at), line.size());
      cell.text = trimmed(line.substr(at, comma - at));
      at = comma;
    }
    cells.push_back(cell);
    if (at == line.size()) return cells;
    ++at;
  }
}

Node value_of(const std::string& text, const std::string& unit, const Place& place) {
  Node node;
  const auto number = whole_number(text);
  if (number && unit.empty()) {
    const bool digits = text.find_first_not_of("+-0123456789") == std::string::npos;
    node.kind = digits ? Node::Kind::integer : Node::Kind::real;
    node.number = *number;
  } else if (number) {
    node = text_node(text + " " + unit);
  } else if (text == "true" || text == "false") {
    node.kind = Node::Kind::boolean;
    node.boolean = text == "true";
  } else if (text.starts_with('[') || text.starts_with('{')) {
    node = parse_assignment("cell=" + text).second;
  } else {
    node = text_node(text);
  }
  set_place(node, place);
  return node;
}

// A result contains the table with its files beside it, so the table must not name other folders.
void refuse_folders(const std::string& key, const Node& value) {
  if (value.kind != Node::Kind::text || !names_file(key)) return;
  if (value.text.substr(0, value.text.find('#')).find('/') != std::string::npos)
    throw InputError(value.place,
                     "`" + value.text +
                         "` lies in another folder, where a copy of this table among results would "
                         "not find it; put the file beside the scenario and write its bare name");
}

}  // namespace

bool names_file(std::string_view key) {
  const std::string_view last = key.substr(key.rfind('.') + 1);
  return last == "material" || last == "file";
}

std::string value_word(const std::string& key, const Node& value, std::size_t index) {
  const auto holds_more = [](const Node& node) {
    return node.kind == Node::Kind::table || node.kind == Node::Kind::array;
  };
  if (value.kind == Node::Kind::table || std::ranges::any_of(value.items, holds_more))
    return key.substr(key.rfind('.') + 1) + std::to_string(index + 1);
  if (value.kind == Node::Kind::array && !value.items.empty()) {
    std::vector<std::string> words;
    for (const Node& item : value.items) words.push_back(item.shown());
    const std::set<std::string> different(words.begin(), words.end());
    return different.size() == 1 ? words.front() : joined(words, " x ");
  }
  const std::string shown = value.shown();
  return names_file(key) ? std::filesystem::path(shown).filename().string() : shown;
}

CaseTable::CaseTable(std::string text, std::string path)
    : text_(std::move(text)), path_(std::move(path)) {
  refuse_no_text(text_, path_, "give a CSV file");
  int line = 0;
  std::size_t at = text_.starts_with("\xef\xbb\xbf") ? 3 : 0;  // a byte order mark of spreadsheets
  while (at < text_.size()) {
    const std::size_t end = std::min(text_.find('\n', at), text_.size());
    ++line;
    const Row row{at, line};
    const std::string given = trimmed(std::string_view(text_).substr(at, end - at));
    at = end + 1;
    if (given.empty()) continue;
    if (!columns_.empty()) {
      rows_.push_back(row);
      continue;
    }
    for (const Cell& cell : cells_of(given, {path_, line, 0})) {
      Column column{cell.text, {path_, line, cell.column}, {}};
      const std::size_t open = cell.text.rfind('[');
      if (open != std::string::npos && cell.text.ends_with(']')) {
        column.unit = trimmed(cell.text.substr(open + 1, cell.text.size() - open - 2));
        column.key = trimmed(cell.text.substr(0, open));
      }
      if (column.key.empty())
        throw InputError(
            column.place,
            "the header has an empty cell; name a key, as `tissue.young_modulus [kPa]`");
      if (column.key.find(';') != std::string::npos || column.key.find('\t') != std::string::npos)
        throw InputError(column.place,
                         "the header has one cell, `" + column.key + "`; separate cells by commas");
      if (std::ranges::any_of(columns_,
                              [&](const Column& other) { return other.key == column.key; }))
        throw InputError(column.place, "`" + column.key + "` has two columns; keep one of the two");
      columns_.push_back(column);
    }
  }
  if (columns_.empty())
    throw InputError(
        {path_, 1, 1},
        "the file has no header; name a key a column, as `tissue.young_modulus [kPa]`");
  if (rows_.empty())
    throw InputError({path_, line, 1}, "the file has a header alone; add a row for every case");
  for (std::size_t i = 0; i < rows_.size(); ++i) (void)row(i);  // refuses what is wrong in it
}

std::vector<Setting> CaseTable::row(std::size_t i) const {
  const Row& row = rows_[i];
  const std::size_t end = std::min(text_.find('\n', row.at), text_.size());
  std::string_view line = std::string_view(text_).substr(row.at, end - row.at);
  if (line.ends_with('\r')) line.remove_suffix(1);
  const std::vector<Cell> cells = cells_of(line, {path_, row.line, 0});
  if (cells.size() != columns_.size())
    throw InputError({path_, row.line, cells.back().column},
                     "this row has " + std::to_string(cells.size()) +
                         " cells, and the header has " + std::to_string(columns_.size()) +
                         "; give a value for every column");
  std::vector<Setting> settings;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const Column& column = columns_[c];
    const Place place{path_, row.line, cells[c].column};
    if (cells[c].text.empty())
      throw InputError(place, "`" + column.key + "` has no value here; give one in every row");
    Setting setting{column.key, column.place, value_of(cells[c].text, column.unit, place), {}};
    refuse_folders(setting.key, setting.value);
    setting.word = value_word(setting.key, setting.value, i);
    settings.push_back(setting);
  }
  return settings;
}

namespace {

using Kind = Design::Kind;

constexpr std::size_t most_words = 1000;  // cases, above which they are not named by their values
constexpr std::size_t longest_name = 80;

bool is_sampled(Kind kind) {
  return kind == Kind::lhs || kind == Kind::sobol || kind == Kind::saltelli;
}

// The value at a fraction of the way from `from` (0) to `to` (1), in the unit of the range and with
// 12 digits, so that it is short to read and the same on processors whose logarithms differ in the
// last bit.
Node value_at(const Interval& interval, double part) {
  if (part <= 0.0) return interval.from;
  if (part >= 1.0) return interval.to;
  const double low = interval.low;
  const double high = interval.high;
  const double value = interval.scale == Interval::Scale::logarithmic
                           ? std::exp((1.0 - part) * std::log(low) + part * std::log(high))
                           : (1.0 - part) * low + part * high;
  Node node = interval.from;
  node.number = whole_number(rounded_text(value, 12)).value_or(value);
  if (node.number <= std::min(low, high)) return low < high ? interval.from : interval.to;
  if (node.number >= std::max(low, high)) return low < high ? interval.to : interval.from;
  if (node.kind == Node::Kind::text) {
    node.text = number_text(node.number) + " " + interval.unit;
  } else {
    const bool whole = interval.from.kind == Node::Kind::integer &&
                       interval.to.kind == Node::Kind::integer &&
                       node.number == std::round(node.number);
    node.kind = whole ? Node::Kind::integer : Node::Kind::real;
  }
  return node;
}

Setting with_word(const Varied& varied, Node value, std::size_t level) {
  Setting setting{varied.key, varied.place, std::move(value), {}};
  setting.word = value_word(setting.key, setting.value, level);
  return setting;
}

// Setting for a level of a list or of the points of a range, counted from 0.
Setting at_level(const Varied& varied, std::size_t level) {
  if (!varied.interval) return with_word(varied, varied.levels[level], level);
  const auto steps = static_cast<double>(varied.interval->points - 1);
  return with_word(varied, value_at(*varied.interval, static_cast<double>(level) / steps), level);
}

// Setting for a coordinate in [0, 1) of a range, or of a list whose values have equal shares.
Setting at_part(const Varied& varied, double part) {
  if (varied.interval) return with_word(varied, value_at(*varied.interval, part), 0);
  const std::size_t count = varied.levels.size();
  const auto level = static_cast<std::size_t>(part * static_cast<double>(count));
  return at_level(varied, std::min(level, count - 1));
}

std::string entry(const Varied& varied) {
  Node given = varied.given;
  use_copies(given, varied.key);
  return toml_text(varied.key) + " = " + toml_value(given);
}

}  // namespace

const std::vector<std::string>& design_words() {
  static const std::vector<std::string> words{"grid", "lhs", "sobol", "saltelli", "list", "csv"};
  return words;
}

void use_copies(Node& node, const std::string& key) {
  for (Member& member : node.members) use_copies(member.value, member.key);
  for (Node& item : node.items) use_copies(item, key);
  if (node.kind != Node::Kind::text || !names_file(key)) return;
  const std::size_t slash = node.text.rfind('/', node.text.find('#'));
  if (slash != std::string::npos) node.text.erase(0, slash + 1);
}

std::size_t Factor::levels() const {
  if (keys.empty()) return 0;
  const Varied& first = keys.front();
  return first.interval ? first.interval->points : first.levels.size();
}

Design::Design(Kind kind, std::vector<Factor> factors, Sampling sampling)
    : kind_(kind), factors_(std::move(factors)), sampling_(sampling) {
  for (const Factor& factor : factors_)
    for (const Varied& varied : factor.keys) keys_.push_back(varied.key);
  const std::size_t d = factors_.size();
  if (d == 0) return;
  switch (kind_) {
    case Kind::lhs:
      points_ = latin_hypercube(sampling_.samples, d, sampling_.seed);
      count_ = sampling_.samples;
      break;
    case Kind::sobol:
      points_ = sobol_points(sampling_.samples, d);
      count_ = sampling_.samples;
      break;
    case Kind::saltelli:
      points_ = sobol_points(sampling_.samples, 2 * d);
      count_ = sampling_.samples * (d + 2);
      break;
    case Kind::list: count_ = factors_.front().levels(); break;
    case Kind::grid:
    case Kind::csv:
      for (const Factor& factor : factors_) count_ *= factor.levels();
  }
  named_by_words_ = !is_sampled(kind_) && count_ <= most_words;
  for (std::size_t i = 0; i < count_ && named_by_words_; ++i) {
    std::size_t length = 0;
    for (const Setting& setting : settings(i)) length += setting.word.size() + 1;
    named_by_words_ = length <= longest_name + 1;
  }
}

Design::Design(CaseTable table)
    : kind_(Kind::csv), count_(table.size()), named_by_words_(false), table_(std::move(table)) {
  for (const CaseTable::Column& column : table_.columns()) {
    keys_.push_back(column.key);
    factors_.push_back({column.key, {{column.key, column.place, {}, std::nullopt, {}}}, false});
  }
}

double Design::coordinate(std::size_t i, std::size_t factor) const {
  const std::size_t d = factors_.size();
  if (kind_ != Kind::saltelli) return points_[i * d + factor];
  const std::size_t part = i % (d + 2);  // 0: A, 1: B, then A with one column of B
  const bool from_b = part == 1 || part == factor + 2;
  return points_[i / (d + 2) * 2 * d + (from_b ? d : 0) + factor];
}

std::vector<Setting> Design::settings(std::size_t i) const {
  if (kind_ == Kind::csv) return table_.row(i);
  std::vector<Setting> all;
  all.reserve(keys_.size());
  std::size_t rest = i;
  std::size_t block = count_;
  for (std::size_t f = 0; f < factors_.size(); ++f) {
    const Factor& factor = factors_[f];
    std::size_t level = i;
    if (kind_ == Kind::grid) {
      block /= factor.levels();
      level = rest / block;
      rest %= block;
    }
    for (const Varied& varied : factor.keys)
      all.push_back(is_sampled(kind_) ? at_part(varied, coordinate(i, f))
                                      : at_level(varied, level));
  }
  return all;
}

std::vector<std::vector<Setting>> Design::extremes(std::size_t f) const {
  std::vector<std::vector<Setting>> all;
  const std::vector<Varied>& keys = factors_[f].keys;
  const bool ranges =
      std::ranges::all_of(keys, [](const Varied& one) { return one.interval.has_value(); });
  const std::size_t levels = kind_ == Kind::csv ? 0 : ranges ? 2 : factors_[f].levels();
  for (std::size_t level = 0; level < levels; ++level) {
    std::vector<Setting> settings;
    for (const Varied& varied : keys)
      settings.push_back(ranges ? with_word(varied, value_at(*varied.interval, level), 0)
                                : at_level(varied, level));
    all.push_back(settings);
  }
  return all;
}

std::string Design::case_name(std::size_t i,
                              const std::vector<std::pair<std::string, std::string>>& swept) const {
  std::vector<std::string> words;
  for (const auto& [key, word] : swept) words.push_back(word);
  if (named_by_words_) return joined(words, "_");
  const std::size_t width = std::max<std::size_t>(4, std::to_string(count_).size());
  const std::string digits = std::to_string(i + 1);
  return std::string(width - digits.size(), '0') + digits;
}

Design Design::only(std::size_t i) const {
  std::vector<Factor> factors;
  for (const Setting& setting : settings(i)) {
    const Node list = list_node({setting.value});
    factors.push_back(
        {setting.key, {{setting.key, setting.place, list.items, std::nullopt, list}}, false});
  }
  return {Kind::grid, factors};
}

std::string Design::toml() const {
  if (empty()) return "";
  std::string text = "\n[sweep]\ndesign = \"" + design_words()[as_index(kind_)] + "\"\n";
  if (kind_ == Kind::csv) {
    Node file = text_node(table_.path());
    use_copies(file, "file");
    return text + "file = " + toml_value(file) + "\n";
  }
  if (is_sampled(kind_)) text += "samples = " + std::to_string(sampling_.samples) + "\n";
  if (kind_ == Kind::lhs) text += "seed = " + std::to_string(sampling_.seed) + "\n";
  // Consecutive rows are written as one inline list, which keeps their order among the factors.
  for (std::size_t f = 0; f < factors_.size(); ++f) {
    if (!factors_[f].row) {
      text += entry(factors_[f].keys.front()) + "\n";
      continue;
    }
    std::vector<std::string> rows;
    for (; f < factors_.size() && factors_[f].row; ++f) {
      std::vector<std::string> entries;
      for (const Varied& varied : factors_[f].keys) entries.push_back(entry(varied));
      rows.push_back("{ " + joined(entries, ", ") + " }");
    }
    --f;
    text += "rows = [" + joined(rows, ", ") + "]\n";
  }
  return text;
}

}  // namespace palpate::scenario
