// Writes a tree of keys as a JSON Schema, draft 7.
#include <algorithm>
#include <cmath>
#include <map>

#include "base/document_writer.h"
#include "base/key_tree.h"
#include "base/text.h"
#include "base/unit_factor.h"

namespace palpate {
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
