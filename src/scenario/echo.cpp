// The resolved echo and the manual, both made from the one list of fields.
#include <algorithm>
#include <string>

#include "base/document.h"
#include "base/fields.h"
#include "base/key_tree.h"
#include "base/text.h"
#include "scenario/resolved.h"

namespace palpate::scenario {

// Of scenario/texts/.
extern const std::string_view scenario_manual_text, sweep_manual_text, tissue_manual_text;

namespace {

using NodeKind = Node::Kind;

bool are(NodeKind kind, const Node& a, const Node& b) { return a.kind == kind && b.kind == kind; }

bool are_steps(const Node& a, const Node& b) {
  const auto of_tables = [](const Node& list) {
    return std::ranges::all_of(list.items,
                               [](const Node& item) { return item.kind == NodeKind::table; });
  };
  return are(NodeKind::array, a, b) && a.items.size() == b.items.size() && of_tables(a) &&
         of_tables(b);
}

// Removes from `table` everything that `other` does not have with the same value.
void keep_common(Node& table, const Node& other) {
  std::vector<Member> kept;
  for (Member& member : table.members) {
    const Member* same = other.find(member.key);
    if (same == nullptr) continue;
    Node& value = member.value;
    if (are(NodeKind::table, value, same->value)) {
      keep_common(value, same->value);
      if (value.members.empty()) continue;
    } else if (are_steps(value, same->value)) {
      for (std::size_t i = 0; i < value.items.size(); ++i)
        keep_common(value.items[i], same->value.items[i]);
    } else if (toml_value(value) != toml_value(same->value)) {
      continue;
    }
    kept.push_back(member);
  }
  table.members = kept;
}

// Adds to `table` the keys of `given` that it lacks.
void add_missing(Node& table, const Node& given) {
  for (const Member& member : given.members) {
    const auto here = std::ranges::find(table.members, member.key, &Member::key);
    if (here == table.members.end()) {
      table.members.push_back(member);
    } else if (are(NodeKind::table, here->value, member.value)) {
      add_missing(here->value, member.value);
    } else if (are_steps(here->value, member.value)) {
      for (std::size_t i = 0; i < member.value.items.size(); ++i)
        add_missing(here->value.items[i], member.value.items[i]);
    }
  }
}

Node resolved(const Case& one) {
  Scenario scenario = filled(one);
  return fields_as_node([&](FieldVisitor& visitor) { fields(visitor, scenario); });
}

// The keys that all cases have in common, and those that the scenario contains. Other keys follow
// from the swept ones; if they were written, all cases would get one case's material or model.
Node common(const Family& family) {
  Node document = resolved(family.cases.front());
  if (family.cases.size() > 1) {
    for (const Case& one : family.cases) keep_common(document, resolved(one));
    add_missing(document, family.document);
  }
  use_copies(document, "");
  return document;
}

std::string properties_comment(const Case& one) {
  std::string text = "# " + one.name + ":";
  for (const std::string& line : split(spelled_out(one), '\n')) {
    if (line.starts_with('[') && line != "[tissue]") break;  // other tables have such keys too
    for (const char* key : {"young_modulus", "poisson_ratio", "density", "retardation_time",
                            "relaxation_time", "instantaneous_ratio", "drag"})
      if (line.starts_with(std::string(key) + " =")) text += " " + line + ",";
  }
  text.back() = '\n';
  return text;
}

}  // namespace

std::string spelled_out(const Case& one) { return toml_document(resolved(one)); }

std::string echo(const Family& family, const Chosen& chosen) {
  const auto springs = [](const Case& one) { return poisson_in_contact_only(one.scenario); };
  std::string text =
      "# The scenario as it was run: every default spelled out. It reads back to the same run.\n";
  if (std::ranges::any_of(family.cases, springs))
    text += std::string("# tissue.poisson_ratio ") + poisson_in_contact_only_text + ".\n";
  const std::vector<std::string>& keys = family.design.keys();
  if (std::ranges::find(keys, "tissue.material") != keys.end())
    for (const Case& one : family.cases) text += properties_comment(one);
  const bool alike = std::ranges::all_of(
      chosen, [&](const auto& one) { return one.second == chosen.front().second; });
  for (const auto& [name, words] : chosen) {
    text +=
        "# " + std::string(alike ? "`auto`" : name + ", `auto`") + " stands for: " + words + "\n";
    if (alike) break;
  }
  text += toml_document(common(family)) + family.design.toml();
  return text;
}

std::string manual() {
  Scenario defaults;
  const std::string keys =
      manual_of(fields_as_tree([&](FieldVisitor& visitor) { fields(visitor, defaults); }));
  return std::string(scenario_manual_text) + keys + std::string(tissue_manual_text) +
         std::string(sweep_manual_text);
}

}  // namespace palpate::scenario
