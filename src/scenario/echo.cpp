// The resolved echo and the manual, both made from the one list of fields.
#include <algorithm>

#include "base/document_writer.h"
#include "base/field_writer.h"
#include "base/text.h"
#include "scenario/resolved.h"
#include "scenario/sweep_manual.h"
#include "scenario/trial.h"

namespace palpate::scenario {
namespace {

using NodeKind = Node::Kind;

bool are(NodeKind kind, const Node& a, const Node& b) { return a.kind == kind && b.kind == kind; }

bool are_steps(const Node& a, const Node& b) {
  const auto of_tables = [](const Node& list) {
    return std::all_of(list.items.begin(), list.items.end(),
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
    const auto here = std::find_if(table.members.begin(), table.members.end(),
                                   [&](const Member& other) { return other.key == member.key; });
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

Node resolved(const Case& one) { return parse_toml(spelled_out(one), "echo"); }

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

std::string spelled_out(const Case& one) {
  Scenario scenario = filled(one);
  return fields_as_toml([&](FieldVisitor& visitor) { fields(visitor, scenario); });
}

std::string echo(const Family& family, const Chosen& chosen) {
  const auto springs = [](const Case& one) { return poisson_in_contact_only(one.scenario); };
  std::string text =
      "# The scenario as it was run: every default spelled out. It reads back to the "
      "same run.\n";
  if (std::any_of(family.cases.begin(), family.cases.end(), springs))
    text += std::string("# tissue.poisson_ratio ") + poisson_in_contact_only_text + ".\n";
  const std::vector<std::string>& keys = family.design.keys();
  if (std::find(keys.begin(), keys.end(), "tissue.material") != keys.end())
    for (const Case& one : family.cases) text += properties_comment(one);
  const bool alike = std::all_of(chosen.begin(), chosen.end(), [&](const auto& one) {
    return one.second == chosen.front().second;
  });
  for (const auto& [name, words] : chosen) {
    text +=
        "# " + std::string(alike ? "`auto`" : name + ", `auto`") + " stands for: " + words + "\n";
    if (alike) break;
  }
  text += toml_document(common(family)) + family.design.toml();
  return text;
}

namespace {

const std::string tissue_manual = R"(
## Tissues of your own

`tissue.material = "my_tissues.toml#gel"` takes the table `[gel]` of the file my_tissues.toml beside the scenario. A table needs `density`, `young_modulus` (of the relaxed tissue) and `poisson_ratio`:

```
[gel]
density       = "1020 kg/m^3"
young_modulus = "12 kPa"
poisson_ratio = 0.45
```

On a mesh, and in the contact with `contact.viscosity = "tissue"`, the viscous law needs its property too: `retardation_time` for `kelvin_voigt`, which is the default, `relaxation_time` and `instantaneous_ratio` for `standard_linear_solid`, `drag` for `nodal_drag`; nothing for `none` and `prony`. A table may have a `title` for figures, and a property may say where it comes from: `young_modulus = { value = "12 kPa", source = "our rheometer, 2026" }`. A copy of the file is part of every result.
)";

}  // namespace

std::string manual() {
  Scenario defaults;
  const std::string keys =
      fields_as_manual([&](FieldVisitor& visitor) { fields(visitor, defaults); });
  return "# Scenario files\n\n"
         "Generated by `palpate manual`; a test keeps it current.\n\n"
         "A scenario is one TOML file. Quantities are texts with a unit (`\"11 mm\"`, "
         "`\"72.4 kPa\"`, `\"5 mm/s\"`, `\"1100 kg/m^3\"`), pure numbers are bare. Unknown keys, "
         "wrong dimensions and keys that the chosen model cannot use are errors with file, line "
         "and column. `--set key=value` sets a key from the command line "
         "(`--set tissue.young_modulus=\"60 kPa\"`, `--set step.1.to=\"2 mm\"`), also an entry of "
         "a "
         "list (`--set tissue.shape.size.3=\"40 mm\"`). A step is appended by its number and kind: "
         "`--set step.2.kind=hold --set step.2.time=\"1 s\"`; so is a region.\n\n"
         "Tissues of your own are described [below](#tissues-of-your-own), and `[sweep]`, which "
         "makes a family of cases, [at the end](#sweep).\n" +
         keys + tissue_manual + sweep_manual();
}

}  // namespace palpate::scenario
