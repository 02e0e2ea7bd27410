// Counts every block of memory that this thread takes: by operator new, and by malloc, which is
// what matrices take theirs by. Include it in one file of a program. Where blocks cannot be counted
// `memory_is_counted` is false.
#pragma once

#include <cstddef>
#include <cstdlib>

namespace palpate::test {

inline thread_local std::size_t blocks_taken = 0;

}  // namespace palpate::test

// NOLINTBEGIN: replaced for the whole program, as the libraries have it
// GCC says so by a macro, Clang by a feature; libraries define __has_feature for those without.
#if defined(__SANITIZE_ADDRESS__)
#define PALPATE_SANITIZED
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define PALPATE_SANITIZED
#endif
#endif
#if defined(PALPATE_SANITIZED)
// The sanitizer has its own malloc, and tells of every block.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*taken)(const volatile void*,
                                                                       size_t),
                                                         void (*freed)(const volatile void*));
namespace palpate::test {
inline const bool memory_is_counted =
    __sanitizer_install_malloc_and_free_hooks([](const volatile void*, size_t) { ++blocks_taken; },
                                              [](const volatile void*) {}) > 0;
}  // namespace palpate::test
#elif defined(__GLIBC__)
extern "C" {
void* __libc_malloc(size_t) noexcept;
void* __libc_calloc(size_t, size_t) noexcept;
void* __libc_realloc(void*, size_t) noexcept;
void* __libc_memalign(size_t, size_t) noexcept;

void* malloc(size_t size) noexcept {
  ++palpate::test::blocks_taken;
  return __libc_malloc(size);
}
void* calloc(size_t count, size_t size) noexcept {
  ++palpate::test::blocks_taken;
  return __libc_calloc(count, size);
}
void* realloc(void* old, size_t size) noexcept {
  ++palpate::test::blocks_taken;
  return __libc_realloc(old, size);
}
void* aligned_alloc(size_t alignment, size_t size) noexcept {
  ++palpate::test::blocks_taken;
  return __libc_memalign(alignment, size);
}
}
namespace palpate::test {
inline constexpr bool memory_is_counted = true;
}  // namespace palpate::test
#else
namespace palpate::test {
inline constexpr bool memory_is_counted = false;
}  // namespace palpate::test
#endif
// NOLINTEND
