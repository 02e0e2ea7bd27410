// Bytes as text that people and programs can read.
#include "device/tap.h"

namespace palpate::device {

std::string tapped_text(std::string_view bytes) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string text = "\"";
  for (const char byte : bytes) {
    const auto value = static_cast<unsigned char>(byte);
    if (byte == '\r')
      text += "\\r";
    else if (byte == '\n')
      text += "\\n";
    else if (byte == '\\')
      text += "\\\\";
    else if (byte == '"')
      text += "\"\"";
    else if (value >= 0x20 && value < 0x7f)
      text += byte;
    else
      text += {'\\', 'x', digits[value >> 4U], digits[value & 15U]};
  }
  return text + "\"";
}

}  // namespace palpate::device
