// Reads settings files; writes rows of the log and flushes each, so that a crash loses none.
#include "emulator/files.h"

#include "base/error.h"
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

Log::Log(const std::string& path, std::string_view columns) {
  if (path.empty()) return;
  file_.emplace(path, std::ios::binary | std::ios::trunc);
  if (!*file_)
    throw palpate::InputError({path},
                              "this file cannot be written; name one in a folder that exists");
  *file_ << "time_s,kind,text," << columns << "\n" << std::flush;
}

void Log::row(std::int64_t now, std::string_view kind, std::string_view text,
              std::span<const double> values) {
  if (!file_) return;
  std::string line = palpate::number_text(static_cast<double>(now) * 1e-9);
  ((line += ",") += kind) += "," + palpate::bytes_text(text);
  for (const double value : values) line += "," + palpate::number_text(value);
  *file_ << line << "\n" << std::flush;
}

}  // namespace emulator
