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

using Sweep = std::vector<std::pair<std::string, std::vector<Node>>>;

// Takes [sweep] out of the document.
Sweep take_sweep(Node& document) {
  const Member* member = document.find("sweep");
  if (member == nullptr) return {};
  const Node table = member->value;
  std::erase_if(document.members, [](const Member& m) { return m.key == "sweep"; });
  if (table.kind != Node::Kind::table)
    throw InputError(table.place, "`sweep` wants a table of keys and lists; write `[sweep]`");
  Sweep sweep;
  for (const Member& entry : table.members) {
    const Place place = entry.value.place;
    if (entry.key == "design") {
      if (entry.value.kind != Node::Kind::text || entry.value.text != "grid")
        throw InputError(place, "`design` does not know `" + entry.value.shown() +
                                    "`; write `design = \"grid\"`, every value with every other");
    } else if (entry.value.kind != Node::Kind::array || entry.value.items.empty()) {
      throw InputError(place, "`" + entry.key + "` wants a list of values to run, got " +
                                  entry.value.kind_name() + "; write `\"" + entry.key +
                                  "\" = [\"...\", \"...\"]`");
    } else {
      sweep.emplace_back(entry.key, entry.value.items);
    }
  }
  return sweep;
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

void check_case_names(const Family& family, std::vector<Problem>& problems) {
  std::vector<std::string> names;
  for (const Case& one : family.cases) names.push_back(one.name);
  for (const auto& [name, factor] : family.base.output.display_scale) {
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    const auto near = nearest(name, names);
    add_new(problems, {{place_of(family.document, "output.display_scale." + name),
                        "`display_scale` names no case `" + name + "`" +
                            (near ? "; did you mean `" + *near + "`?" : "; cases: " +
                                                                            joined(names, ", "))}});
  }
  const std::set<std::string> different(names.begin(), names.end());
  if (different.size() != names.size())
    problems.push_back({family.document.place,
                        "two cases of [sweep] have the same values; give each value once"});
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
  family.sweep = take_sweep(family.document);

  std::size_t count = 1;
  for (const auto& [key, values] : family.sweep) count *= values.size();
  if (count > most_cases)
    throw InputError(family.document.place, "[sweep] makes " + std::to_string(count) +
                                                " cases; keep to " + std::to_string(most_cases));

  std::vector<Problem> problems;
  for (std::size_t i = 0; i < count; ++i) {
    Node document = family.document;
    Case one;
    std::vector<std::string> words;
    std::size_t rest = i;
    std::size_t block = count;
    for (const auto& [key, values] : family.sweep) {  // the last key varies fastest
      block /= values.size();
      const Node& value = values[rest / block];
      rest %= block;
      set_value(document, key, value, value.place);
      one.swept.emplace_back(key, value.shown());
      words.push_back(value.shown());
    }
    one.name = words.empty() ? family.name : joined(words, "_");
    Reading reading;
    one.scenario = read_scenario(document, reading);
    if (i == 0) family.base = one.scenario;
    add_new(family.notes, reading.notes);
    if (reading.problems.empty()) {
      try {
        fill_in(one.scenario, document, family.folder, family.inputs);
        check(one.scenario, document, reading.problems);
      } catch (const InputError& error) {
        reading.problems = error.problems();
      }
    }
    add_new(problems, reading.problems);
    family.cases.push_back(one);
  }
  family.title = family.base.title.empty() ? family.name : family.base.title;
  if (problems.empty()) check_case_names(family, problems);
  if (!problems.empty()) throw InputError(problems);
  return family;
}

Family read(const std::string& path, const std::vector<std::string>& settings) {
  return parse(read_text(path), path, settings);
}

}  // namespace palpate::scenario
