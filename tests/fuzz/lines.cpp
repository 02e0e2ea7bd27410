// Any bytes from a gauge's line: what is read is a number, and nothing crashes.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "device/line_gauge.h"
#include "device/serial_port.h"
#include "fuzzing.h"

// The bytes before the first zero byte are a pattern; the rest arrives in lines. Without a zero
// byte all of it is lines, for the patterns of the examples.
void palpate::fuzz::lines(const std::uint8_t* data, std::size_t size) {
  using namespace device;
  static const LinePattern examples[] = {
      LinePattern("{time},{force},{travel}"), LinePattern("{force} {force_unit}"),
      LinePattern("{any},{force} {force_unit}"),
      LinePattern("{any}{force}{any}{travel}{any}", LinePattern::Decimal::comma)};
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  const auto zero = bytes.find('\0');
  const auto read = [](const LinePattern& pattern, std::string_view lines_text) {
    LineBuffer lines;
    while (!lines_text.empty()) {
      lines.feed(lines_text.substr(0, 64));
      lines_text.remove_prefix(std::min<std::size_t>(64, lines_text.size()));
      while (const auto line = lines.next()) {
        require(line->size() <= longest_line);
        const auto words = pattern.match(*line);
        require(!pattern.why_not(*line).empty());
        if (!words) continue;
        require(words->of(Measure::force).has_value());
        for (std::size_t i = 0; i < measures; ++i) {
          const auto measure = static_cast<Measure>(i);
          require(words->of(measure).has_value() == pattern.has_number(measure));
          if (words->of(measure)) require(std::abs(*words->of(measure)) < 1e15);
          require(words->unit[i].empty() != pattern.has_unit(measure));
          static_cast<void>(unit_of(measure, words->unit[i]));
        }
      }
    }
  };
  if (zero == std::string_view::npos) {
    for (const LinePattern& pattern : examples) read(pattern, bytes);
    return;
  }
  try {
    read(LinePattern(bytes.substr(0, zero)), bytes.substr(zero + 1));
  } catch (const std::invalid_argument& refused) {
    require(std::string_view(refused.what()).starts_with("wants "));
  }
}
