// Small pictures inside a page.
#pragma once

#include <span>
#include <string>

namespace palpate::page {

// A picture of width x height pixels as a `data:` address of a PNG. Each byte of `shades`, row by
// row from the top, is a colour of the palette of values from 1 to 255; 0 is transparent.
[[nodiscard]] std::string png_address(int width, int height, std::span<const unsigned char> shades);

}  // namespace palpate::page
