// The tree of all keys, and what [sweep] adds to it; starters.
#include "scenario/schema.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/text.h"
#include "material/tissue_table.h"
#include "scenario/design.h"
#include "scenario/family.h"
#include "scenario/scenario.h"

namespace palpate::scenario {

// Of scenario/texts/. Their first line makes editors with Taplo check them against `palpate schema
// > palpate.schema.json`.
extern const std::string_view press_text, creep_text, relax_text, compress_text, organ_text,
    sweep_text, live_text;

namespace {

KeyTree all_keys() {
  Scenario scenario;
  return fields_as_tree([&](FieldVisitor& visitor) { fields(visitor, scenario); });
}

using Json = nlohmann::ordered_json;
using KeyKind = KeyTree::Kind;

Json any_schema(const std::vector<Json>& schemas) {
  Json different = Json::array();
  for (const Json& schema : schemas)
    if (std::ranges::find(different, schema) == different.end()) different.push_back(schema);
  return different.size() == 1 ? different[0] : Json{{"anyOf", different}};
}

Json number_schema(KeyKind kind, const Range& range) {
  Json schema{{"type", kind == KeyKind::whole ? "integer" : "number"}};
  if (std::isfinite(range.low))
    schema[range.low_allowed ? "minimum" : "exclusiveMinimum"] = range.low;
  if (std::isfinite(range.high))
    schema[range.high_allowed ? "maximum" : "exclusiveMaximum"] = range.high;
  return schema;
}

// Of a quantity, a number and a unit as one text, the sign alone is checked of the range.
Json one_schema(const KeyTree& key, KeyKind kind) {
  if (kind != KeyKind::quantity) return number_schema(kind, key.range);
  std::string units;
  for (const Unit& unit : key.units)
    units += (units.empty() ? "" : "|") + unit_pattern(unit.dimension);
  const std::string sign = key.range.low >= 0.0 ? "\\+?" : "[-+]?";
  return {{"type", "string"},
          {"pattern", "^\\s*" + sign + "([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][-+]?[0-9]+)?\\s*(" +
                          units + ")\\s*$"}};
}

Json table_schema(const KeyTree& key);

Json value_schema(const KeyTree& key) {
  Json schema{{"description", key.meaning}};
  switch (key.kind) {
    case KeyKind::number:
    case KeyKind::whole:
    case KeyKind::quantity:
      schema["allOf"] = Json::array(
          {key.open == nullptr ? one_schema(key, key.kind)
                               : any_schema({one_schema(key, key.kind), {{"const", key.open}}})});
      break;
    case KeyKind::text: schema["type"] = "string"; break;
    case KeyKind::flag: schema["type"] = "boolean"; break;
    case KeyKind::word: {
      std::string meaning = key.meaning;
      for (const Word& word : key.words) {
        schema["enum"].push_back(word.word);
        if (*word.meaning != '\0') meaning += std::string(" `") + word.word + "`: " + word.meaning;
      }
      schema["description"] = meaning;
      break;
    }
    case KeyKind::list:
      schema["type"] = "array";
      schema["items"] = one_schema(key, key.item);
      if (!key.size) break;
      schema["minItems"] = *key.size;
      schema["maxItems"] = *key.size;
      break;
    case KeyKind::names:
      schema["type"] = "object";
      schema["additionalProperties"] = number_schema(KeyKind::number, key.range);
      break;
    case KeyKind::table: schema.update(table_schema(key)); break;
    case KeyKind::tables: schema["type"] = "array"; schema["items"] = table_schema(key);
  }
  return schema;
}

// A table allows the keys of all its kinds; where `kind` is given, those of that kind only.
Json table_schema(const KeyTree& key) {
  Json kinds, conditions;
  std::vector<std::pair<std::string, std::vector<Json>>> schemas;
  const auto add = [&](const KeyTree& one) {
    auto known =
        std::ranges::find_if(schemas, [&](const auto& other) { return other.first == one.name; });
    if (known == schemas.end()) known = schemas.insert(known, {one.name, {}});
    known->second.push_back(value_schema(one));
  };
  for (const KeyTree& one : key.keys) add(one);
  for (const KeyTree::Alternative& alternative : key.alternatives) {
    kinds.push_back(alternative.word.word);
    Json names = Json::array({"kind"});
    for (const KeyTree& one : alternative.keys) {
      add(one);
      names.push_back(one.name);
    }
    conditions.push_back({{"if",
                           {{"properties", {{"kind", {{"const", alternative.word.word}}}}},
                            {"required", Json::array({"kind"})}}},
                          {"then", {{"propertyNames", {{"enum", names}}}}}});
  }
  Json schema{{"type", "object"}, {"properties", Json::object()}, {"additionalProperties", false}};
  if (!kinds.empty()) schema["properties"]["kind"] = {{"enum", kinds}};
  for (const auto& [name, all] : schemas) schema["properties"][name] = any_schema(all);
  if (!conditions.empty()) schema["allOf"] = conditions;
  return schema;
}

// design_read.cpp checks the keys of [sweep] by their names, which are other keys' paths.
Json sweep_schema() {
  const auto whole = [](int least) { return Json{{"type", "integer"}, {"minimum", least}}; };
  const Json lists{{"type", {"array", "object"}}};
  return {
      {"description", "Makes a family of cases: lists or ranges of values, by a key's path."},
      {"type", "object"},
      {"properties",
       {{"design", {{"enum", design_words()}}},
        {"samples", whole(1)},
        {"seed", whole(0)},
        {"file", {{"type", "string"}}},
        {"rows",
         {{"type", "array"}, {"items", {{"type", "object"}, {"additionalProperties", lists}}}}}}},
      {"additionalProperties", lists}};
}

}  // namespace

std::string schema() {
  Json schema{{"$schema", "http://json-schema.org/draft-07/schema#"},
              {"title", "A scenario of palpate"}};
  schema.update(table_schema(all_keys()));
  schema["properties"]["sweep"] = sweep_schema();
  return schema.dump() + "\n";
}

std::vector<FlatKey> settable_keys() {
  std::vector<FlatKey> keys = flat_keys(all_keys());
  for (FlatKey& key : keys) {
    if (!key.path.ends_with("material")) continue;
    for (const auto& [name, title] : material::builtin())
      key.words.push_back({name.c_str(), title.c_str()});
    if (key.path == "finger.material") key.words.push_back({"rigid", "undeformed"});
  }
  return keys;
}

namespace {

// The key as the manual names it: `step.to` for `step.1.to`.
std::string without_numbers(const std::string& key) {
  std::vector<std::string> words = split(key, '.');
  std::erase_if(words, [](const std::string& word) { return whole_number(word).has_value(); });
  return joined(words, ".");
}

// The path of the key of a row, below the heading of its section, such as "`[tissue.mesh]`"; rows
// below a heading without a table have whole paths.
std::string path_of(const std::string& row, const std::string& section) {
  std::string name = row.substr(3, row.find('`', 3) - 3);
  const auto quotes = split(section, '`');
  if (quotes.size() < 2) return name;
  std::string table = quotes[1];
  std::erase_if(table, [](char c) { return c == '[' || c == ']'; });
  return table + "." + name;
}

// What the key `kind` of a table may be, from the titles of the manual's sections, such as
// "`step`, `kind = "hold"`"; empty if no table of this name has kinds. Adds the keys to `known`.
std::string kinds(const std::string& key, std::vector<std::string>& known) {
  std::string found;
  std::string last;
  const std::vector<std::string> lines = split(manual(), '\n');
  for (std::size_t i = 0; i + 2 < lines.size(); ++i) {
    const auto quotes = split(lines[i], '`');
    if (!lines[i].starts_with("## `") || quotes.size() < 4 || !quotes[3].starts_with("kind = "))
      continue;
    const std::string path = quotes[1] + ".kind";
    known.push_back(path);
    if (key != path && key != "kind") continue;
    if (path != last) found += "`" + path + "`\n";
    last = path;
    const bool plain = lines[i + 2].starts_with('|') || lines[i + 2].starts_with('#');
    found += "  " + quotes[3].substr(7) + quotes[4] + (plain ? "" : ": " + lines[i + 2]) + "\n";
  }
  return found;
}

// The rows of the manual that have a word of their own like this one, with the paths of their keys.
std::string keys_that_name(const std::string& word) {
  std::string section;
  std::string found;
  for (const std::string& line : split(manual(), '\n')) {
    if (line.starts_with("## ")) section = line.substr(3);
    const std::vector<std::string> cells = split(line, '|');
    if (!line.starts_with("| `") || cells.size() < 6 || word.size() < 3) continue;
    const std::string text = lower_case(cells[2] + cells[4]);
    const auto letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
      const std::size_t end = at + word.size();
      if ((at > 0 && letter(text[at - 1])) || (end < text.size() && letter(text[end]))) continue;
      found += "  " + path_of(line, section) + ": " + trimmed(cells[4]) + "\n";
      break;
    }
  }
  return found;
}

}  // namespace

std::string meaning_of_key(const std::string& asked) {
  const std::string key = without_numbers(asked);
  std::string section;
  std::string found;
  std::vector<std::string> known;
  if (std::string text = kinds(key, known); !text.empty()) return text;
  for (const std::string& line : split(manual(), '\n')) {
    if (line.starts_with("## ")) section = line.substr(3);
    if (!line.starts_with("| `")) continue;
    const std::string path = path_of(line, section);
    const std::size_t dot = path.rfind('.');
    const std::string name = path.substr(dot + 1);
    const std::string table = dot == std::string::npos ? "" : path.substr(0, dot);
    known.insert(known.end(), {path, name, table});
    if (key != path && key != name && (key.empty() || key != table)) continue;
    const auto cells = split(line, '|');
    if (cells.size() < 6) {  // a word with its meaning, such as a design of `[sweep]`
      found += section + ": " + trimmed(cells[1]) + "\n  " + trimmed(cells[2]) + "\n";
      continue;
    }
    std::string value = trimmed(cells[2]);
    for (std::size_t at = value.find("<br>"); at != std::string::npos; at = value.find("<br>"))
      value.replace(at, 4, "\n           ");
    found += section + ": " + trimmed(cells[1]) + "\n  value:   " + value +
             "\n  default: " + trimmed(cells[3]) + "\n  " + trimmed(cells[4]) + "\n";
  }
  if (!found.empty()) return found;
  if (const std::string table = material::builtin_table(key); !table.empty())
    return "`" + key + "` is a built-in value of `tissue.material`:\n" + table;
  if (const std::string keys = keys_that_name(key); !keys.empty())
    return "`" + key + "` is no key; these have to do with it:\n" + keys;
  refuse("`" + asked + "` is neither a file nor a key; " +
         did_you_mean(key, known, "`palpate manual` lists all keys"));
}

std::span<const Starter> starters() {
  static const std::array all{
      Starter{{"press", "a finger presses, waits and withdraws"}, press_text},
      Starter{{"creep", "a constant stress: strain over time"}, creep_text},
      Starter{{"relax", "a constant strain: stress over time"}, relax_text},
      Starter{{"compress", "a strain that grows: stress over strain"}, compress_text},
      Starter{{"organ", "a body of its own shape, with a stiff inclusion"}, organ_text},
      Starter{{"sweep", "a family of cases"}, sweep_text},
      Starter{{"live", "a press by a test stand"}, live_text},
  };
  return all;
}

}  // namespace palpate::scenario
