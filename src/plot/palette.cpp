// The palette viridis.
#include "plot/palette.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/text.h"

namespace palpate::plot {
namespace {

// Nine colours of matplotlib's viridis, evenly apart.
constexpr std::array<unsigned, 9> viridis{0x440154, 0x472d7b, 0x3b528b, 0x2c728e, 0x21918c,
                                          0x28ae80, 0x5ec962, 0xaddc30, 0xfde725};

}  // namespace

std::array<unsigned char, 3> palette_bytes(double share) {
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(viridis.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(place), viridis.size() - 2);
  const double part = place - static_cast<double>(below);
  std::array<unsigned char, 3> bytes{};
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    const std::size_t shift = 16 - 8 * k;
    const double a = (viridis[below] >> shift) & 0xffu;
    const double b = (viridis[below + 1] >> shift) & 0xffu;
    bytes[k] = static_cast<unsigned char>(std::lround(a + part * (b - a)));
  }
  return bytes;
}

std::string palette_colour(double share) {
  std::string text;
  for (const unsigned char byte : palette_bytes(share)) text += hex_text(byte);
  return text;
}

}  // namespace palpate::plot
