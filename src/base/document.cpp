// Reads TOML with toml++, which only this file includes.
#include "base/document.h"

#include <toml++/toml.h>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>

#include "base/files.h"
#include "base/index.h"
#include "base/text.h"

namespace palpate {
namespace {

// True for the first byte of a UTF-8 character; columns count characters.
bool starts_character(char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }

// The byte offset of a line and column; at most the end of that line.
std::size_t offset_of(std::string_view text, const Place& place) {
  std::size_t at = 0;
  for (int line = 1; line < place.line && at < text.size(); ++line)
    at = std::min(text.find('\n', at), text.size() - 1) + 1;
  for (int column = 1; column < place.column && at < text.size() && text[at] != '\n'; ++column) do
      ++at;
    while (at < text.size() && !starts_character(text[at]));
  return at;
}

// The part of the parser's message that is in single quotes, such as '1e400'.
std::string_view parser_quote(std::string_view description) {
  const std::size_t from = description.find('\'');
  const std::size_t to = description.rfind('\'');
  return from == to ? "" : description.substr(from + 1, to - from - 1);
}

// The `key` or `[table]` whose second definition the parser found at `at`.
std::string_view repeated(std::string_view text, std::size_t at) {
  const auto rest = text.substr(at, text.find_first_of("\r\n", at) - at);
  if (rest.starts_with('[') && (at == 0 || text[at - 1] == '\n'))
    return rest.substr(0, rest.find_last_of(']') + 1);
  const std::size_t line = text.substr(0, at).find_last_of('\n') + 1;
  std::size_t equals = text.substr(0, at).find_last_of('=');
  if (equals == std::string_view::npos || equals < line) equals = text.find('=', at);
  if (equals == std::string_view::npos) return rest;
  const std::size_t end = text.find_last_not_of(" \t=", equals) + 1;
  const std::size_t comma = text.substr(0, end).find_last_of("{,");
  std::size_t begin = comma != std::string_view::npos && comma >= line ? comma + 1 : line;
  while (begin < end && (text[begin] == ' ' || text[begin] == '\t')) ++begin;
  return text.substr(begin, end - begin);
}

// The place of a byte of a text; the column counts characters.
Place place_at(std::string_view text, std::size_t offset, const std::string& file) {
  const auto before = text.substr(0, offset);
  const std::size_t line_start = before.find_last_of('\n') + 1;  // npos + 1 is 0: the first line
  const auto in_line = before.substr(line_start);
  return {file, 1 + static_cast<int>(std::ranges::count(before, '\n')),
          1 + static_cast<int>(std::ranges::count_if(in_line, starts_character))};
}

// `place` and `description` are the parser's; the result has the place where the mistake starts.
Problem toml_problem(std::string_view text, const Place& place, std::string_view description) {
  const auto says = [&](std::string_view part) {
    return description.find(part) != std::string_view::npos;
  };
  const std::size_t at = offset_of(text, place);
  const auto starting_at = [&](std::string_view part) {
    const std::size_t start = part.empty() ? at : text.rfind(part, at);
    return place_at(text, start == std::string_view::npos ? at : start, place.file);
  };

  if (says("redefine")) {
    const std::string_view twice = repeated(text, at);
    const auto offset = as_index(twice.data() - text.data());
    return {place_at(text, offset, place.file),
            ticked(twice) + " is given twice; keep one of the two"};
  }
  if (says("utf-8") || says("UTF-8"))
    return {place, "the file is not UTF-8 text; save it as UTF-8"};
  if (says("could not be interpreted as a value") || says("not representable")) {
    const std::string_view number = parser_quote(description);
    return {starting_at(number), ticked(number) + " is a number that " +
                                     (says("bits") ? "64 bits cannot" : "no double can") +
                                     " hold; write one between -1e300 and 1e300"};
  }
  if (says("unescaped control characters") || (says("string:") && says("end-of-file")))
    return {place, "a text is not closed on its line; end it with the quote it began with"};
  const auto digit = [&](std::size_t i) {
    return i < text.size() && std::isdigit(static_cast<unsigned char>(text[i])) != 0;
  };
  if (says("expected a comment or whitespace") && at > 0 && at < text.size() && text[at] == ',' &&
      digit(at - 1) && digit(at + 1)) {
    const std::size_t begin = text.find_last_of(" =\t\n", at) + 1;
    std::string number(text.substr(begin, text.find_first_of(" \t\r\n#", at) - begin));
    const std::string given = ticked(number);
    number[at - begin] = '.';
    return {place_at(text, begin, place.file),
            given + " has a decimal comma; write it with a point, as " + ticked(number)};
  }
  if (says("expected a comment or whitespace"))
    return {place,
            "a value is followed by more on its line; put quantities in double quotes, as `\"5 "
            "mm\"`, and each key on a line of its own"};
  if (says("determine value type"))
    return {place, "this is not a TOML value; put words in double quotes"};
  const std::size_t colon = description.find(": ");
  const bool framed = description.starts_with("Error while parsing ") && colon != description.npos;
  const auto what = framed ? "this " + std::string(description.substr(20, colon - 20)) +
                                 " cannot be read: " + std::string(description.substr(colon + 2))
                           : "this cannot be read: " + std::string(description);
  return {place, what + "; write `key = value`, texts and quantities in double quotes"};
}

Place place_of(const toml::source_region& region, const std::string& file) {
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

Node convert(const toml::node& value, const std::string& file) {
  Node node;
  node.place = place_of(value.source(), file);
  if (const auto* table = value.as_table()) {
    node.kind = Node::Kind::table;
    for (const auto& [key, child] : *table)
      node.members.push_back(
          {std::string(key.str()), place_of(key.source(), file), convert(child, file)});
    std::ranges::stable_sort(node.members, [](const Member& a, const Member& b) {
      return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
    });
  } else if (const auto* array = value.as_array()) {
    node.kind = Node::Kind::array;
    for (const toml::node& child : *array) node.items.push_back(convert(child, file));
  } else if (const auto* text = value.as_string()) {
    node.kind = Node::Kind::text;
    node.text = text->get();
  } else if (const auto* integer = value.as_integer()) {
    node.kind = Node::Kind::integer;
    node.number = static_cast<double>(integer->get());
  } else if (const auto* real = value.as_floating_point()) {
    node.kind = Node::Kind::real;
    node.number = real->get();
  } else if (const auto* boolean = value.as_boolean()) {
    node.kind = Node::Kind::boolean;
    node.boolean = boolean->get();
  } else {
    node.kind = Node::Kind::date;
  }
  return node;
}

// The offset of the first byte that does not occur in text files, or the text's size.
std::size_t first_binary_byte(std::string_view text) {
  const auto binary = [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && c != '\n' && c != '\r' && c != '\t') || byte == 0x7f;
  };
  return as_index(std::ranges::find_if(text, binary) - text.begin());
}

// Keys of more words, and deeper lists, occur in no document of ours. The parser and what follows
// it call themselves for every level.
constexpr int most_levels = 32;

// The offset after the string that begins at `at`.
std::size_t after_string(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const std::string three(3, quote);
  const bool long_one = text.substr(at, 3) == three;
  for (std::size_t i = at + (long_one ? 3 : 1); i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"') {
      ++i;
    } else if (long_one ? text.substr(i, 3) == three : text[i] == quote || text[i] == '\n') {
      return i + (long_one ? 3 : 1);
    }
  }
  return text.size();
}

// The offset of the first key or value that is nested too deeply, or the text's size.
std::size_t first_too_deep(std::string_view text) {
  int brackets = 0;
  int points = 0;  // in the key or number so far
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"' || c == '\'') {
      i = after_string(text, i) - 1;
      continue;
    }
    if (c == '#') i = std::min(text.find('\n', i), text.size() - 1);
    if (c == '[' || c == '{') ++brackets;
    if (c == ']' || c == '}') brackets = std::max(0, brackets - 1);
    if (c == '.') ++points;
    if (c == '#' || c == '\n' || c == '=' || c == ',' || c == '[' || c == '{') points = 0;
    if (points >= most_levels || brackets > most_levels) return i;
  }
  return text.size();
}

void refuse_too_deep(std::string_view text, const std::string& file) {
  const std::size_t deep = first_too_deep(text);
  if (deep < text.size())
    throw InputError(place_at(text, deep, file),
                     "this is nested in more than " + std::to_string(most_levels) +
                         " levels; write it as a key of a table, as `tissue.material`");
}

}  // namespace

const Member* Node::find(std::string_view key) const {
  for (const Member& member : members)
    if (member.key == key) return &member;
  return nullptr;
}

std::string Node::kind_name() const {
  switch (kind) {
    case Kind::table: return "a table";
    case Kind::array: return "a list";
    case Kind::text: return "a text";
    case Kind::integer: return "an integer";
    case Kind::real: return "a number";
    case Kind::boolean: return "a truth value";
    case Kind::date: return "a date";
  }
  return "a value";
}

std::string Node::shown() const {
  switch (kind) {
    case Kind::text: return text;
    // A double represents integers below 2^53 exactly; they are shown without an exponent.
    case Kind::integer:
      return std::abs(number) < 9007199254740992.0
                 ? std::to_string(static_cast<std::int64_t>(number))
                 : number_text(number);
    case Kind::real: {
      const std::string digits = number_text(number);
      const bool whole = digits.find_first_not_of("-0123456789") == std::string::npos;
      return whole ? digits + ".0" : digits;
    }
    case Kind::boolean: return boolean ? "true" : "false";
    case Kind::table:
    case Kind::array:
    case Kind::date: break;
  }
  return kind_name();
}

Node text_node(std::string text) {
  Node node;
  node.kind = Node::Kind::text;
  node.text = std::move(text);
  return node;
}

Node number_node(double number) {
  Node node;
  const bool digits = number_text(number).find_first_not_of("-0123456789") == std::string::npos;
  node.kind = digits ? Node::Kind::integer : Node::Kind::real;
  node.number = number;
  return node;
}

Node list_node(std::vector<Node> items) {
  Node node;
  node.kind = Node::Kind::array;
  node.items = std::move(items);
  return node;
}

void refuse_no_text(std::string_view text, const std::string& file, const std::string& remedy) {
  const std::size_t binary = first_binary_byte(text);
  if (binary < text.size())
    throw InputError(place_at(text, binary, file), "this is not a text file; " + remedy);
  const std::size_t broken = first_broken_character(text);
  if (broken < text.size())
    throw InputError(place_at(text, broken, file),
                     "this is not UTF-8 text; save the file as UTF-8");
}

Node parse_toml(std::string_view text, const std::string& file) {
  if (trimmed(text).empty())
    throw InputError({file, 1, 1}, "the file is empty; a scenario starts with `schema = 1`");
  refuse_no_text(text, file, "give a TOML file");
  refuse_too_deep(text, file);
  try {
    const toml::table table = toml::parse(text, file);
    Node root = convert(table, file);
    root.place = {file, 1, 1};
    return root;
  } catch (const toml::parse_error& error) {
    throw InputError({toml_problem(text, place_of(error.source(), file), error.description())});
  }
}

Node read_toml(const std::string& path) { return parse_toml(read_text(path), path); }

namespace {

// A path with the words before and at one that is looked for.
struct Step {
  const std::vector<std::string>& words;
  std::size_t at = 0;

  [[nodiscard]] const std::string& word() const { return words[at]; }
  // The word so many places further on; empty behind the last.
  [[nodiscard]] std::string next(std::size_t further = 1) const {
    return at + further < words.size() ? words[at + further] : "";
  }
  // Only a whole entry or one with its kind is appended, so that a wrong number is not a new entry.
  [[nodiscard]] bool may_append() const { return next().empty() || next() == "kind"; }
};

// The entry of a list by its number in a path, or the member of a table by its name. A missing
// member becomes a table, or a list of tables where the path goes on with `1.kind`.
Node& descend(Node& node, const Step& step, const Place& origin) {
  const std::string& word = step.word();
  const auto refuse = [&](const std::string& why) -> Node& {
    throw InputError(origin, "`" + joined(step.words, ".") + "` cannot be set: " + why);
  };
  if (node.kind == Node::Kind::array) {
    const auto number = whole_number(word);
    const std::size_t count = node.items.size();
    if (number == static_cast<double>(count + 1) && step.may_append()) {
      node.items.emplace_back();
      node.items.back().place = origin;
    } else if (!number || !(*number >= 1 && *number <= static_cast<double>(count)) ||
               *number != std::floor(*number)) {
      return refuse("`" + word + "` is none of the list's entries; " +
                    (count > 0 ? "count them from 1 to " + std::to_string(count) + ", or " : "") +
                    "append one by `" + std::to_string(count + 1) + ".kind`");
    }
    return node.items[static_cast<std::size_t>(*number) - 1];
  }
  if (node.kind != Node::Kind::table)
    return refuse("`" + word + "` is looked for inside " + node.kind_name() +
                  "; name a key of a table");
  for (Member& member : node.members)
    if (member.key == word) return member.value;
  Node made;
  made.place = origin;
  if (step.next() == "1" && step.next(2) == "kind") made.kind = Node::Kind::array;
  node.members.push_back({word, origin, made});
  return node.members.back().value;
}

}  // namespace

void set_place(Node& node, const Place& place) {
  node.place = place;
  for (Node& item : node.items) set_place(item, place);
  for (Member& member : node.members) {
    member.place = place;
    set_place(member.value, place);
  }
}

void set_value(Node& root, std::string_view path, Node value, const Place& origin) {
  Node* node = &root;
  Member* last = nullptr;
  refuse_too_deep(path, origin.file);
  const std::vector<std::string> words = split(path, '.');
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    Node& parent = *node;
    if (word.empty())
      throw InputError(origin, "`" + std::string(path) +
                                   "` has an empty word; join the names of tables and a key by "
                                   "single dots, as `tissue.material`");
    node = &descend(parent, {words, i}, origin);
    last = nullptr;
    for (Member& member : parent.members)
      if (&member.value == node) last = &member;
  }
  *node = std::move(value);
  if (last != nullptr) last->place = origin;
}

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

std::pair<std::string, Node> parse_assignment(const std::string& assignment) {
  const std::size_t equals = assignment.find('=');
  // A long value or key stands in the sentence only.
  const bool is_long = assignment.size() > 200;
  const Place origin{"--set " + (is_long ? shortened(assignment.substr(0, equals)) : assignment), 0,
                     0};
  if (equals == std::string::npos || equals == 0)
    throw InputError(origin, "a setting is written `key=value`, as `tissue.young_modulus=60 kPa`");
  const std::string path = trimmed(std::string_view(assignment).substr(0, equals));
  const std::string value = trimmed(std::string_view(assignment).substr(equals + 1));
  Node node;
  refuse_too_deep(path, "--set");
  refuse_too_deep(value, "--set " + path);
  try {
    const toml::table table = toml::parse("value = " + value);
    if (table.size() != 1)
      throw InputError(origin,
                       "a setting holds one value; write each key with a `--set` of its own");
    node = convert(*table.get("value"), origin.file);
  } catch (const toml::parse_error&) {
    node = text_node(value);
    if (first_broken_character(value) < value.size())
      throw InputError({"--set " + path, 0, 0}, "the value is not UTF-8 text; write it in UTF-8");
  }
  set_place(node, origin);
  return {path, node};
}

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
         std::ranges::all_of(node.items,
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
  const bool bare = !key.empty() && std::ranges::all_of(key, [](char c) {
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
