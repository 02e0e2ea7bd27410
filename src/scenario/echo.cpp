// The resolved echo and the manual, both from the one list of fields.
#include <algorithm>

#include "base/document_writer.h"
#include "base/field_writer.h"
#include "base/text.h"
#include "scenario/family.h"

namespace palpate::scenario {
namespace {

using Kind = Node::Kind;

// Files lie beside the echo, whatever folder they came from.
void use_copies(Node& node, const std::string& key) {
  for (Member& member : node.members) use_copies(member.value, member.key);
  for (Node& item : node.items) use_copies(item, key);
  if (node.kind != Kind::text || (key != "material" && key != "file")) return;
  const std::size_t slash = node.text.rfind('/', node.text.find('#'));
  if (slash != std::string::npos) node.text.erase(0, slash + 1);
}

bool are(Kind kind, const Node& a, const Node& b) { return a.kind == kind && b.kind == kind; }

bool are_steps(const Node& a, const Node& b) {
  const auto of_tables = [](const Node& list) {
    return std::all_of(list.items.begin(), list.items.end(),
                       [](const Node& item) { return item.kind == Kind::table; });
  };
  return are(Kind::array, a, b) && a.items.size() == b.items.size() && of_tables(a) && of_tables(b);
}

// Keeps of `table` what `other` has with the same value.
void keep_common(Node& table, const Node& other) {
  std::vector<Member> kept;
  for (Member& member : table.members) {
    const Member* same = other.find(member.key);
    if (same == nullptr) continue;
    Node& value = member.value;
    if (are(Kind::table, value, same->value)) {
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

// Adds to `table` what was `given` and is missing.
void add_missing(Node& table, const Node& given) {
  for (const Member& member : given.members) {
    const auto here = std::find_if(table.members.begin(), table.members.end(),
                                   [&](const Member& other) { return other.key == member.key; });
    if (here == table.members.end()) {
      table.members.push_back(member);
    } else if (are(Kind::table, here->value, member.value)) {
      add_missing(here->value, member.value);
    } else if (are_steps(here->value, member.value)) {
      for (std::size_t i = 0; i < member.value.items.size(); ++i)
        add_missing(here->value.items[i], member.value.items[i]);
    }
  }
}

Node resolved(const Case& one) {
  Scenario scenario = one.scenario;
  return parse_toml(fields_as_toml([&](FieldVisitor& visitor) { fields(visitor, scenario); }),
                    "echo");
}

// What all cases have in common, and what was given besides. The rest follows from the swept keys:
// written out, one case's own material or model would be forced upon the others.
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
  Scenario only = one.scenario;
  const std::string all = fields_as_toml([&](FieldVisitor& visitor) { fields(visitor, only); });
  std::string text = "# " + one.name + ":";
  for (const std::string& line : split(all, '\n')) {
    if (line.starts_with('[') && line != "[tissue]") break;  // regions and the finger have some too
    for (const char* key : {"young_modulus", "poisson_ratio", "density", "retardation_time",
                            "relaxation_time", "instantaneous_ratio", "drag"})
      if (line.starts_with(std::string(key) + " =")) text += " " + line + ",";
  }
  text.back() = '\n';
  return text;
}

}  // namespace

std::string echo(const Family& family, const Chosen& chosen) {
  const auto springs = [](const Case& one) {
    return one.scenario.solver.model == Solver::Model::mass_spring &&
           (one.scenario.solver.volume == Solver::Volume::automatic ||
            one.scenario.solver.volume == Solver::Volume::none);
  };
  std::string text =
      "# The scenario as it was run: every default spelled out. It reads back to the "
      "same run.\n";
  if (std::any_of(family.cases.begin(), family.cases.end(), springs))
    text +=
        "# tissue.poisson_ratio reaches the contact only: independent springs have a ratio of "
        "their own (findings.csv).\n";
  if (std::any_of(family.sweep.begin(), family.sweep.end(),
                  [](const auto& entry) { return entry.first == "tissue.material"; }))
    for (const Case& one : family.cases) text += properties_comment(one);
  const bool alike = std::all_of(chosen.begin(), chosen.end(), [&](const auto& one) {
    return one.second == chosen.front().second;
  });
  for (const auto& [name, words] : chosen) {
    text +=
        "# " + std::string(alike ? "`auto`" : name + ", `auto`") + " stands for: " + words + "\n";
    if (alike) break;
  }
  text += toml_document(common(family));
  if (!family.sweep.empty()) {
    text += "\n[sweep]\ndesign = \"grid\"\n";
    for (const auto& [key, values] : family.sweep) {
      Node list;
      list.kind = Kind::array;
      list.items = values;
      use_copies(list, key.substr(key.rfind('.') + 1));
      text += toml_text(key) + " = " + toml_value(list) + "\n";
    }
  }
  return text;
}

std::string manual() {
  Scenario defaults;
  const std::string keys =
      fields_as_manual([&](FieldVisitor& visitor) { fields(visitor, defaults); });
  return "# Scenario files\n\n"
         "Generated by `palpate manual`; a test keeps it current.\n\n"
         "A scenario is one TOML file. Quantities are texts with a unit (`\"11 mm\"`, "
         "`\"72.4 kPa\"`, `\"5 mm/s\"`, `\"1100 kg/m^3\"`), pure numbers are bare. Unknown keys, "
         "wrong dimensions and keys that the chosen model cannot honour are errors with file, line "
         "and column. `--set key=value` sets any key from the command line "
         "(`--set tissue.young_modulus=\"60 kPa\"`, `--set step.1.to=\"2 mm\"`).\n\n"
         "`[sweep]` makes a family of cases: `\"tissue.material\" = [\"skin\", \"muscle\"]` runs "
         "one case a value, named by it; several lists run every combination.\n" +
         keys;
}

}  // namespace palpate::scenario
