// Writes the echo: first the top-level keys, then each table; tables inside tables are inline.
#include "base/field_writer.h"

#include <cmath>
#include <utility>
#include <vector>

#include "base/document.h"
#include "base/text.h"

namespace palpate {

std::string range_text(const Range& range, const Unit* unit, const RangeWords& words) {
  const auto bound = [&](double value) {
    return unit != nullptr ? quantity_text(value, *unit) : number_text(value);
  };
  std::string text;
  if (range.low == range.high) return words.equal + bound(range.low);
  if (std::isfinite(range.low))
    text += (range.low_allowed ? words.at_least : words.above) + bound(range.low);
  if (std::isfinite(range.high)) {
    if (!text.empty()) text += " and ";
    text += (range.high_allowed ? words.at_most : words.below) + bound(range.high);
  }
  return text;
}

namespace {

class Writer final : public FieldVisitor {
 public:
  explicit Writer(Written written) : all_(written == Written::all) {}

  [[nodiscard]] std::string result() const { return top_ + tables_; }

  void real(const Key& key, std::optional<double>& value, const Real& kind) override {
    if (value)
      put(key, kind.unit != nullptr ? toml_text(quantity_text(*value, *kind.unit))
                                    : number_text(*value));
    else if (kind.open != nullptr)
      put(key, toml_text(kind.open));
  }
  void whole(const Key& key, std::optional<int>& value, const Whole& kind) override {
    put(key, value ? std::to_string(*value) : toml_text(kind.open));
  }
  void either(const Key& key, Target& target, const Unit& first, const Unit& second,
              const Range&) override {
    put(key, toml_text(quantity_text(target.value, target.second ? second : first)));
  }
  void text(const Key& key, std::string& value) override { put(key, toml_text(value)); }
  void flag(const Key& key, bool& value) override { put(key, value ? "true" : "false"); }
  void quantities(const Key& key, std::span<double> si, const Unit& unit, const Range&) override {
    std::vector<std::string> items;
    for (const double value : si) items.push_back(toml_text(quantity_text(value, unit)));
    put(key, "[" + joined(items, ", ") + "]");
  }
  void counts(const Key& key, std::span<int> values, const Range&) override {
    std::vector<std::string> items;
    for (const int value : values) items.push_back(std::to_string(value));
    put(key, "[" + joined(items, ", ") + "]");
  }
  void quantity_list(const Key& key, std::vector<double>& si, const Unit& unit,
                     const Range& range) override {
    if (!si.empty()) quantities(key, si, unit, range);
  }
  void numbers_by_name(const Key& key, std::map<std::string, double>& values,
                       const Range&) override {
    std::vector<std::string> items;
    for (const auto& [name, value] : values)
      items.push_back(toml_key(name) + " = " + number_text(value));
    if (!items.empty()) put(key, "{ " + joined(items, ", ") + " }");
  }
  void choice_of(const Key& key, int& index, std::span<const Word> words) override {
    put(key, toml_text(words[as_index(index)].word));
  }
  void table(const Key& key, const Fields& fields) override {
    if (!all_ && !key.use.used) return;
    std::vector<std::string> before;
    before.swap(entries_);
    ++depth_;
    fields(*this);
    --depth_;
    before.swap(entries_);
    if (depth_ == 0)
      tables_ += "\n[" + std::string(key.name) + "]\n" + lines(before);
    else
      put(key, "{ " + joined(before, ", ") + " }");
  }
  void tables(const Key& key, int size, const std::function<void(int)>&,
              const std::function<void(FieldVisitor&, int)>& fields) override {
    if (depth_ > 0) {
      if (size > 0) put(key, inline_tables(size, fields));
      return;
    }
    for (int i = 0; i < size; ++i) {
      ++depth_;
      fields(*this, i);
      --depth_;
      tables_ += "\n[[" + std::string(key.name) + "]]\n" + lines(entries_);
      entries_.clear();
    }
  }
  void kind(int chosen, std::span<const Word> words,
            const std::function<Fields(int)>& choose) override {
    put({"kind", ""}, toml_text(words[as_index(chosen)].word));
    choose(chosen)(*this);
  }

 private:
  // A list of tables inside a table, on one line.
  std::string inline_tables(int size, const std::function<void(FieldVisitor&, int)>& fields) {
    std::vector<std::string> items;
    for (int i = 0; i < size; ++i) {
      std::vector<std::string> before;
      before.swap(entries_);
      ++depth_;
      fields(*this, i);
      --depth_;
      before.swap(entries_);
      items.push_back("{ " + joined(before, ", ") + " }");
    }
    return "[" + joined(items, ", ") + "]";
  }

  void put(const Key& key, const std::string& value) {
    if (!all_ && !key.use.used) return;
    const std::string entry = std::string(key.name) + " = " + value;
    if (depth_ == 0)
      top_ += entry + "\n";
    else
      entries_.push_back(entry);
  }

  static std::string lines(const std::vector<std::string>& entries) {
    std::string text;
    for (const std::string& entry : entries) text += entry + "\n";
    return text;
  }

  bool all_;
  int depth_ = 0;
  std::string top_;
  std::string tables_;
  std::vector<std::string> entries_;
};

}  // namespace

std::string fields_as_toml(const Fields& fields, Written written) {
  Writer writer(written);
  fields(writer);
  return writer.result();
}

namespace {

class Manual final : public FieldVisitor {
 public:
  Manual() { sections_.push_back({"Top level", "", {}}); }

  [[nodiscard]] std::string result() const {
    std::string text;
    for (const Section& section : sections_) {
      text += "\n## " + section.title + "\n";
      if (!section.meaning.empty()) text += "\n" + section.meaning + "\n";
      if (section.rows.empty()) continue;
      text += "\n| key | value | default | meaning |\n| --- | --- | --- | --- |\n";
      for (const std::string& row : section.rows) text += row + "\n";
    }
    return text;
  }

  void real(const Key& key, std::optional<double>& value, const Real& kind) override {
    const std::string number = kind.unit != nullptr ? kind.unit->quantity : "number";
    std::string fallback = kind.open != nullptr ? kind.open : "";
    if (value)
      fallback = kind.unit != nullptr ? quantity_text(*value, *kind.unit) : number_text(*value);
    row(key, or_word(kind.open) + number + bounds(kind.range, kind.unit), fallback);
  }
  void whole(const Key& key, std::optional<int>& value, const Whole& kind) override {
    row(key, or_word(kind.open) + "whole number" + bounds(kind.range, nullptr),
        value ? std::to_string(*value) : kind.open);
  }
  void either(const Key& key, Target& target, const Unit& first, const Unit& second,
              const Range& range) override {
    row(key, std::string(first.quantity) + bounds(range, &first) + " or " + second.quantity,
        quantity_text(target.value, target.second ? second : first));
  }
  void text(const Key& key, std::string& value) override { row(key, "text", value); }
  void flag(const Key& key, bool& value) override {
    row(key, "`true` or `false`", value ? "true" : "false");
  }
  void quantities(const Key& key, std::span<double> si, const Unit& unit,
                  const Range& range) override {
    std::vector<std::string> items;
    for (const double value : si) items.push_back(quantity_text(value, unit));
    row(key,
        "list of " + std::to_string(si.size()) + " times " + unit.quantity + bounds(range, &unit),
        joined(items, ", "));
  }
  void counts(const Key& key, std::span<int> values, const Range& range) override {
    std::vector<std::string> items;
    for (const int value : values) items.push_back(std::to_string(value));
    row(key, "list of " + std::to_string(values.size()) + " whole numbers" + bounds(range, nullptr),
        joined(items, ", "));
  }
  void quantity_list(const Key& key, std::vector<double>&, const Unit& unit,
                     const Range& range) override {
    row(key, "list, each a " + (unit.quantity + bounds(range, &unit)), "");
  }
  void numbers_by_name(const Key& key, std::map<std::string, double>&,
                       const Range& range) override {
    row(key, "table of name = number" + bounds(range, nullptr), "");
  }
  void choice_of(const Key& key, int& index, std::span<const Word> words) override {
    std::string values;
    for (const Word& word : words) {
      if (!values.empty()) values += "<br>";
      values += "`\"" + std::string(word.word) + "\"`";
      if (*word.meaning != '\0') values += ": " + std::string(word.meaning);
    }
    row(key, values, words[as_index(index)].word);
  }
  void table(const Key& key, const Fields& fields) override {
    const std::string name = prefix_.empty() ? key.name : prefix_ + "." + key.name;
    section("`[" + name + "]`", key.meaning, name, fields);
  }
  void tables(const Key& key, int, const std::function<void(int)>& resize,
              const std::function<void(FieldVisitor&, int)>& fields) override {
    const std::string name = prefix_.empty() ? key.name : prefix_ + "." + key.name;
    resize(1);
    section("`[[" + name + "]]`", key.meaning, name,
            [&](FieldVisitor& visitor) { fields(visitor, 0); });
    resize(0);
  }
  void kind(int chosen, std::span<const Word> words,
            const std::function<Fields(int)>& choose) override {
    const std::string name = prefix_;
    for (int i = 0; i < static_cast<int>(words.size()); ++i) {
      const Word& word = words[as_index(i)];
      const std::string title = "`" + name + "`, `kind = \"" + std::string(word.word) + "\"`" +
                                (i == chosen && words.size() > 1 ? " (default)" : "");
      section(title, word.meaning, name, choose(i));
    }
    choose(chosen);
  }

 private:
  struct Section {
    std::string title;
    std::string meaning;
    std::vector<std::string> rows;
  };

  // Sections are listed in the order in which they are opened; rows go to the innermost one.
  void section(const std::string& title, const std::string& meaning, const std::string& name,
               const Fields& fields) {
    const std::size_t outer = current_;
    const std::string outer_prefix = std::exchange(prefix_, name);
    sections_.push_back({title, meaning, {}});
    current_ = sections_.size() - 1;
    fields(*this);
    current_ = outer;
    prefix_ = outer_prefix;
  }

  static std::string or_word(const char* word) {
    return word != nullptr ? "`\"" + std::string(word) + "\"` or " : "";
  }

  static std::string bounds(const Range& range, const Unit* unit) {
    const std::string text = range_text(range, unit, {">= ", "> ", "<= ", "< ", "= "});
    return text.empty() ? text : " " + text;
  }

  void row(const Key& key, const std::string& value, const std::string& fallback) {
    std::string meaning = key.meaning;
    if (!key.use.when.empty()) meaning += " Used only " + key.use.when + ".";
    sections_[current_].rows.push_back("| `" + std::string(key.name) + "` | " + value + " | " +
                                       (fallback.empty() ? "" : "`" + fallback + "`") + " | " +
                                       meaning + " |");
  }

  std::vector<Section> sections_;
  std::size_t current_ = 0;
  std::string prefix_;
};

}  // namespace

std::string fields_as_manual(const Fields& fields) {
  Manual manual;
  fields(manual);
  return manual.result();
}

}  // namespace palpate
