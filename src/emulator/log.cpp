// Rows of the log, each flushed: what was written stays, whatever ends the program.
#include "emulator/log.h"

#include <charconv>
#include <cstdint>

#include "emulator/settings.h"

namespace emulator {
namespace {

std::string number(double value) {
  char text[64];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

}  // namespace

std::string escaped(std::string_view bytes) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string text;
  for (const char byte : bytes) {
    const auto code = static_cast<unsigned char>(byte);
    if (byte == '\r')
      text += "\\r";
    else if (byte == '\n')
      text += "\\n";
    else if (byte == '\\')
      text += "\\\\";
    else if (code >= 0x20 && code < 0x7F)
      text += byte;
    else
      (text += "\\x") += {digits[code >> 4U], digits[code & 15U]};
  }
  return text;
}

Log::Log(const std::string& path, std::string_view columns) {
  if (path.empty()) return;
  file_.emplace(path, std::ios::binary | std::ios::trunc);
  if (!*file_) throw Refused(path + ": cannot be written; name a file in a folder that exists");
  *file_ << "time_s,kind,text," << columns << "\n" << std::flush;
}

void Log::row(std::int64_t now, std::string_view kind, std::string_view text,
              std::span<const double> values) {
  if (!file_) return;
  std::string line = number(static_cast<double>(now) * 1e-9);
  (line += ",") += kind;
  line += ",\"";
  for (const char character : escaped(text))
    line += character == '"' ? "\"\"" : std::string(1, character);
  line += "\"";
  for (const double value : values) line += "," + number(value);
  *file_ << line << "\n" << std::flush;
}

}  // namespace emulator
