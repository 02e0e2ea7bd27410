// The tree of all keys, and what [sweep] adds to it.
#include "scenario/schema.h"

#include <cctype>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "material/tissue_table.h"
#include "scenario/design.h"
#include "scenario/family.h"
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

namespace {

// The key as the manual names it: `step.to` for `step.1.to`.
std::string without_numbers(const std::string& key) {
  std::vector<std::string> words = split(key, '.');
  std::erase_if(words, [](const std::string& word) { return whole_number(word).has_value(); });
  return joined(words, ".");
}

// The table in the heading of a section of the manual: `tissue.mesh` from "`[tissue.mesh]`".
std::string table_of(const std::string& section) {
  const auto quotes = split(section, '`');
  if (quotes.size() < 2) return "";
  std::string table = quotes[1];
  std::erase_if(table, [](char c) { return c == '[' || c == ']'; });
  return table;
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
      const std::string name = line.substr(3, line.find('`', 3) - 3);
      const std::string table = table_of(section);
      found += "  " + (table.empty() ? name : table + "." + name) + ": " + trimmed(cells[4]) + "\n";
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
    const std::string name = line.substr(3, line.find('`', 3) - 3);
    const std::string table = table_of(section);
    const std::string path = table.empty() ? name : table + "." + name;
    known.insert(known.end(), {path, name, table});
    if (key != path && key != name && (key.empty() || key != table)) continue;
    const auto cells = split(line, '|');
    if (cells.size() < 6) {  // a word with its meaning, such as a design of `[sweep]`
      found += section + ": `" + name + "`\n  " + trimmed(cells[2]) + "\n";
      continue;
    }
    std::string value = trimmed(cells[2]);
    for (std::size_t at = value.find("<br>"); at != std::string::npos; at = value.find("<br>"))
      value.replace(at, 4, "\n           ");
    found += section + ": `" + name + "`\n  value:   " + value +
             "\n  default: " + trimmed(cells[3]) + "\n  " + trimmed(cells[4]) + "\n";
  }
  if (!found.empty()) return found;
  if (const std::string table = material::builtin_table(key); !table.empty())
    return "`" + key + "` is a built-in value of `tissue.material`:\n" + table;
  if (const std::string keys = keys_that_name(key); !keys.empty())
    return "`" + key + "` is no key; these have to do with it:\n" + keys;
  const auto near = nearest(key, known);
  refuse("`" + asked + "` is neither a file nor a key" +
         (near ? "; did you mean `" + *near + "`?" : "; `palpate manual` lists all keys"));
}

}  // namespace palpate::scenario
