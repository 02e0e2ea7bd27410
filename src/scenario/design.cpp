// The settings of a case, from its number.
#include "scenario/design.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "base/document_writer.h"
#include "base/text.h"

namespace palpate::scenario {
namespace {

using Kind = Design::Kind;

constexpr std::size_t most_words = 1000;  // cases that are still named by their values
constexpr std::size_t longest_name = 80;

// A swept value as a word of the case's name: files without their folder, lists as `3 x 4 x 6` or
// the one value that they repeat, tables by number.
std::string value_word(const std::string& key, const Node& value, std::size_t index) {
  const std::string last = key.substr(key.rfind('.') + 1);
  const auto holds_more = [](const Node& node) {
    return node.kind == Node::Kind::table || node.kind == Node::Kind::array;
  };
  if (value.kind == Node::Kind::table ||
      std::any_of(value.items.begin(), value.items.end(), holds_more))
    return last + std::to_string(index + 1);
  if (value.kind == Node::Kind::array && !value.items.empty()) {
    std::vector<std::string> words;
    for (const Node& item : value.items) words.push_back(item.shown());
    const std::set<std::string> different(words.begin(), words.end());
    return different.size() == 1 ? words.front() : joined(words, " x ");
  }
  const std::string shown = value.shown();
  const bool file = last == "material" || last == "file";
  return file ? std::filesystem::path(shown).filename().string() : shown;
}

// The value at a part of the way from `from` (0) to `to` (1), in the interval's own unit and with
// 12 digits: a text that people can read, and the same one on processors whose logarithms differ
// in their last bit.
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
  if (node.kind == Node::Kind::text) {
    node.text = number_text(node.number) + " " + interval.unit;
  } else {
    const bool whole = interval.from.kind == Node::Kind::integer &&
                       interval.to.kind == Node::Kind::integer && node.number == std::round(value);
    node.kind = whole ? Node::Kind::integer : Node::Kind::real;
  }
  return node;
}

std::size_t levels_of(const Varied& varied) {
  return varied.interval ? varied.interval->points : varied.levels.size();
}

std::string entry(const Varied& varied) {
  Node given = varied.given;
  use_copies(given, varied.key.substr(varied.key.rfind('.') + 1));
  return toml_text(varied.key) + " = " + toml_value(given) + "\n";
}

}  // namespace

void use_copies(Node& node, const std::string& key) {
  for (Member& member : node.members) use_copies(member.value, member.key);
  for (Node& item : node.items) use_copies(item, key);
  if (node.kind != Node::Kind::text || (key != "material" && key != "file")) return;
  const std::size_t slash = node.text.rfind('/', node.text.find('#'));
  if (slash != std::string::npos) node.text.erase(0, slash + 1);
}

std::size_t Factor::levels() const { return keys.empty() ? 0 : levels_of(keys.front()); }

Design::Design(Kind kind, std::vector<Factor> factors) : kind_(kind), factors_(std::move(factors)) {
  for (const Factor& factor : factors_)
    for (const Varied& varied : factor.keys) keys_.push_back(varied.key);
  count_ = 1;
  if (kind_ == Kind::grid)
    for (const Factor& factor : factors_) count_ *= factor.levels();
  else if (!factors_.empty())
    count_ = factors_.front().levels();
  named_by_words_ = count_ <= most_words;
  for (std::size_t i = 0; i < count_ && named_by_words_; ++i) {
    std::size_t length = 0;
    for (const Setting& setting : settings(i)) length += setting.word.size() + 1;
    named_by_words_ = length <= longest_name + 1;
  }
}

Setting Design::setting(const Varied& varied, std::size_t level) const {
  Setting one{varied.key, varied.place, {}, {}};
  if (varied.interval)
    one.value = value_at(*varied.interval, static_cast<double>(level) /
                                               static_cast<double>(varied.interval->points - 1));
  else
    one.value = varied.levels[level];
  one.word = value_word(one.key, one.value, level);
  return one;
}

std::vector<Setting> Design::settings(std::size_t i) const {
  std::vector<Setting> all;
  all.reserve(keys_.size());
  std::size_t rest = i;
  std::size_t block = count_;
  for (const Factor& factor : factors_) {
    std::size_t level = i;
    if (kind_ == Kind::grid) {  // the last factor varies fastest
      block /= factor.levels();
      level = rest / block;
      rest %= block;
    }
    for (const Varied& varied : factor.keys) all.push_back(setting(varied, level));
  }
  return all;
}

std::string Design::case_name(std::size_t i, const std::vector<Setting>& settings) const {
  std::vector<std::string> words;
  for (const Setting& setting : settings) words.push_back(setting.word);
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
    factors.push_back(
        {setting.key, {{setting.key, setting.place, {setting.value}, std::nullopt, list}}, false});
  }
  return {Kind::grid, factors};
}

std::string Design::toml() const {
  if (empty()) return "";
  std::string text = "\n[sweep]\ndesign = \"grid\"\n";
  for (const Factor& factor : factors_)
    for (const Varied& varied : factor.keys) text += entry(varied);
  return text;
}

}  // namespace palpate::scenario
