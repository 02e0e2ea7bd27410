// Seeded noise with the same bits on every machine, without distributions of the library.
#pragma once

#include <cstdint>

namespace emulator {

struct Random {
  std::uint64_t state;
};

// splitmix64 (Steele, Lea, Flood 2014).
inline std::uint64_t next_bits(Random& random) {
  random.state += 0x9E3779B97F4A7C15U;
  std::uint64_t z = random.state;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31U);
}

// Sum of twelve uniform numbers minus six: mean 0, variance 1, magnitude below 6.
inline double next_normal(Random& random) {
  std::int64_t sum = 0;
  for (int word = 0; word < 3; ++word) {
    const std::uint64_t bits = next_bits(random);
    for (int part = 0; part < 4; ++part)
      sum += static_cast<std::int64_t>((bits >> (16U * static_cast<unsigned>(part))) & 0xFFFFU);
  }
  return (static_cast<double>(sum) + 6.0) / 65536.0 - 6.0;  // each number is the middle of a step
}

}  // namespace emulator
