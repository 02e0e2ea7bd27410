// What a TOML parser complains of, as a sentence for the person who wrote the file.
#pragma once

#include <string>
#include <string_view>

#include "base/error.h"

namespace palpate {

// `place` and `description` are the parser's; the problem's place is where the mistake starts.
[[nodiscard]] Problem toml_problem(std::string_view text, const Place& place,
                                   std::string_view description);

}  // namespace palpate
