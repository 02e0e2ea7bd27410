// The one file of the emulator that knows toml++.
#include <toml++/toml.h>

#include "emulator/settings.h"

namespace emulator {
namespace {

Node converted(const toml::node& from) {
  Node to;
  to.line = static_cast<int>(from.source().begin.line);
  to.column = static_cast<int>(from.source().begin.column);
  if (const auto* table = from.as_table()) {
    to.kind = Node::Kind::table;
    for (const auto& [key, value] : *table) {
      to.entries.emplace_back(std::string(key.str()), converted(value));
      // A message points at the key, where there is one, for that is what is wrong.
      to.entries.back().second.line = static_cast<int>(key.source().begin.line);
      to.entries.back().second.column = static_cast<int>(key.source().begin.column);
    }
  } else if (const auto* array = from.as_array()) {
    to.kind = Node::Kind::list;
    for (const auto& item : *array) to.items.push_back(converted(item));
  } else if (from.is_boolean()) {
    to.kind = Node::Kind::flag;
    to.flag = from.value_or(false);
  } else if (from.is_number()) {
    to.kind = Node::Kind::number;
    to.number = from.value_or(0.0);
  } else {
    to.kind = Node::Kind::text;
    to.text = from.value_or(std::string());
  }
  return to;
}

}  // namespace

Document read_toml(const std::string& path) {
  try {
    return {path, converted(toml::parse_file(path))};
  } catch (const toml::parse_error& error) {
    const auto at = error.source().begin;
    if (at.line == 0) throw Refused(path + ": cannot be read; give the path of a TOML file");
    throw Refused(path + ":" + std::to_string(at.line) + ":" + std::to_string(at.column) + ": " +
                  std::string(error.description()) + "; write valid TOML");
  }
}

}  // namespace emulator
