// The visitor that collects all keys, and the list of their paths.
#include "base/key_tree.h"

#include <algorithm>
#include <utility>

namespace palpate {
namespace {

using Kind = KeyTree::Kind;

class Collector final : public FieldVisitor {
 public:
  explicit Collector(KeyTree& root) : table_(&root), keys_(&root.keys) {}

  void real(const Key& key, std::optional<double>&, const Real& kind) override {
    KeyTree& one = add(key, kind.unit != nullptr ? Kind::quantity : Kind::number);
    if (kind.unit != nullptr) one.units = {*kind.unit};
    one.range = kind.range;
    one.open = kind.open;
  }
  void whole(const Key& key, std::optional<int>&, const Whole& kind) override {
    KeyTree& one = add(key, Kind::whole);
    one.range = kind.range;
    one.open = kind.open;
  }
  void either(const Key& key, Target&, const Unit& first, const Unit& second,
              const Range& range) override {
    KeyTree& one = add(key, Kind::quantity);
    one.units = {first, second};
    one.range = range;
  }
  void text(const Key& key, std::string&) override { add(key, Kind::text); }
  void flag(const Key& key, bool&) override { add(key, Kind::flag); }
  void quantities(const Key& key, std::span<double> si, const Unit& unit,
                  const Range& range) override {
    KeyTree& one = list(key, Kind::quantity, range);
    one.units = {unit};
    one.size = si.size();
  }
  void counts(const Key& key, std::span<int> values, const Range& range) override {
    list(key, Kind::whole, range).size = values.size();
  }
  void quantity_list(const Key& key, std::vector<double>&, const Unit& unit,
                     const Range& range) override {
    list(key, Kind::quantity, range).units = {unit};
  }
  void numbers_by_name(const Key& key, std::map<std::string, double>&,
                       const Range& range) override {
    add(key, Kind::names).range = range;
  }
  void choice_of(const Key& key, int&, std::span<const Word> words) override {
    add(key, Kind::word).words.assign(words.begin(), words.end());
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
    choose(chosen);
  }

 private:
  KeyTree& add(const Key& key, Kind kind) {
    KeyTree one{.name = key.name, .meaning = key.meaning, .kind = kind, .alternatives = {}};
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
    const auto known = std::find_if(flat.begin(), flat.end(),
                                    [&](const FlatKey& one) { return one.path == path; });
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

}  // namespace palpate
