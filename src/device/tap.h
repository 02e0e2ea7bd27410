// A copy of the bytes that a link sends and receives, handed to the thread that writes them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

#include "device/clock.h"
#include "device/ring.h"

namespace palpate::device {

class Tap {
 public:
  enum class Way : std::uint8_t { sent, received };
  // Bytes of one write or read, divided into as many parts as necessary.
  struct Part {
    double time = 0.0;  // s, wire_time()
    Way way = Way::sent;
    bool last = true;  // the last part of its write or read
    std::uint16_t size = 0;
    std::array<char, 240> bytes{};
  };

  // Allocates nothing and never waits; parts that find the queue full are dropped and counted.
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

}  // namespace palpate::device
