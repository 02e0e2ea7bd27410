// Files: read whole, written beside and renamed, so that nobody ever sees half of one.
#pragma once

#include <string>
#include <string_view>

namespace palpate {

// The whole file. Throws InputError where it is not there or cannot be read.
[[nodiscard]] std::string read_text(const std::string& path);

// Writes `path` by way of a temporary file beside it, flushed to the disk and renamed.
// Throws SystemError (a full disk, no permission); then `path` is as it was before.
void write_atomically(const std::string& path, std::string_view content);

// SHA-256 as 64 lower-case hexadecimal digits.
[[nodiscard]] std::string sha256(std::string_view content);

}  // namespace palpate
