// Signed integers and enumerators as indices of the standard containers.
#pragma once

#include <cstddef>
#include <type_traits>

namespace palpate {

// `i` is at least 0.
template <class Index>
requires(std::is_integral_v<Index> || std::is_enum_v<Index>) [[nodiscard]] constexpr std::size_t
    as_index(Index i) {
  return static_cast<std::size_t>(i);
}

}  // namespace palpate
