// The manual of [sweep], in markdown.
#pragma once

#include <string>

namespace palpate::scenario {

[[nodiscard]] std::string sweep_manual();

}  // namespace palpate::scenario
