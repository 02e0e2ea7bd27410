// Turns an error of the TOML parser into a sentence for the author of the file.
#pragma once

#include <string>
#include <string_view>

#include "base/error.h"

namespace palpate {

// The place of a byte of a text; the column counts characters.
[[nodiscard]] Place place_at(std::string_view text, std::size_t offset, const std::string& file);

// `place` and `description` are the parser's; the result has the place where the mistake starts.
[[nodiscard]] Problem toml_problem(std::string_view text, const Place& place,
                                   std::string_view description);

}  // namespace palpate
