// Decodes the encodings and line ends that instruments, spreadsheets and old Macs write.
#include "measured/text.h"

#include <array>
#include <cstdint>
#include <optional>

#include "base/error.h"
#include "base/text.h"

namespace palpate::measured {
namespace {

void append_utf8(std::string& text, std::uint32_t code) {
  const auto byte = [&](std::uint32_t bits) { text += static_cast<char>(bits); };
  if (code < 0x80) return byte(code);
  if (code < 0x800) {
    byte(0xC0 | (code >> 6U));
  } else if (code < 0x10000) {
    byte(0xE0 | (code >> 12U));
    byte(0x80 | ((code >> 6U) & 0x3FU));
  } else {
    byte(0xF0 | (code >> 18U));
    byte(0x80 | ((code >> 12U) & 0x3FU));
    byte(0x80 | ((code >> 6U) & 0x3FU));
  }
  byte(0x80 | (code & 0x3FU));
}

std::uint32_t at(std::string_view bytes, std::size_t i) {
  return static_cast<unsigned char>(bytes[i]);
}

// `high` is the index of the high byte in a pair: 0 or 1.
std::string from_utf16(std::string_view bytes, std::size_t high, const std::string& file) {
  if (bytes.size() % 2 != 0)
    throw InputError({file, 0, 0},
                     "begins as UTF-16 and ends in half a character; save it as "
                     "UTF-8");
  std::string text;
  const auto unit = [&](std::size_t i) {
    return (at(bytes, i + high) << 8U) | at(bytes, i + 1 - high);
  };
  for (std::size_t i = 0; i < bytes.size(); i += 2) {
    std::uint32_t code = unit(i);
    if (code >= 0xD800 && code < 0xDC00 && i + 2 < bytes.size()) {
      const std::uint32_t low = unit(i + 2);
      code = 0x10000 + ((code - 0xD800) << 10U) + (low - 0xDC00);
      i += 2;
    }
    append_utf8(text, code);
  }
  return text;
}

bool is_utf8(std::string_view text) {
  std::size_t follow = 0;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (follow > 0) {
      if ((byte & 0xC0U) != 0x80U) return false;
      --follow;
    } else if (byte >= 0x80U) {
      if (byte >= 0xC2U && byte < 0xE0U)
        follow = 1;
      else if (byte >= 0xE0U && byte < 0xF0U)
        follow = 2;
      else if (byte >= 0xF0U && byte < 0xF5U)
        follow = 3;
      else
        return false;
    }
  }
  return follow == 0;
}

// Files that hold no text, by their first bytes, and what to do with them.
void refuse_binary(std::string_view bytes, const std::string& file) {
  struct Signature {
    std::string_view start;
    const char* sentence;
  };
  using namespace std::string_view_literals;
  static constexpr std::array signatures{
      Signature{"\x1F\x8B"sv, "is compressed by gzip; unpack it with `gunzip -k`"},
      Signature{"BZh"sv, "is compressed by bzip2; unpack it with `bunzip2 -k`"},
      Signature{"\xFD"
                "7zXZ"sv,
                "is compressed by xz; unpack it with `unxz -k`"},
      Signature{"\x28\xB5\x2F\xFD"sv, "is compressed by zstd; unpack it with `unzstd`"},
      Signature{"7z\xBC\xAF\x27\x1C"sv, "is a 7z archive; unpack it with `7z x`"},
      Signature{"Rar!"sv, "is a RAR archive; unpack it with `unrar x`"},
      Signature{
          "PK\x03\x04"sv,
          "is a ZIP archive, as are .xlsx workbooks and .jpk-force files; export the curve as "
          "text (a workbook as CSV; JPK's Data Processing: Export, Text)"},
      Signature{"\x89HDF"sv,
                "is an HDF5 file; export the columns as CSV (afmformats writes curves as .tab)"},
      Signature{"\xD0\xCF\x11\xE0"sv, "is an old Office document (.xls); save it as CSV"},
      Signature{"TDSm"sv, "is a TDMS file of LabVIEW; export it as text"},
      Signature{"MATLAB 5.0"sv, "is a MATLAB file; save the columns with `writematrix`"},
      Signature{"\x93NUMPY"sv, "is a NumPy file; save it with `numpy.savetxt`"},
      Signature{"%PDF"sv, "is a PDF; export the numbers as CSV"}};
  for (const Signature& one : signatures)
    if (bytes.starts_with(one.start)) throw InputError({file, 0, 0}, one.sentence);
}

// UTF-16 without a mark: the text is mostly of ASCII, so that one byte of nearly each pair is 0.
std::optional<std::size_t> unmarked_utf16(std::string_view bytes) {
  const std::size_t pairs = std::min<std::size_t>(bytes.size() / 2, 2000);
  if (pairs < 4) return std::nullopt;
  std::array<std::size_t, 2> zeros{};
  for (std::size_t i = 0; i < 2 * pairs; ++i)
    if (bytes[i] == '\0') ++zeros[i % 2];
  for (const std::size_t high : {0U, 1U})
    if (zeros[high] * 10 > pairs * 8 && zeros[1 - high] == 0) return high;
  return std::nullopt;
}

std::string utf8_of(std::string_view bytes, const std::string& file) {
  if (bytes.starts_with("\xFF\xFE")) return from_utf16(bytes.substr(2), 1, file);
  if (bytes.starts_with("\xFE\xFF")) return from_utf16(bytes.substr(2), 0, file);
  refuse_binary(bytes, file);
  if (const auto high = unmarked_utf16(bytes)) return from_utf16(bytes, *high, file);
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  if (is_utf8(bytes)) return std::string(bytes);
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); ++i) append_utf8(text, at(bytes, i));
  return text;
}

}  // namespace

std::vector<Line> lines_of(std::string_view bytes, const std::string& file) {
  const std::string text = utf8_of(bytes, file);
  std::vector<Line> lines;
  std::size_t from = 0;
  while (from < text.size()) {
    std::size_t to = text.find_first_of("\r\n", from);
    if (to == std::string::npos) to = text.size();
    lines.push_back({static_cast<int>(lines.size()) + 1, text.substr(from, to - from)});
    if (const auto zero = lines.back().text.find('\0'); zero != std::string::npos)
      throw InputError({file, lines.back().number, static_cast<int>(zero) + 1},
                       "is no text: a NUL byte stands here; export the table as CSV in UTF-8");
    from = to + (text.compare(to, 2, "\r\n") == 0 ? 2 : 1);
  }
  return lines;
}

namespace {

// The column of a byte's character, from 1: continuation bytes are not counted.
int column_at(const std::string& text, std::size_t byte) {
  int column = 1;
  for (std::size_t i = 0; i < byte && i < text.size(); ++i)
    if ((static_cast<unsigned char>(text[i]) & 0xC0U) != 0x80U) ++column;
  return column;
}

}  // namespace

std::vector<Piece> pieces_of(const Line& line, char separator, const std::string& file) {
  const std::string& text = line.text;
  const bool blank = separator == ' ';
  const std::string_view ends = blank ? " \t" : std::string_view(&separator, 1);
  const std::string_view padding = separator == '\t' ? " " : " \t";
  std::vector<Piece> pieces;
  std::size_t next = 0;
  while (true) {
    next = std::min(text.find_first_not_of(padding, next), text.size());
    if (blank && next == text.size()) return pieces;
    Piece piece{{}, column_at(text, next)};
    std::size_t end = 0;
    if (next < text.size() && text[next] == '"') {
      std::size_t i = next + 1;
      for (; i < text.size(); ++i) {
        if (text[i] == '"' && (i + 1 == text.size() || text[i + 1] != '"')) break;
        if (text[i] == '"') ++i;
        piece.text += text[i];
      }
      if (i >= text.size())
        throw InputError(
            {file, line.number, piece.column},
            "the quote opened here is not closed on its line; end the field with `\"`");
      piece.text = trimmed(piece.text);
      end = std::min(text.find_first_of(ends, i + 1), text.size());
    } else {
      end = std::min(text.find_first_of(ends, next), text.size());
      piece.text = trimmed(std::string_view(text).substr(next, end - next));
    }
    pieces.push_back(piece);
    if (end == text.size()) return pieces;
    next = end + 1;
  }
}

}  // namespace palpate::measured
