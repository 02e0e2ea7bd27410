// Numbers in binary files, of either byte order.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <string_view>
#include <type_traits>

namespace palpate::meshing {

// A type of numbers, and how one is read from bytes.
struct NumberType {
  std::string_view name, other_name;
  bool whole = false;
  std::size_t bytes = 0;
  double (*read)(const char* at, bool big_endian) = nullptr;
};

template <typename Number>
Number number_at(const char* at, bool big_endian) {
  std::array<char, sizeof(Number)> raw{};
  std::copy_n(at, raw.size(), raw.begin());
  if (big_endian) std::ranges::reverse(raw);
  return std::bit_cast<Number>(raw);
}

template <typename Number>
constexpr NumberType number_type(std::string_view name, std::string_view other_name) {
  return {name, other_name, std::is_integral_v<Number>, sizeof(Number),
          [](const char* at, bool big_endian) {
            return static_cast<double>(number_at<Number>(at, big_endian));
          }};
}

// The type of that name in a table; null if there is none.
template <class Table>
const NumberType* type_named(const Table& table, std::string_view word) {
  const auto* const found = std::ranges::find_if(
      table, [&](const NumberType& one) { return one.name == word || one.other_name == word; });
  return found == table.end() ? nullptr : found;
}

}  // namespace palpate::meshing
