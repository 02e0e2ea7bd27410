// The keys of a struct as a tree of plain values: the source of the JSON Schema and of completion.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/fields.h"

namespace palpate {

struct KeyTree {
  enum class Kind { number, whole, quantity, text, flag, word, list, names, table, tables };
  struct Alternative;

  std::string name = {};
  std::string meaning = {};  // with the condition of its use
  Kind kind = Kind::table;
  Kind item = Kind::number;               // of a list's entries
  Range range = {};                       // of numbers and quantities, SI
  std::vector<Unit> units = {};           // of a quantity: of one dimension or of either of two
  const char* open = nullptr;             // a word that may stand for a number; null if none may
  std::optional<std::size_t> size = {};   // of a list; nothing: any
  std::vector<Word> words = {};           // of a word
  std::vector<KeyTree> keys = {};         // of a table without alternatives
  std::vector<Alternative> alternatives;  // without `= {}`: its type is complete below
};

// One kind of a table with a key `kind`.
struct KeyTree::Alternative {
  Word word = {};
  std::vector<KeyTree> keys = {};
};

// The tree of all keys, of every alternative.
[[nodiscard]] KeyTree fields_as_tree(const Fields& fields);

// A key by the path that `--set` takes, such as `step.1.kind`.
struct FlatKey {
  std::string path = {};
  std::string meaning = {};
  std::vector<Word> words = {};  // its values; empty if they are not words
};

// Every key that has a value, once; of a list of tables the first table's.
[[nodiscard]] std::vector<FlatKey> flat_keys(const KeyTree& tree);

// A JSON Schema (draft 7) of a document with these keys. `further` are members of its `properties`
// besides: names, and schemas as JSON. Keys that are required, and values that depend on each
// other, are left to the program.
using JsonMembers = std::vector<std::pair<std::string, std::string>>;
[[nodiscard]] std::string json_schema(const KeyTree& tree, const std::string& title,
                                      const JsonMembers& further);

// `{"a": 1}` from names and values in JSON.
[[nodiscard]] std::string json_object(const JsonMembers& members);
[[nodiscard]] std::string json_array(const std::vector<std::string>& items);

}  // namespace palpate
