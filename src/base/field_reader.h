// Reads a struct's fields from a TOML tree, with every problem found and placed.
#pragma once

#include <string>
#include <vector>

#include "base/document.h"
#include "base/fields.h"

namespace palpate {

// A key that has no effect: a note's, or an error's.
struct Unread {
  std::string path;  // dotted, as `solver.rings`; entries of lists count from 1
  std::string when;  // where it would be used
};

struct Reading {
  std::vector<Problem> problems;  // each an error
  std::vector<Problem> notes;     // keys that are left unread by the chosen model
  std::vector<Unread> unread;     // all keys that have no effect
};

// Reads all of `root` by `fields`. A key's use may depend on keys that stand later or in other
// tables: values are read first, and judged in a second pass. Unknown keys, wrong types,
// dimensions and ranges are problems; their fields keep the values they had.
[[nodiscard]] Reading read_fields(const Node& root, const Fields& fields);

}  // namespace palpate
