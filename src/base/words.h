// Words for the enumerators of a closed set. A table that lacks an enumerator does not compile.
#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "base/index.h"

namespace palpate {

struct Word {
  const char* word;
  const char* meaning;
};

// The name of an enumerator. A compiler prints a value without enumerator as a cast, `(Enum)4`; the
// result is then `Enum)4`, which is not the name of any enumerator.
template <auto value>
[[nodiscard]] consteval std::string_view enumerator_name() {
  const std::string_view printed = __PRETTY_FUNCTION__;
  const std::size_t start = printed.find("value = ") + 8;
  const std::string_view shown = printed.substr(start, printed.find_first_of(";]", start) - start);
  return shown.substr(shown.rfind(':') + 1);
}

// The names of the enumerators up to `last`, which end with a zero.
template <auto last>
inline constexpr auto enumerator_names = []<std::size_t... i>(std::index_sequence<i...>) {
  std::array<std::array<char, 32>, sizeof...(i)> names{};
  const std::array views{enumerator_name<static_cast<decltype(last)>(i)>()...};
  for (std::size_t k = 0; k < views.size(); ++k) views[k].copy(names[k].data(), 31);
  return names;
}
(std::make_index_sequence<as_index(last) + 1>());

// The name of an enumerator; `last` is the last of them.
template <auto last>
[[nodiscard]] constexpr const char* name_of(decltype(last) value) {
  return enumerator_names<last>[as_index(value)].data();
}

// Whether for every enumerator i `table[i].word` is its name and, if the rows have a member `of`,
// `table[i].of` is the enumerator. Assert this for every table that is indexed by an enumerator.
template <class Enum, class Row, std::size_t size>
[[nodiscard]] consteval bool is_complete(const std::array<Row, size>& table) {
  const auto names = []<std::size_t... i>(std::index_sequence<i...>) {
    return std::array{enumerator_name<static_cast<Enum>(i)>()...};
  }
  (std::make_index_sequence<size + 1>());
  for (std::size_t i = 0; i < size; ++i) {
    if (names[i] != table[i].word) return false;
    if constexpr (requires { table[i].of; })
      if (table[i].of != static_cast<Enum>(i)) return false;
  }
  return names[size].find(')') != std::string_view::npos;
}

// The words of an enumeration, in its order.
template <class Enum, std::size_t size>
struct Words : std::array<Word, size> {
  // From a table whose rows may have further members.
  template <class Row>
  consteval explicit Words(const std::array<Row, size>& table) {
    if (!is_complete<Enum>(table)) throw "a table names every enumerator, in their order";
    for (std::size_t i = 0; i < size; ++i) (*this)[i] = {table[i].word, table[i].meaning};
  }
};

template <class Enum, std::size_t size>
[[nodiscard]] consteval auto words_of(const Word (&rows)[size]) {
  return Words<Enum, size>(std::to_array(rows));
}

// The word of a value.
template <class Enum, std::size_t size>
[[nodiscard]] constexpr const char* word(const Words<Enum, size>& words, Enum value) {
  return words[as_index(value)].word;
}

}  // namespace palpate
