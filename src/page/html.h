// HTML in pieces. A text becomes part of a page only through these functions, which escape it.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "record/table.h"

namespace palpate::page {

// A piece of HTML that is well formed and escaped.
class Markup {
 public:
  Markup() = default;
  Markup& operator+=(const Markup& more) {
    html_ += more.html_;
    return *this;
  }
  [[nodiscard]] const std::string& html() const { return html_; }
  [[nodiscard]] bool empty() const { return html_.empty(); }

  // Takes a text that is HTML or SVG already, made by this program or by gnuplot for it.
  [[nodiscard]] static Markup ready(std::string html);

 private:
  std::string html_;
};
[[nodiscard]] Markup operator+(Markup first, const Markup& second);

[[nodiscard]] Markup text(std::string_view words);

using Attributes = std::vector<std::pair<std::string_view, std::string>>;
// <tag attributes>inner</tag>; `img`, `input` and `meta` have no inner part and no end.
[[nodiscard]] Markup element(std::string_view tag, const Markup& inner,
                             const Attributes& attributes = {});
[[nodiscard]] Markup element(std::string_view tag, std::string_view words,
                             const Attributes& attributes = {});
// No line ends between a number and its unit, or between `±` and its number. The words of an
// element are kept so, but those of `code`, `pre` and `title`, which a reader may copy.
[[nodiscard]] std::string kept_together(std::string_view words);
// A link to a file beside the page, or to a place on it (`#id`).
[[nodiscard]] Markup link(const std::string& target, std::string_view words);
// A sentence in which what stands between back-quotes becomes code; and sentences as paragraphs.
[[nodiscard]] Markup sentence(std::string_view words);
[[nodiscard]] Markup paragraphs(const std::vector<std::string>& sentences);

// A table with a caption and row headings in its first column, without other columns in which no
// row has a value. Numbers have four digits and stand to the right. It scrolls by itself, also by
// keyboard, if it is wider than the page.
[[nodiscard]] Markup table(const std::string& caption, const record::Table& content);
// These columns of a table, in this order; those that are there.
[[nodiscard]] record::Table columns_of(const record::Table& content,
                                       const std::vector<std::string>& names);
// The first `most` rows of a large table, with a link to the file that holds all of them.
[[nodiscard]] Markup table_of_file(const std::string& caption, const record::Table& content,
                                   const std::string& file, std::size_t most);

// A picture of width x height pixels as a `data:` address of a PNG. Each byte of `shades`, row by
// row from the top, is a colour of the palette of values from 1 to 255; 0 is transparent.
[[nodiscard]] std::string png_address(int width, int height, std::span<const unsigned char> shades);

}  // namespace palpate::page
