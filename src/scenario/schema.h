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

}  // namespace palpate::scenario
