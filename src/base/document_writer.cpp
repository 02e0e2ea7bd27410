// Writes TOML: control characters are escaped, and keys are quoted only if they have to be.
#include "base/document_writer.h"

#include <algorithm>
#include <vector>

#include "base/text.h"

namespace palpate {
namespace {

std::string entry(const Member& member) {
  return toml_key(member.key) + " = " + toml_value(member.value);
}

std::string lines(const Node& table) {
  std::string text;
  for (const Member& member : table.members) text += entry(member) + "\n";
  return text;
}

bool is_list_of_tables(const Node& node) {
  return node.kind == Node::Kind::array && !node.items.empty() &&
         std::all_of(node.items.begin(), node.items.end(),
                     [](const Node& item) { return item.kind == Node::Kind::table; });
}

}  // namespace

std::string toml_text(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\n') {
      quoted += "\\n";
    } else if (byte < 0x20 || byte == 0x7f) {
      quoted += "\\u00" + hex_text(byte);
    } else {
      if (c == '"' || c == '\\') quoted += '\\';
      quoted += c;
    }
  }
  return quoted + "\"";
}

std::string toml_key(std::string_view key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  });
  return bare ? std::string(key) : toml_text(key);
}

std::string toml_value(const Node& value) {
  std::vector<std::string> parts;
  switch (value.kind) {
    case Node::Kind::text: return toml_text(value.text);
    case Node::Kind::array:
      for (const Node& item : value.items) parts.push_back(toml_value(item));
      return "[" + joined(parts, ", ") + "]";
    case Node::Kind::table:
      for (const Member& member : value.members) parts.push_back(entry(member));
      return parts.empty() ? "{}" : "{ " + joined(parts, ", ") + " }";
    case Node::Kind::integer:
    case Node::Kind::real:
    case Node::Kind::boolean:
    case Node::Kind::date: break;
  }
  return value.shown();
}

std::string toml_document(const Node& root) {
  std::string top;
  std::string tables;
  for (const Member& member : root.members) {
    if (member.value.kind == Node::Kind::table) {
      tables += "\n[" + toml_key(member.key) + "]\n" + lines(member.value);
    } else if (is_list_of_tables(member.value)) {
      for (const Node& item : member.value.items)
        tables += "\n[[" + toml_key(member.key) + "]]\n" + lines(item);
    } else {
      top += entry(member) + "\n";
    }
  }
  return top + tables;
}

}  // namespace palpate
