// What goes over a link's line, byte for byte, on its way to another thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "device/clock.h"
#include "device/ring.h"

namespace palpate::device {

class Tap {
 public:
  enum class Way : std::uint8_t { sent, received };
  // Bytes of one write or read, in as many parts as they need.
  struct Part {
    double time = 0.0;  // s, wire time
    Way way = Way::sent;
    bool last = true;  // of its write or read
    std::uint16_t size = 0;
    std::array<char, 240> bytes{};
  };

  // Allocates nothing, never waits; what finds no room is dropped and counted.
  void note(Way way, std::string_view bytes) {
    Part part{.time = wire_time(), .way = way};
    while (!bytes.empty()) {
      const std::size_t size = std::min(bytes.size(), part.bytes.size());
      std::copy_n(bytes.begin(), size, part.bytes.begin());
      part.size = static_cast<std::uint16_t>(size);
      bytes.remove_prefix(size);
      part.last = bytes.empty();
      (void)ring_.push(part);
    }
  }
  bool take(Part& part) { return ring_.pop(part); }
  [[nodiscard]] std::uint64_t dropped() const { return ring_.dropped(); }

 private:
  Ring<Part, 8192> ring_;
};

// A CSV field: printable ASCII as it is, the rest as \r, \n, \\ or \xHH, in quotes.
[[nodiscard]] std::string tapped_text(std::string_view bytes);

}  // namespace palpate::device
