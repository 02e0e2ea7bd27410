// The emulator's input files: TOML tables, read by the `fields` of the structs that they fill.
#pragma once

#include <string>

#include "base/document.h"
#include "base/fields.h"

namespace emulator {

using palpate::at_least;
using palpate::FieldVisitor;
using palpate::InputError;
namespace unit = palpate::unit;

// Reads a file by `fields` and returns its document, so that checks of several keys can name a
// place. Throws InputError if the file is missing, invalid, or has unknown keys or wrong values.
palpate::Node read_settings(const std::string& path, const palpate::Fields& fields);

// Throws InputError with `sentence` and the place of the key `path` (dotted).
[[noreturn]] void refuse(const palpate::Node& file, const std::string& path,
                         const std::string& sentence);

}  // namespace emulator
