// Reading [sweep]: what is no design is refused at its place.
#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "scenario/design.h"
#include "scenario/family.h"

namespace palpate::scenario {
namespace {

using Kind = Design::Kind;

bool from_command_line(const Place& place) { return place.line == 0; }

void add_varied(const std::string& key, const Member& entry, std::vector<Factor>& factors) {
  const Node& value = entry.value;
  if (value.kind == Node::Kind::table) {  // `tissue.material = [...]` without quotes
    for (const Member& inner : value.members) add_varied(key + "." + inner.key, inner, factors);
    if (!value.members.empty()) return;
  }
  if (value.kind != Node::Kind::array || value.items.empty()) {
    const std::string got = value.kind == Node::Kind::array ? "an empty one" : value.kind_name();
    throw InputError(value.place, "`" + key + "` wants a list of values to run, got " + got +
                                      "; write `\"" + key + "\" = [\"...\", \"...\"]`");
  }
  const auto same = [&](const Factor& other) { return other.keys.front().key == key; };
  const auto known = std::find_if(factors.begin(), factors.end(), same);
  if (known != factors.end() && !from_command_line(entry.place))
    throw InputError(entry.place, "`" + key + "` is swept twice; keep one of the two");
  const Factor factor{key, {{key, entry.place, value.items, std::nullopt, value}}, false};
  if (known != factors.end())
    *known = factor;
  else
    factors.push_back(factor);
}

void refuse_settings_of_swept_keys(const std::vector<Factor>& factors, const Node& document) {
  for (const Factor& factor : factors) {
    for (const Varied& varied : factor.keys) {
      const Place given = place_of(document, varied.key);
      const std::string setting = trimmed(split(given.file, '=').front());
      if (from_command_line(given) && setting == "--set " + varied.key)
        throw InputError(given, "`" + varied.key +
                                    "` is swept, so that one value has no effect; set "
                                    "the list, `sweep." +
                                    varied.key + "=[...]`");
    }
  }
}

}  // namespace

Design take_design(Node& document) {
  const Member* member = document.find("sweep");
  if (member == nullptr) return {};
  const Node table = member->value;
  std::erase_if(document.members, [](const Member& m) { return m.key == "sweep"; });
  if (table.kind != Node::Kind::table)
    throw InputError(table.place, "`sweep` wants a table of keys and lists, got " +
                                      table.kind_name() + "; write `[sweep]`");
  std::vector<Factor> factors;
  for (const Member& entry : table.members) {
    const Node& value = entry.value;
    if (entry.key != "design")
      add_varied(entry.key, entry, factors);
    else if (value.kind != Node::Kind::text || value.text != "grid")
      throw InputError(value.place, "`design` does not know `" + value.shown() +
                                        "`; write `design = \"grid\"`, every value with every "
                                        "other");
  }
  refuse_settings_of_swept_keys(factors, document);
  double count = 1.0;
  for (const Factor& factor : factors) count *= static_cast<double>(factor.levels());
  if (count > most_planned)
    throw InputError(table.place, "`sweep` makes " + rounded_text(count) + " cases, and " +
                                      rounded_text(most_planned) +
                                      " is the most; give shorter lists or several scenarios");
  return {Kind::grid, factors};
}

}  // namespace palpate::scenario
