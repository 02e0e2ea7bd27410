// The resolved echo and the manual, both made from the one list of fields.
#include <algorithm>
#include <string>

#include "base/document.h"
#include "base/field_writer.h"
#include "base/text.h"
#include "scenario/resolved.h"
#include "scenario/trial.h"

namespace palpate::scenario {
namespace {

std::string sweep_manual() {
  return R"(
## `[sweep]`

Makes a family of cases. Any key of this manual can be swept by its dotted path: `"finger.radius"`, `"step.1.to"`, entries of lists such as `"tissue.shape.size.3"`, and whole tables such as `"tissue.shape"`. `palpate run` takes up to 1000 cases, `palpate sweep` any number.

```toml
[sweep]                     # every value with every other
"tissue.material"      = ["skin", "muscle"]
"tissue.young_modulus" = { from = "1 kPa", to = "100 kPa", points = 20, scale = "log" }
```

A key has a list of values, or a range. A range includes both ends, which are written in the same unit. In a grid it has `points` values (at least 2), spaced evenly, or with `scale = "log"` evenly in their logarithms. Values between the ends are rounded to 12 digits in the unit of the range: `3.16227766017 kPa`. Keys with whole numbers need a list, unless all points of a range are whole.

| key | value | default | meaning |
| --- | --- | --- | --- |
| `design` | a word below | `grid` | Which cases are made. |
| `samples` | whole number >= 1 and <= 10000000 |  | With `lhs`, `sobol` and `saltelli`: required. |
| `seed` | whole number >= 0 | `1` | With `lhs`. |
| `file` | text |  | With `csv`: the table's path, from the scenario's folder. Required. |

| design | cases |
| --- | --- |
| `grid` | Every value with every other; the last key varies fastest. |
| `list` | The first values of all keys, then the second ones, and so on: lists of one length. |
| `csv` | One case per row of a table. |
| `lhs` | A Latin hypercube: each range is divided into `samples` equal parts, each of which contains one case, at a random place. |
| `sobol` | The Sobol sequence, which fills the space more evenly; its first point, the origin, is excluded, and nothing is scrambled. Most even with 2^k - 1 `samples`. |
| `saltelli` | For first-order and total Sobol indices: of `d` keys, `samples` times d + 2 cases. Two independent points A and B of a Sobol sequence in 2 d dimensions, then A with one key of B after the other: A, B, A_B^1 ... A_B^d. |

In the last three designs a key has a range without `points`, or a list whose values get equal shares of the cases. A Latin hypercube is drawn by the 64-bit Mersenne twister of the C++ standard, the same on every machine: for one key after the other, first the order of its parts, by exchanging the last with one drawn before it or itself and so on down to the second, then a place in each from the upper 29 bits of a number.

```toml
[sweep]
design  = "lhs"
samples = 200
seed    = 1
"tissue.young_modulus" = { from = "1 kPa", to = "100 kPa", scale = "log" }
"tissue.poisson_ratio" = { from = 0.2, to = 0.49 }
"finger.material"      = ["finger", "rigid"]
```

Keys that change together, such as a tissue and its properties, are written in a `[[sweep.rows]]` table, as lists of the same length. They count as one key in every design. There may be several such tables.

```toml
[sweep]
"finger.radius" = ["8 mm", "11 mm"]
[[sweep.rows]]
"tissue.material"      = ["skin", "muscle"]
"tissue.young_modulus" = ["60 kPa", "20 kPa"]
```

A table has one column per key and one row per case. Its header names the keys, with a unit if the numbers need one. Cells are separated by commas, and quoted if they contain a comma.

```csv
tissue.young_modulus [kPa],tissue.poisson_ratio,tissue.material,step.1.to
12.5,0.4,skin,1 mm
80,0.45,muscle,2 mm
```

Cases are named by their values, joined by `_`. If there are more than 1000 cases, if a name would be longer than 80 letters, and in samples and tables, they are named by their number, `0001`.

These are refused before the first case runs: ends of a range outside a key's limits, a key that no case reads because the chosen model does not use it, two values of one key that make the same case, and everything that is refused in a scenario.
)";
}

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
