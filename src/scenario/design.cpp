// Computes the settings of a case from its number.
#include "scenario/design.h"

#include <algorithm>
#include <cmath>

#include "base/document_writer.h"
#include "base/index.h"
#include "base/text.h"
#include "scenario/sample_points.h"

namespace palpate::scenario {
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
    factors_.push_back({column.key,
                        {{column.key, column.place, {}, std::nullopt, column.common_unit, {}}},
                        false});
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
  const bool ranges = std::all_of(keys.begin(), keys.end(),
                                  [](const Varied& one) { return one.interval.has_value(); });
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
    Node list;
    list.kind = Node::Kind::array;
    list.items = {setting.value};
    CommonUnit unit;
    unit.add(setting.value);
    factors.push_back(
        {setting.key,
         {{setting.key, setting.place, {setting.value}, std::nullopt, unit.unit(), list}},
         false});
  }
  return {Kind::grid, factors};
}

std::string Design::toml() const {
  if (empty()) return "";
  std::string text = "\n[sweep]\ndesign = \"" + design_words()[as_index(kind_)] + "\"\n";
  if (kind_ == Kind::csv) {
    Node file;
    file.kind = Node::Kind::text;
    file.text = table_.path();
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
