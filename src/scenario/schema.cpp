// The tree of all keys, and what [sweep] adds to it.
#include "scenario/schema.h"

#include "material/tissue_table.h"
#include "scenario/design.h"
#include "scenario/scenario.h"

namespace palpate::scenario {
namespace {

KeyTree tree() {
  Scenario scenario;
  return fields_as_tree([&](FieldVisitor& visitor) { fields(visitor, scenario); });
}

// design_read.cpp checks the keys of [sweep] by their names, which are other keys' paths.
std::string sweep_schema() {
  std::vector<std::string> designs;
  for (const std::string& word : design_words()) designs.push_back("\"" + word + "\"");
  const auto whole = [](const char* least) {
    return json_object({{"type", "\"integer\""}, {"minimum", least}});
  };
  const std::string lists = json_object({{"type", R"(["array", "object"])"}});
  return json_object(
      {{"description", "\"Makes a family of cases: lists or ranges of values, by a key's path.\""},
       {"type", "\"object\""},
       {"properties",
        json_object(
            {{"design", json_object({{"enum", json_array(designs)}})},
             {"samples", whole("1")},
             {"seed", whole("0")},
             {"file", json_object({{"type", "\"string\""}})},
             {"rows", json_object({{"type", "\"array\""},
                                   {"items", json_object({{"type", "\"object\""},
                                                          {"additionalProperties", lists}})}})}})},
       {"additionalProperties", lists}});
}

}  // namespace

std::string schema() {
  return json_schema(tree(), "A scenario of palpate", {{"sweep", sweep_schema()}});
}

std::vector<FlatKey> settable_keys() {
  std::vector<FlatKey> keys = flat_keys(tree());
  for (FlatKey& key : keys) {
    if (!key.path.ends_with("material")) continue;
    for (const auto& [name, title] : material::builtin())
      key.words.push_back({name.c_str(), title.c_str()});
    if (key.path == "finger.material") key.words.push_back({"rigid", "undeformed"});
  }
  return keys;
}

}  // namespace palpate::scenario
