// Every word of a choice: a test that loops over them has a new one among them by itself.
#pragma once

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/fields.h"

namespace palpate::test {

// All but `auto` and those that the test is not about. Throws where one of those is no word.
template <std::size_t count>
std::vector<std::string> every(const std::array<Word, count>& words,
                               std::vector<std::string> but = {}) {
  but.emplace_back("auto");
  std::vector<std::string> chosen;
  for (const Word& word : words) {
    const auto neglected = std::find(but.begin(), but.end(), word.word);
    if (neglected == but.end())
      chosen.emplace_back(word.word);
    else
      but.erase(neglected);
  }
  std::erase(but, "auto");  // not every choice has it
  if (!but.empty()) throw std::invalid_argument("no word `" + but.front() + "`");
  return chosen;
}

}  // namespace palpate::test
