// Reads a struct's fields from a TOML tree and reports every problem with its place.
#pragma once

#include <string>
#include <vector>

#include "base/document.h"
#include "base/fields.h"

namespace palpate {

// A key that is given but has no effect. It is also reported as a note or as a problem.
struct Unread {
  std::string path;  // dotted, such as `solver.rings`; entries of lists count from 1
  std::string when;  // when the key would be used
};

struct Reading {
  std::vector<Problem> problems;  // errors
  std::vector<Problem> notes;     // keys that the chosen model does not use
  std::vector<Unread> unread;     // all keys that have no effect
};

// Reads all of `root` into the fields. Whether a key is used may depend on keys that come later or
// are in other tables. Therefore a first pass reads the values, and a second pass reads them again
// and reports unknown keys and wrong types, dimensions and ranges. A field that holds one value is
// unchanged if its value is wrong.
[[nodiscard]] Reading read_fields(const Node& root, const Fields& fields);

}  // namespace palpate
