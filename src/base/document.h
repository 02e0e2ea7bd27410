// A TOML text as a tree of values, each with its place in the file.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"

namespace palpate {

struct Member;

// One value. Only the member that belongs to `kind` is meaningful.
struct Node {
  enum class Kind { table, array, text, integer, real, boolean, date };

  Kind kind = Kind::table;
  Place place;
  std::string text;
  double number = 0.0;  // integer and real
  bool boolean = false;
  std::vector<Member> members;  // of a table, in the order of the file
  std::vector<Node> items;      // of an array

  [[nodiscard]] const Member* find(std::string_view key) const;
  [[nodiscard]] bool is_number() const { return kind == Kind::integer || kind == Kind::real; }
  [[nodiscard]] std::string kind_name() const;  // "a table", for messages
  [[nodiscard]] std::string shown() const;      // the value as the user might have written it
};

struct Member {
  std::string key;
  Place place;
  Node value;
};

// Parses a whole TOML text; `file` is what places will say. Throws InputError: not TOML, a
// duplicate key, an empty text, bytes that are no text.
[[nodiscard]] Node parse_toml(std::string_view text, const std::string& file);

// Throws InputError where the bytes are no UTF-8 text; `remedy` says what to give instead.
void refuse_no_text(std::string_view text, const std::string& file, const std::string& remedy);

// Reads and parses a file. Throws InputError also where the file cannot be read.
[[nodiscard]] Node read_toml(const std::string& path);

// Sets the value at a dotted path (`tissue.young_modulus`, `step.2.to` with tables of an array
// counted from 1), making tables on the way. `origin` is the place of the key in messages; the
// value keeps its own.
// Throws InputError where the path runs through something that is no table.
void set_value(Node& root, std::string_view path, Node value, const Place& origin);

// `key=value` as given on a command line: the value in TOML, or a bare word or quantity as text.
[[nodiscard]] std::pair<std::string, Node> parse_assignment(const std::string& assignment);

}  // namespace palpate
