// The keys of a struct as a tree of plain values: the source of the manual, of the JSON Schema and
// of completion.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/fields.h"

namespace palpate {

struct KeyTree {
  enum class Kind { number, whole, quantity, text, flag, word, list, names, table, tables };
  struct Alternative;

  std::string name = {};
  std::string meaning = {};   // with the condition of its use
  std::string fallback = {};  // its default as text
  bool of_the_paper = false;  // as in Key
  Kind kind = Kind::table;
  Kind item = Kind::number;               // of a list's entries
  Range range = {};                       // of numbers and quantities, SI
  std::vector<Unit> units = {};           // of a quantity: of one dimension or of either of two
  const char* open = nullptr;             // a word that may stand for a number; null if none may
  std::optional<std::size_t> size = {};   // of a list; nothing: any
  std::vector<Word> words = {};           // of a word
  std::vector<KeyTree> keys = {};         // of a table without alternatives
  std::vector<Alternative> alternatives;  // without `= {}`: its type is complete below
  int chosen = 0;                         // the alternative that is the default
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

// A reference of every key in Markdown: type, range, default, meaning and when it is used. Those
// for comparisons with the paper are one table at the end, folded.
[[nodiscard]] std::string manual_of(const KeyTree& tree);

}  // namespace palpate
