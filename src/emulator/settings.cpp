// Reads settings files.
#include "emulator/settings.h"

#include "base/field_reader.h"
#include "base/files.h"
#include "base/text.h"

namespace emulator {

palpate::Node read_settings(const std::string& path, const palpate::Fields& fields) {
  const std::string text = palpate::read_text(path);
  palpate::Node file;  // of an empty file
  if (!palpate::trimmed(text).empty()) file = palpate::parse_toml(text, path);
  const palpate::Reading reading = palpate::read_fields(file, fields);
  if (!reading.problems.empty()) throw InputError(reading.problems);
  return file;
}

void refuse(const palpate::Node& file, const std::string& path, const std::string& sentence) {
  throw InputError(palpate::place_of(file, path), sentence);
}

}  // namespace emulator
