// Reads tissue tables; the built-in table is compiled into the program.
#include "material/tissue_table.h"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "base/fields.h"
#include "base/files.h"
#include "base/text.h"

namespace palpate::material {

extern const std::string_view chen2007_text;  // materials/chen2007.toml

namespace {

template <class Read>
void sourced(FieldVisitor& visitor, const char* name, const char* meaning, Sourced& value,
             const Read& read) {
  visitor.table({name, meaning}, [&](FieldVisitor& inner) {
    read(inner, value.value);
    inner.text({"source", "who measured or printed it, or `assumed: why`"}, value.source);
  });
}

void fields(FieldVisitor& visitor, Tissue& tissue, const Node& table) {
  const auto quantity = [](const Unit& unit, const Range& range) {
    return [&unit, range](FieldVisitor& inner, double& value) {
      inner.quantity({"value", ""}, value, unit, range);
    };
  };
  const auto number = [](const Range& range) {
    return [range](FieldVisitor& inner, double& value) {
      inner.number({"value", ""}, value, range);
    };
  };
  const auto optional = [&](const char* name, const char* meaning, std::optional<Sourced>& value,
                            const auto& read) {
    if (table.find(name) != nullptr && !value) value.emplace();
    Sourced absent;
    sourced(visitor, name, meaning, value ? *value : absent, read);
  };
  visitor.text({"title", "for figures"}, tissue.title);
  sourced(visitor, "density", "", tissue.density, quantity(unit::density, above(0)));
  sourced(visitor, "young_modulus", "", tissue.young_modulus, quantity(unit::kPa, above(0)));
  // The finger's material may be incompressible, because its ratio is used in Hertz's law only.
  sourced(visitor, "poisson_ratio", "", tissue.poisson_ratio,
          number({.low = -1, .high = 0.5, .low_allowed = false}));
  optional("retardation_time", "", tissue.retardation_time, quantity(unit::s, above(0)));
  optional("relaxation_time", "", tissue.relaxation_time, quantity(unit::s, above(0)));
  optional("instantaneous_ratio", "", tissue.instantaneous_ratio, number(at_least(1)));
  optional("drag", "", tissue.drag, quantity(unit::per_second, at_least(0)));
}

void require(const Node& table, const std::string& name, const Place& place,
             std::vector<Problem>& problems) {
  // A misspelt key (`densitty`) is reported once, as unknown; its correct name is not also missing.
  std::vector<std::string> unknown;
  for (const Member& member : table.members)
    for (const Problem& problem : problems)
      if (problem.place == member.place) unknown.push_back(member.key);
  const auto is_unknown = [&](const std::string& key) {
    return std::ranges::find(unknown, key) != unknown.end();
  };
  for (const char* key : {"density", "young_modulus", "poisson_ratio"}) {
    if (table.find(key) == nullptr && !nearest(key, unknown))
      problems.push_back({place, "`" + name + "` lacks `" + key + "`; add `" + key +
                                     " = ...`, or `{ value = ..., source = \"...\" }`"});
  }
  for (const Member& member : table.members) {
    if (member.value.kind != Node::Kind::table || is_unknown(member.key)) continue;
    if (member.value.find("value") == nullptr)
      problems.push_back(
          {member.place,
           "`" + member.key + "` lacks `value`; write `{ value = ..., source = \"...\" }`"});
  }
}

// `density = "1000 kg/m^3"` means the same as `density = { value = "1000 kg/m^3" }`.
void wrap_values(Node& table) {
  for (Member& member : table.members) {
    if (member.key == "title" || member.value.kind == Node::Kind::table) continue;
    Node wrapped;
    wrapped.place = member.place;
    wrapped.members.push_back({"value", member.value.place, member.value});
    member.value = std::move(wrapped);
  }
}

}  // namespace

Found find(const std::string& name, const std::string& folder, const Place& place) {
  const std::size_t hash = name.find('#');
  Found found;
  Node root;
  std::string table_name = name;
  if (hash == std::string::npos) {
    root = parse_toml(chen2007_text, "chen2007.toml");
  } else {
    const auto path = std::filesystem::path(folder) / name.substr(0, hash);
    table_name = name.substr(hash + 1);
    try {
      found.file_text = read_text(path.string());
    } catch (const InputError& error) {
      throw InputError(place, "`material` names " + ticked(path.string()) + ", which " +
                                  error.problems()[0].message);
    }
    root = parse_toml(found.file_text, path.string());
  }
  const Member* member = root.find(table_name);
  if (member == nullptr || member->value.kind != Node::Kind::table) {
    std::vector<std::string> known;
    for (const Member& candidate : root.members)
      if (candidate.value.kind == Node::Kind::table) known.push_back(candidate.key);
    const auto near = nearest(table_name, known);
    throw InputError(place, "`material` does not know `" + table_name + "`" +
                                (near ? "; did you mean `" + *near + "`? Known" : "; known") +
                                " here: " + (known.empty() ? "none" : joined(known, ", ")) +
                                "; your own tables are written `file.toml#name`");
  }
  Node table = member->value;
  wrap_values(table);
  Reading reading =
      read_fields(table, [&](FieldVisitor& visitor) { fields(visitor, found.tissue, table); });
  require(table, table_name, member->place, reading.problems);
  for (Problem& problem : reading.problems)
    if (const Member* source = table.find("source"); source && problem.place == source->place)
      problem.message =
          "`source` belongs to a value: `young_modulus = { value = \"5 kPa\", source = \"...\" }`";
  sort_by_place(reading.problems);
  if (!reading.problems.empty()) throw InputError(reading.problems);
  if (found.tissue.title.empty()) found.tissue.title = table_name;
  return found;
}

const std::vector<std::pair<std::string, std::string>>& builtin() {
  static const auto known = [] {
    std::vector<std::pair<std::string, std::string>> names;
    for (const Member& member : parse_toml(chen2007_text, "chen2007.toml").members) {
      const Member* title = member.value.find("title");
      names.emplace_back(member.key, title == nullptr ? "" : title->value.text);
    }
    return names;
  }();
  return known;
}

std::string builtin_table(const std::string& name) {
  const std::size_t begin = chen2007_text.find("\n[" + name + "]\n");
  if (begin == std::string_view::npos) return "";
  const std::size_t end = chen2007_text.find("\n[", begin + 1);
  return trimmed(std::string(chen2007_text.substr(begin, end - begin))) + "\n";
}

}  // namespace palpate::material
