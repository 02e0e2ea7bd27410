// The visitor that collects all keys, and the list of their paths.
#include "base/key_tree.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/document.h"
#include "base/text.h"
#include "base/unit_factor.h"

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

namespace {

using Kind = KeyTree::Kind;

// TOML's texts in double quotes are JSON's.
std::string json_text(const std::string& text) { return toml_text(text); }

std::string any_of(std::vector<std::string> schemas) {
  std::vector<std::string> different;
  for (std::string& schema : schemas)
    if (std::find(different.begin(), different.end(), schema) == different.end())
      different.push_back(std::move(schema));
  return different.size() == 1 ? different[0] : json_object({{"anyOf", json_array(different)}});
}

std::string number(Kind kind, const Range& range) {
  JsonMembers members{{"type", kind == Kind::whole ? json_text("integer") : json_text("number")}};
  if (std::isfinite(range.low))
    members.emplace_back(range.low_allowed ? "minimum" : "exclusiveMinimum",
                         number_text(range.low));
  if (std::isfinite(range.high))
    members.emplace_back(range.high_allowed ? "maximum" : "exclusiveMaximum",
                         number_text(range.high));
  return json_object(members);
}

// A number and a unit as one text. Of the range the sign alone is checked.
std::string quantity(const KeyTree& key) {
  std::string units;
  for (const Unit& unit : key.units)
    units += (units.empty() ? "" : "|") + unit_pattern(unit.dimension);
  const std::string sign = key.range.low >= 0.0 ? "\\+?" : "[-+]?";
  return json_object({{"type", json_text("string")},
                      {"pattern", json_text("^\\s*" + sign +
                                            "([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][-+]?[0-9]+)?\\s*(" +
                                            units + ")\\s*$")}});
}

std::string one_value(const KeyTree& key, Kind kind) {
  return kind == Kind::quantity ? quantity(key) : number(kind, key.range);
}

std::string one_word(const std::string& word) { return json_object({{"const", json_text(word)}}); }

std::string table(const KeyTree& key, JsonMembers members, const JsonMembers& further);

std::string value(const KeyTree& key) {
  JsonMembers members;
  std::string meaning = key.meaning;
  switch (key.kind) {
    case Kind::number:
    case Kind::whole:
    case Kind::quantity:
      members = {{"allOf", json_array({key.open == nullptr ? one_value(key, key.kind)
                                                           : any_of({one_value(key, key.kind),
                                                                     one_word(key.open)})})}};
      break;
    case Kind::text: members = {{"type", json_text("string")}}; break;
    case Kind::flag: members = {{"type", json_text("boolean")}}; break;
    case Kind::word: {
      std::vector<std::string> words;
      for (const Word& word : key.words) {
        words.push_back(json_text(word.word));
        if (*word.meaning != '\0') meaning += std::string(" `") + word.word + "`: " + word.meaning;
      }
      members = {{"enum", json_array(words)}};
      break;
    }
    case Kind::list:
      members = {{"type", json_text("array")}, {"items", one_value(key, key.item)}};
      if (key.size) {
        members.emplace_back("minItems", std::to_string(*key.size));
        members.emplace_back("maxItems", std::to_string(*key.size));
      }
      break;
    case Kind::names:
      members = {{"type", json_text("object")},
                 {"additionalProperties", number(Kind::number, key.range)}};
      break;
    case Kind::table: return table(key, {{"description", json_text(meaning)}}, {});
    case Kind::tables:
      return json_object({{"description", json_text(meaning)},
                          {"type", json_text("array")},
                          {"items", table(key, {}, {})}});
  }
  members.insert(members.begin(), {"description", json_text(meaning)});
  return json_object(members);
}

// A table allows the keys of all its kinds; where `kind` is given, those of that kind only.
std::string table(const KeyTree& key, JsonMembers members, const JsonMembers& further) {
  std::vector<std::string> order;
  std::map<std::string, std::vector<std::string>> schemas;
  const auto add = [&](const std::string& name, const std::string& schema) {
    if (!schemas.contains(name)) order.push_back(name);
    schemas[name].push_back(schema);
  };
  std::vector<std::string> kinds;
  std::vector<std::string> conditions;
  for (const KeyTree& one : key.keys) add(one.name, value(one));
  for (const KeyTree::Alternative& alternative : key.alternatives) {
    kinds.push_back(json_text(alternative.word.word));
    std::vector<std::string> names{json_text("kind")};
    for (const KeyTree& one : alternative.keys) {
      add(one.name, value(one));
      names.push_back(json_text(one.name));
    }
    const std::string is_it = json_object({{"kind", one_word(alternative.word.word)}});
    conditions.push_back(json_object(
        {{"if",
          json_object({{"properties", is_it}, {"required", json_array({json_text("kind")})}})},
         {"then", json_object({{"propertyNames", json_object({{"enum", json_array(names)}})}})}}));
  }
  JsonMembers properties;
  if (!kinds.empty()) properties.emplace_back("kind", json_object({{"enum", json_array(kinds)}}));
  for (const std::string& name : order) properties.emplace_back(name, any_of(schemas[name]));
  properties.insert(properties.end(), further.begin(), further.end());
  members.emplace_back("type", json_text("object"));
  members.emplace_back("properties", json_object(properties));
  members.emplace_back("additionalProperties", "false");
  if (!conditions.empty()) members.emplace_back("allOf", json_array(conditions));
  return json_object(members);
}

}  // namespace

std::string json_object(const JsonMembers& members) {
  std::vector<std::string> items;
  for (const auto& [name, json] : members) items.push_back(json_text(name) + ": " + json);
  return "{" + joined(items, ", ") + "}";
}

std::string json_array(const std::vector<std::string>& items) {
  return "[" + joined(items, ", ") + "]";
}

std::string json_schema(const KeyTree& tree, const std::string& title, const JsonMembers& further) {
  return table(tree,
               {{"$schema", json_text("http://json-schema.org/draft-07/schema#")},
                {"title", json_text(title)}},
               further) +
         "\n";
}

}  // namespace palpate
