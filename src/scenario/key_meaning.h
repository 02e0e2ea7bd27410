// What a key of the manual means.
#pragma once

#include <string>

namespace palpate::scenario {

// The rows of the manual for a key, given as `table.key` or `key`, or for all keys of a table.
// Throws InputError, with the nearest key, if there are none.
[[nodiscard]] std::string meaning_of_key(const std::string& asked);

}  // namespace palpate::scenario
