// A queue from the loop to the thread that writes, and a copy of the bytes that a link sends and
// receives, handed to that thread.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <type_traits>

#include "device/clock.h"

namespace palpate::device {

// Holds `size` items, a power of two. One thread pushes and another pops, and neither ever waits:
// an item that finds the queue full is dropped and counted.
template <class Item, std::size_t size>
class Ring {
  static_assert(size > 1 && (size & (size - 1)) == 0, "a power of two");
  // An item owns no memory, because a copy in the loop must not allocate.
  static_assert(std::is_trivially_destructible_v<Item> && std::is_copy_assignable_v<Item>);

 public:
  bool push(const Item& item) {
    const std::size_t end = end_.load(std::memory_order_relaxed);
    if (end - begin_.load(std::memory_order_acquire) == size) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    items_[end & (size - 1)] = item;
    end_.store(end + 1, std::memory_order_release);
    return true;
  }

  bool pop(Item& item) {
    const std::size_t begin = begin_.load(std::memory_order_relaxed);
    if (begin == end_.load(std::memory_order_acquire)) return false;
    item = items_[begin & (size - 1)];
    begin_.store(begin + 1, std::memory_order_release);
    return true;
  }

  [[nodiscard]] std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::size_t line = 64;  // bytes, so that the threads share no cache line
  std::array<Item, size> items_{};
  alignas(line) std::atomic<std::size_t> begin_ = 0;
  alignas(line) std::atomic<std::size_t> end_ = 0;
  alignas(line) std::atomic<std::uint64_t> dropped_ = 0;
};

// A copy of the bytes that a link sends and receives, handed to the thread that writes them.

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
