// Writes rows of the log and flushes each of them, so that a crash of the program loses none.
#include "emulator/log.h"

#include "base/error.h"
#include "base/text.h"

namespace emulator {
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
