// Writes the reference manual of a struct's keys in Markdown.
#include "base/field_writer.h"

#include <utility>
#include <vector>

#include "base/range_text.h"
#include "base/text.h"

namespace palpate {
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
