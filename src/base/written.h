// Texts in the forms that sentences, pages and files take.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace palpate {

// `1 case`, `2 cases` of the word `case`.
[[nodiscard]] std::string count_text(std::size_t count, std::string_view word);

// The letters of a text in UTF-8.
[[nodiscard]] std::size_t letter_count(std::string_view text);

// Text for HTML and XML: & < > " ' escaped, and control characters, which both forbid, as blanks.
[[nodiscard]] std::string escaped(std::string_view text);

// RFC 4648, section 4.
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace palpate
