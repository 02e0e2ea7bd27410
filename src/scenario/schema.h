// What helps to write a scenario: the JSON Schema for editors, the names of keys for a shell, their
// meanings, and scenarios to begin with.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/key_tree.h"

namespace palpate::scenario {

// A JSON Schema (draft 7) that every scenario which palpate accepts obeys, [sweep] included. Keys
// that are required, and values that depend on each other, are left to the program.
[[nodiscard]] std::string schema();

// All keys by the names that `--set` takes, with the words that they may have.
[[nodiscard]] std::vector<FlatKey> settable_keys();

// The rows of the manual for a key, given as `table.key` or `key`, or for all keys of a table.
// Throws InputError, with the nearest key, if there are none.
[[nodiscard]] std::string meaning_of_key(const std::string& asked);

// Commented scenarios to begin with: `palpate new`. Each runs as it is; a test runs them all.
struct Starter {
  Word word;  // its kind, and what it computes
  std::string_view text;
};
[[nodiscard]] std::span<const Starter> starters();

}  // namespace palpate::scenario
