// A TOML document as a tree of values, each with its place in the file.
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

// Values that no file holds: a number is an integer where its text has digits alone.
[[nodiscard]] Node text_node(std::string text);
[[nodiscard]] Node number_node(double number);
[[nodiscard]] Node list_node(std::vector<Node> items);

// Parses a whole TOML document; `file` is the name that places contain. Throws InputError if the
// text is empty, is not UTF-8 text, is not TOML or gives a key twice.
[[nodiscard]] Node parse_toml(std::string_view text, const std::string& file);

// Throws InputError if the bytes are not UTF-8 text. If they are binary data, the message ends with
// `remedy`, which says what kind of file to give.
void refuse_no_text(std::string_view text, const std::string& file, const std::string& remedy);

// Reads and parses a file. Throws InputError as parse_toml() does, and if the file cannot be read.
[[nodiscard]] Node read_toml(const std::string& path);

// Sets the value at a dotted path (`tissue.young_modulus`, or `step.2.to`, where the entries of a
// list count from 1), with missing tables. `origin` becomes the place of the key; the value keeps
// its own. Throws InputError if the path leads through a list's missing entry or a value that has
// no keys.
void set_value(Node& root, std::string_view path, Node value, const Place& origin);

// Gives the value, and all keys and values inside it, this place.
void set_place(Node& node, const Place& place);

// The place of the value at a dotted path, or of the nearest table around it.
[[nodiscard]] Place place_of(const Node& document, const std::string& path);

// Parses `key=value` of the command line. If the value is not TOML (a bare word or quantity) it
// becomes a text. Throws InputError without a key, for several values, and for bytes that are no
// UTF-8.
[[nodiscard]] std::pair<std::string, Node> parse_assignment(const std::string& assignment);

// A text or a key in double quotes, with escape sequences.
[[nodiscard]] std::string toml_text(std::string_view text);

// A key, quoted if TOML requires it.
[[nodiscard]] std::string toml_key(std::string_view key);

// A value on one line; tables are written inline.
[[nodiscard]] std::string toml_value(const Node& value);

// A whole document: first top-level keys, then each table under its [header], inline tables in it.
[[nodiscard]] std::string toml_document(const Node& root);

}  // namespace palpate
