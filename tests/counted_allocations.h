// Counts what this thread allocates by operator new. Include it in one file of a program.
#pragma once

#include <cstddef>
#include <cstdlib>
#include <new>

namespace palpate::test {

inline thread_local std::size_t allocations = 0;

}  // namespace palpate::test

// NOLINTBEGIN: replaced for the whole program, as the language has it
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"  // they do match
void* operator new(std::size_t size) {
  ++palpate::test::allocations;
  if (void* got = std::malloc(size > 0 ? size : 1)) return got;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++palpate::test::allocations;
  const auto each = static_cast<std::size_t>(alignment);
  if (void* got = std::aligned_alloc(each, (size + each - 1) / each * each)) return got;
  throw std::bad_alloc();
}
void operator delete(void* got) noexcept { std::free(got); }
void operator delete(void* got, std::size_t) noexcept { std::free(got); }
void operator delete(void* got, std::align_val_t) noexcept { std::free(got); }
void operator delete(void* got, std::size_t, std::align_val_t) noexcept { std::free(got); }
#pragma GCC diagnostic pop
// NOLINTEND
