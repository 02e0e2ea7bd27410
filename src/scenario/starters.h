// Commented scenarios to begin with: `palpate new`.
#pragma once

#include <span>
#include <string_view>

#include "base/words.h"

namespace palpate::scenario {

struct Starter {
  Word word;  // its kind, and what it computes
  std::string_view text;
};

[[nodiscard]] std::span<const Starter> starters();

}  // namespace palpate::scenario
