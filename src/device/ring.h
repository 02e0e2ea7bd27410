// A queue from one thread to another without locks: the loop writes, a logger reads.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <type_traits>

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

}  // namespace palpate::device
