// What a TOML parser complains of, as a sentence for the person who wrote the file.
#pragma once

#include <string>
#include <string_view>

#include "base/error.h"

namespace palpate {

// The place of a byte of a text, its column counted in characters.
[[nodiscard]] Place place_at(std::string_view text, std::size_t offset, const std::string& file);

// `place` and `description` are the parser's; the problem's place is where the mistake starts.
[[nodiscard]] Problem toml_problem(std::string_view text, const Place& place,
                                   std::string_view description);

}  // namespace palpate
