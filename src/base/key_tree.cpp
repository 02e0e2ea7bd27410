// The visitor that collects all keys, the list of their paths, and the manual.
#include "base/key_tree.h"

#include <algorithm>
#include <utility>

#include "base/text.h"
#include "base/units.h"

namespace palpate {
namespace {

using Kind = KeyTree::Kind;

class Collector final : public FieldVisitor {
 public:
  explicit Collector(KeyTree& root) : table_(&root), keys_(&root.keys) {}

  void real(const Key& key, std::optional<double>& value, const Real& kind) override {
    KeyTree& one = add(key, kind.unit != nullptr ? Kind::quantity : Kind::number);
    if (kind.unit != nullptr) one.units = {*kind.unit};
    one.range = kind.range;
    one.open = kind.open;
    if (value)
      one.fallback = kind.unit != nullptr ? quantity_text(*value, *kind.unit) : number_text(*value);
    else if (kind.open != nullptr)
      one.fallback = kind.open;
  }
  void whole(const Key& key, std::optional<int>& value, const Whole& kind) override {
    KeyTree& one = add(key, Kind::whole);
    one.range = kind.range;
    one.open = kind.open;
    one.fallback = value ? std::to_string(*value) : kind.open;
  }
  void either(const Key& key, Target& target, const Unit& first, const Unit& second,
              const Range& range) override {
    KeyTree& one = add(key, Kind::quantity);
    one.units = {first, second};
    one.range = range;
    one.fallback = quantity_text(target.value, target.second ? second : first);
  }
  void text(const Key& key, std::string& value) override { add(key, Kind::text).fallback = value; }
  void flag(const Key& key, bool& value) override {
    add(key, Kind::flag).fallback = value ? "true" : "false";
  }
  void quantities(const Key& key, std::span<double> si, const Unit& unit,
                  const Range& range) override {
    KeyTree& one = list(key, Kind::quantity, range);
    one.units = {unit};
    one.size = si.size();
    for (const double value : si)
      one.fallback += (one.fallback.empty() ? "" : ", ") + quantity_text(value, unit);
  }
  void counts(const Key& key, std::span<int> values, const Range& range) override {
    KeyTree& one = list(key, Kind::whole, range);
    one.size = values.size();
    for (const int value : values)
      one.fallback += (one.fallback.empty() ? "" : ", ") + std::to_string(value);
  }
  void quantity_list(const Key& key, std::vector<double>&, const Unit& unit,
                     const Range& range) override {
    list(key, Kind::quantity, range).units = {unit};
  }
  void numbers_by_name(const Key& key, std::map<std::string, double>&,
                       const Range& range) override {
    add(key, Kind::names).range = range;
  }
  void choice_of(const Key& key, int& index, std::span<const Word> words) override {
    KeyTree& one = add(key, Kind::word);
    one.words.assign(words.begin(), words.end());
    one.fallback = words[as_index(index)].word;
  }
  void table(const Key& key, const Fields& fields) override {
    inside(add(key, Kind::table), [&] { fields(*this); });
  }
  void tables(const Key& key, int, const std::function<void(int)>& resize,
              const std::function<void(FieldVisitor&, int)>& fields) override {
    resize(1);
    inside(add(key, Kind::tables), [&] { fields(*this, 0); });
    resize(0);
  }
  void kind(int chosen, std::span<const Word> words,
            const std::function<Fields(int)>& choose) override {
    KeyTree& table = *table_;
    for (std::size_t i = 0; i < words.size(); ++i) {
      std::vector<KeyTree> keys;
      keys_ = &keys;
      choose(static_cast<int>(i))(*this);
      table.alternatives.push_back({words[i], std::move(keys)});
    }
    keys_ = &table.keys;
    table.chosen = chosen;
    choose(chosen);
  }

 private:
  KeyTree& add(const Key& key, Kind kind) {
    KeyTree one{.name = key.name,
                .meaning = key.meaning,
                .of_the_paper = key.of_the_paper,
                .kind = kind,
                .alternatives = {}};
    if (!key.use.when.empty()) one.meaning += " Used only " + key.use.when + ".";
    keys_->push_back(std::move(one));
    return keys_->back();
  }
  KeyTree& list(const Key& key, Kind item, const Range& range) {
    KeyTree& one = add(key, Kind::list);
    one.item = item;
    one.range = range;
    return one;
  }
  void inside(KeyTree& table, const std::function<void()>& visit) {
    KeyTree* const outer = std::exchange(table_, &table);
    std::vector<KeyTree>* const outer_keys = std::exchange(keys_, &table.keys);
    visit();
    table_ = outer;
    keys_ = outer_keys;
  }

  KeyTree* table_;
  std::vector<KeyTree>* keys_;
};

void flatten(const KeyTree& table, const std::string& prefix, std::vector<FlatKey>& flat) {
  const auto add = [&](const std::string& path, const std::string& meaning,
                       const std::vector<Word>& words) {
    const auto known = std::ranges::find(flat, path, &FlatKey::path);
    if (known == flat.end()) flat.push_back({path, meaning, words});
  };
  const auto add_all = [&](const std::vector<KeyTree>& keys) {
    for (const KeyTree& key : keys) {
      if (key.kind == Kind::table)
        flatten(key, prefix + key.name + ".", flat);
      else if (key.kind == Kind::tables)
        flatten(key, prefix + key.name + ".1.", flat);
      else if (key.kind == Kind::flag)
        add(prefix + key.name, key.meaning, {{"true", ""}, {"false", ""}});
      else if (key.open != nullptr)
        add(prefix + key.name, key.meaning, {{key.open, "or a number"}});
      else
        add(prefix + key.name, key.meaning, key.words);
    }
  };
  if (!table.alternatives.empty()) {
    std::vector<Word> kinds;
    for (const KeyTree::Alternative& one : table.alternatives) kinds.push_back(one.word);
    if (kinds.size() > 1) add(prefix + "kind", table.meaning, kinds);
  }
  add_all(table.keys);
  for (const KeyTree::Alternative& one : table.alternatives) add_all(one.keys);
}

}  // namespace

KeyTree fields_as_tree(const Fields& fields) {
  KeyTree root;
  Collector collector(root);
  fields(collector);
  return root;
}

std::vector<FlatKey> flat_keys(const KeyTree& tree) {
  std::vector<FlatKey> flat;
  flatten(tree, "", flat);
  return flat;
}

namespace {

// Which values a key takes, as a cell of the manual's tables.
std::string values_of(const KeyTree& key) {
  const auto limited = [&](const std::string& what, const Unit* unit) {
    const std::string bounds = range_text(key.range, unit, {">= ", "> ", "<= ", "< ", "= "});
    return what + (bounds.empty() ? "" : " ") + bounds;
  };
  const std::string or_word = key.open != nullptr ? "`\"" + std::string(key.open) + "\"` or " : "";
  switch (key.kind) {
    case Kind::number: return or_word + limited("number", nullptr);
    case Kind::whole: return or_word + limited("whole number", nullptr);
    case Kind::quantity:
      return or_word + limited(key.units[0].quantity, key.units.data()) +
             (key.units.size() > 1 ? std::string(" or ") + key.units[1].quantity : "");
    case Kind::text: return "text";
    case Kind::flag: return "`true` or `false`";
    case Kind::word: {
      std::string words;
      for (const Word& word : key.words)
        words += (words.empty() ? "`\"" : "<br>`\"") + std::string(word.word) + "\"`" +
                 (*word.meaning != '\0' ? ": " : "") + word.meaning;
      return words;
    }
    case Kind::list:
      if (!key.size)
        return limited(std::string("list, each a ") + key.units[0].quantity, &key.units[0]);
      return "list of " + std::to_string(*key.size) +
             (key.item == Kind::whole
                  ? limited(" whole numbers", nullptr)
                  : limited(std::string(" times ") + key.units[0].quantity, key.units.data()));
    case Kind::names: return limited("table of name = number", nullptr);
    case Kind::table:
    case Kind::tables: break;
  }
  return "";
}

constexpr const char* table_head =
    "\n| key | value | default | meaning |\n| --- | --- | --- | --- |\n";

// A section with a row for every key, then those of the tables in it; rows of keys for comparisons
// with the paper are added to `of_the_paper`.
void add_sections(const std::string& title, const std::string& meaning, const std::string& path,
                  const std::vector<KeyTree>& keys, std::string& text, std::string& of_the_paper) {
  const auto is_table = [](const KeyTree& key) {
    return key.kind == Kind::table || key.kind == Kind::tables;
  };
  text += "\n## " + title + "\n";
  if (!meaning.empty()) text += "\n" + meaning + "\n";
  if (!std::ranges::all_of(keys, is_table)) text += table_head;
  for (const KeyTree& key : keys)
    if (!is_table(key))
      (key.of_the_paper ? of_the_paper : text) +=
          "| `" + (key.of_the_paper ? path + "." : "") + key.name + "` | " + values_of(key) +
          " | " + (key.fallback.empty() ? "" : "`" + key.fallback + "`") + " | " + key.meaning +
          " |\n";
  for (const KeyTree& key : keys) {
    if (!is_table(key)) continue;
    const std::string name = path.empty() ? key.name : path + "." + key.name;
    add_sections(key.kind == Kind::table ? "`[" + name + "]`" : "`[[" + name + "]]`", key.meaning,
                 name, key.keys, text, of_the_paper);
    for (std::size_t i = 0; i < key.alternatives.size(); ++i) {
      const Word& word = key.alternatives[i].word;
      const bool is_default = as_index(key.chosen) == i && key.alternatives.size() > 1;
      add_sections(
          "`" + name + "`, `kind = \"" + word.word + "\"`" + (is_default ? " (default)" : ""),
          word.meaning, name, key.alternatives[i].keys, text, of_the_paper);
    }
  }
}

}  // namespace

std::string manual_of(const KeyTree& tree) {
  std::string text, of_the_paper;
  add_sections("Top level", "", "", tree.keys, text, of_the_paper);
  if (of_the_paper.empty()) return text;
  return text +
         "\n## Comparisons with the paper\n\nThese keys choose what the paper does, or what fails. "
         "Other scenarios do not need them.\n\n<details markdown=\"1\"><summary>The "
         "keys</summary>\n" +
         table_head + of_the_paper + "\n</details>\n";
}

}  // namespace palpate
