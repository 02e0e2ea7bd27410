// The sentence with which something is refused.
#pragma once

#include <string>

#include "base/error.h"

namespace palpate::test {

// What the error says that `work` throws; `otherwise` where it throws none.
template <class Error = InputError, class Work>
std::string refusal(const Work& work, const char* otherwise = "accepted") {
  try {
    static_cast<void>(work());
  } catch (const Error& error) {
    return error.what();
  }
  return otherwise;
}

}  // namespace palpate::test
