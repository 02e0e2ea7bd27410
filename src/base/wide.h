// Attributes of loops that are wide on any processor; src/CMakeLists.txt has compiler options for
// their files.
#pragma once

#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wpsabi"  // all functions that take vectors of four are inlined
#endif

// The function is compiled for these processors, and the one at hand takes its own.
#if defined(__x86_64__)
#define PALPATE_WIDE_ON(...) __attribute__((target_clones(__VA_ARGS__)))
#else
#define PALPATE_WIDE_ON(...)
#endif
#define PALPATE_WIDE PALPATE_WIDE_ON("default", "avx2")
#define PALPATE_WIDEST PALPATE_WIDE_ON("default", "avx2", "avx512f")
#define PALPATE_ALWAYS [[gnu::always_inline]] inline
