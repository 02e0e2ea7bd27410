// From a TOML text to cases.
#include "scenario/family.h"

#include <algorithm>
#include <filesystem>
#include <set>

#include "base/field_reader.h"
#include "base/files.h"
#include "base/text.h"

namespace palpate::scenario {
namespace {

constexpr std::size_t most_cases = 1000;

struct Swept {
  std::string key;
  Place place;
  std::vector<Node> values;
};

bool from_command_line(const Place& place) { return place.line == 0; }

void add_swept(const std::string& key, const Member& entry, std::vector<Swept>& sweep) {
  const Node& value = entry.value;
  if (value.kind == Node::Kind::table) {  // `tissue.material = [...]` without quotes
    for (const Member& inner : value.members) add_swept(key + "." + inner.key, inner, sweep);
    if (!value.members.empty()) return;
  }
  if (value.kind != Node::Kind::array || value.items.empty()) {
    const std::string got = value.kind == Node::Kind::array ? "an empty one" : value.kind_name();
    throw InputError(value.place, "`" + key + "` wants a list of values to run, got " + got +
                                      "; write `\"" + key + "\" = [\"...\", \"...\"]`");
  }
  const auto same = [&](const Swept& other) { return other.key == key; };
  const auto known = std::find_if(sweep.begin(), sweep.end(), same);
  if (known != sweep.end() && !from_command_line(entry.place))
    throw InputError(entry.place, "`" + key + "` is swept twice; keep one of the two");
  if (known != sweep.end())
    *known = {key, entry.place, value.items};
  else
    sweep.push_back({key, entry.place, value.items});
}

// Takes [sweep] out of the document.
std::vector<Swept> take_sweep(Node& document) {
  const Member* member = document.find("sweep");
  if (member == nullptr) return {};
  const Node table = member->value;
  std::erase_if(document.members, [](const Member& m) { return m.key == "sweep"; });
  if (table.kind != Node::Kind::table)
    throw InputError(table.place, "`sweep` wants a table of keys and lists, got " +
                                      table.kind_name() + "; write `[sweep]`");
  std::vector<Swept> sweep;
  for (const Member& entry : table.members) {
    const Node& value = entry.value;
    if (entry.key != "design")
      add_swept(entry.key, entry, sweep);
    else if (value.kind != Node::Kind::text || value.text != "grid")
      throw InputError(value.place, "`design` does not know `" + value.shown() +
                                        "`; write `design = \"grid\"`, every value with every "
                                        "other");
  }
  for (const Swept& swept : sweep) {
    const Place given = place_of(document, swept.key);
    const std::string setting = trimmed(split(given.file, '=').front());
    if (from_command_line(given) && setting == "--set " + swept.key)
      throw InputError(given, "`" + swept.key +
                                  "` is swept, so that one value has no effect; set "
                                  "the list, `sweep." +
                                  swept.key + "=[...]`");
  }
  return sweep;
}

// How many cases the lists make; many lists would overflow a product.
std::size_t count_cases(const std::vector<Swept>& sweep, const Place& place) {
  std::size_t count = 1;
  for (const Swept& swept : sweep) {
    count *= swept.values.size();
    if (count > most_cases)
      throw InputError(place, "`sweep` makes more than " + std::to_string(most_cases) +
                                  " cases; give shorter lists or several scenarios");
  }
  return count;
}

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

Scenario read_scenario(const Node& document, Reading& reading) {
  Scenario scenario;
  reading = read_fields(document, [&](FieldVisitor& visitor) { fields(visitor, scenario); });
  return scenario;
}

// Keeps the first of problems that every case repeats.
void add_new(std::vector<Problem>& all, const std::vector<Problem>& more) {
  for (const Problem& problem : more) {
    const bool known = std::any_of(all.begin(), all.end(), [&](const Problem& other) {
      return other.text() == problem.text();
    });
    if (!known) all.push_back(problem);
  }
}

void check_case_names(const Family& family, const Place& sweep_place,
                      std::vector<Problem>& problems) {
  std::vector<std::string> names;
  for (const Case& one : family.cases) names.push_back(one.name);
  for (const auto& [name, factor] : family.base.output.display_scale) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    const auto near = nearest(name, names);
    add_new(problems,
            {{place_of(family.document, "output.display_scale." + name),
              "`display_scale` names no case `" + name + "`" +
                  (near ? "; did you mean `" + *near + "`?" : "; cases: " + joined(names, ", "))}});
  }
  const std::set<std::string> different(names.begin(), names.end());
  if (different.size() != names.size())
    problems.push_back(
        {sweep_place, "two cases of `sweep` have the same name; give each value once"});
}

}  // namespace

Place place_of(const Node& document, const std::string& path) {
  const Node* node = &document;
  Place place = document.place;
  for (const std::string& word : split(path, '.')) {
    const Node* next = nullptr;
    if (node->kind == Node::Kind::array) {
      const auto number = whole_number(word);
      if (number && *number >= 1 && *number <= static_cast<double>(node->items.size()))
        next = &node->items[static_cast<std::size_t>(*number) - 1];
    } else if (const Member* member = node->find(word)) {
      next = &member->value;
    }
    if (next == nullptr) return place;
    node = next;
    place = node->place;
  }
  return place;
}

Family parse(const std::string& text, const std::string& path,
             const std::vector<std::string>& settings) {
  Family family;
  const std::filesystem::path file(path);
  family.name = file.stem().string();
  family.folder = file.parent_path().string();
  family.document = parse_toml(text, path);
  for (const std::string& setting : settings) {
    const auto [key, value] = parse_assignment(setting);
    set_value(family.document, key, value, value.place);
  }
  family.inputs.push_back({file.filename().string(), text});
  const Place sweep_place = place_of(family.document, "sweep");
  const std::vector<Swept> sweep = take_sweep(family.document);
  const std::size_t count = count_cases(sweep, sweep_place);
  for (const Swept& swept : sweep) family.sweep.emplace_back(swept.key, swept.values);

  std::vector<Problem> problems;
  for (std::size_t i = 0; i < count; ++i) {
    Node document = family.document;
    Case one;
    std::vector<std::string> words;
    std::size_t rest = i;
    std::size_t block = count;
    for (const Swept& swept : sweep) {  // the last key varies fastest
      block /= swept.values.size();
      const std::size_t index = rest / block;
      rest %= block;
      set_value(document, swept.key, swept.values[index], swept.place);
      words.push_back(value_word(swept.key, swept.values[index], index));
      one.swept.emplace_back(swept.key, words.back());
    }
    one.name = words.empty() ? family.name : joined(words, "_");
    Reading reading;
    one.scenario = read_scenario(document, reading);
    if (i == 0) family.base = one.scenario;
    add_new(family.notes, reading.notes);
    fill_in(one.scenario, document, family.folder, family.inputs, reading.problems);
    if (reading.problems.empty()) check(one.scenario, document, reading.problems);
    add_new(problems, reading.problems);
    family.cases.push_back(one);
  }
  family.title = family.base.title.empty() ? family.name : family.base.title;
  if (problems.empty()) check_case_names(family, sweep_place, problems);
  sort_by_place(problems);
  if (!problems.empty()) throw InputError(problems);
  return family;
}

Family read(const std::string& path, const std::vector<std::string>& settings) {
  return parse(read_text(path), path, settings);
}

}  // namespace palpate::scenario
