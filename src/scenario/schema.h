// The keys of a scenario for other programs: the JSON Schema for editors, the names for a shell.
#pragma once

#include <string>
#include <vector>

#include "base/key_tree.h"

namespace palpate::scenario {

// A JSON Schema (draft 7) that every scenario which palpate accepts obeys, [sweep] included.
[[nodiscard]] std::string schema();

// All keys by the names that `--set` takes, with the words that they may have.
[[nodiscard]] std::vector<FlatKey> settable_keys();

// The rows of the manual for a key, given as `table.key` or `key`, or for all keys of a table.
// Throws InputError, with the nearest key, if there are none.
[[nodiscard]] std::string meaning_of_key(const std::string& asked);

}  // namespace palpate::scenario
