// PNG with a palette (ISO/IEC 15948) and stored, uncompressed data (RFC 1950, RFC 1951).
#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include "base/index.h"
#include "base/written.h"
#include "page/html.h"
#include "plot/gnuplot_text.h"

namespace palpate::page {
namespace {

std::string big_endian(std::uint32_t number) {
  std::string bytes;
  for (const unsigned shift : {24u, 16u, 8u, 0u})
    bytes += static_cast<char>((number >> shift) & 0xffu);
  return bytes;
}

std::uint32_t crc(const std::string& bytes) {
  std::uint32_t sum = 0xffffffffu;
  for (const char byte : bytes) {
    sum ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) sum = (sum >> 1u) ^ ((sum & 1u) != 0 ? 0xedb88320u : 0u);
  }
  return ~sum;
}

std::string chunk(const std::string& kind, const std::string& content) {
  const std::string whole = kind + content;
  return big_endian(static_cast<std::uint32_t>(content.size())) + whole + big_endian(crc(whole));
}

// A zlib stream of stored blocks.
std::string stored(const std::string& bytes) {
  constexpr std::size_t most = 65535;
  std::string stream = "\x78\x01";
  for (std::size_t at = 0; at < bytes.size(); at += most) {
    const std::size_t length = std::min(most, bytes.size() - at);
    stream += at + length == bytes.size() ? '\1' : '\0';
    for (const std::size_t number : {length, ~length}) {
      stream += static_cast<char>(number & 0xffu);
      stream += static_cast<char>((number >> 8u) & 0xffu);
    }
    stream += bytes.substr(at, length);
  }
  std::uint32_t a = 1, b = 0;  // Adler's checksum
  for (const char byte : bytes) {
    a = (a + static_cast<unsigned char>(byte)) % 65521;
    b = (b + a) % 65521;
  }
  return stream + big_endian((b << 16u) | a);
}

}  // namespace

std::string png_address(int width, int height, std::span<const unsigned char> shades) {
  assert(shades.size() == as_index(width) * as_index(height));
  std::string palette(3, '\0');
  for (int shade = 1; shade < 256; ++shade)
    for (const unsigned char part : plot::palette_bytes((shade - 1) / 254.0))
      palette += static_cast<char>(part);
  std::string rows;
  for (std::size_t row = 0; row < as_index(height); ++row) {
    rows += '\0';  // no filter
    for (const unsigned char shade : shades.subspan(row * as_index(width), as_index(width)))
      rows += static_cast<char>(shade);
  }
  // 8 bits a pixel, colours from a palette, no interlacing.
  const std::string head = big_endian(static_cast<std::uint32_t>(width)) +
                           big_endian(static_cast<std::uint32_t>(height)) +
                           std::string("\x08\x03\x00\x00\x00", 5);
  const std::string transparent(1, '\0');  // of palette entry 0
  return "data:image/png;base64," +
         base64("\x89PNG\r\n\x1a\n" + chunk("IHDR", head) + chunk("PLTE", palette) +
                chunk("tRNS", transparent) + chunk("IDAT", stored(rows)) + chunk("IEND", ""));
}

}  // namespace palpate::page
