// Decodes the encodings and line ends that instruments, spreadsheets and old Macs write.

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>

#include "base/error.h"
#include "base/text.h"
#include "base/written.h"
#include "measured/table.h"

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
                     "begins as UTF-16 and ends in half a character; save it as UTF-8");
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
      Signature{"PK\x03\x04"sv,
                "is a ZIP archive, as are .xlsx workbooks and .jpk-force files; export the curve "
                "as text (a workbook as CSV; JPK's Data Processing: Export, Text)"},
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
  if (first_broken_character(bytes) == bytes.size()) return std::string(bytes);
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
    Piece piece{{}, 1 + static_cast<int>(letter_count(std::string_view(text).substr(0, next)))};
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

// Tries every separator with every decimal sign and takes the pair that gives the most numbers.

namespace {

char separator_of(const std::string& word) {
  if (word == "tab" || word == "\t" || word == "\\t") return '\t';
  if (word == "blank" || word == "space" || word == " ") return ' ';
  if (word == "," || word == "comma") return ',';
  if (word == ";" || word == "semicolon" || word == "|") return word == "|" ? '|' : ';';
  throw InputError(
      {}, "palpate: `--separator " + word + "` is unknown; give `,`, `;`, `|`, `tab` or `blank`");
}

char decimal_of(const std::string& word) {
  if (word == "." || word == "point") return '.';
  if (word == "," || word == "comma") return ',';
  throw InputError({}, "palpate: `--decimal " + word + "` is unknown; give `.` or `,`");
}

// Whether words with blanks between them stand between tabs, as `Data point` does: blanks separate
// no columns then.
bool tabs_separate(const Line& line, const std::string& file) {
  if (line.text.find('\t') == std::string::npos) return false;
  const std::vector<Piece> pieces = pieces_of(line, '\t', file);
  return std::ranges::any_of(pieces, [](const Piece& piece) {
    return piece.text.find(' ') != std::string::npos &&
           std::ranges::any_of(piece.text,
                               [](unsigned char each) { return std::isalpha(each) != 0; });
  });
}

// The numbers of lines with only numbers (at least two), of lines with at least two numbers, and of
// lines of several fields with at least one number, which count only where no line has two. Lines
// count that have as many fields as most such lines: `Creep - 1` is a title.
using Score = std::tuple<int, int, int>;

Score score(std::span<const Line> lines, const Shape& shape, const std::string& file) {
  struct Counts {
    int whole = 0, some = 0, any = 0;
  };
  std::map<std::size_t, Counts> by_width;
  for (const Line& line : lines) {
    if (is_comment(line) || is_blank(line)) continue;
    try {
      if (shape.separator == ' ' && tabs_separate(line, file)) continue;
      const std::vector<Piece> fields = pieces_of(line, shape.separator, file);
      const Numbers numbers = numbers_in(fields, shape.decimal);
      std::size_t width = fields.size();
      while (width > 0 && fields[width - 1].text.empty()) --width;
      Counts& counts = by_width[width];
      if (numbers.count >= 1 && fields.size() >= 2) ++counts.any;
      if (numbers.count >= 2) ++counts.some;
      if (numbers.count >= 2 && numbers.all) ++counts.whole;
    } catch (const InputError&) {  // a quote that is open with this separator only
    }
  }
  Counts most;
  const auto rank = [](const Counts& one) { return std::tuple(one.some, one.whole, one.any); };
  for (const auto& [width, counts] : by_width)
    if (rank(counts) > rank(most)) most = counts;
  return {most.whole, most.some, most.some > 0 ? 0 : most.any};
}

// Whether the commas may separate thousands, as in `1,234`. They do not if the number begins with 0
// or has other than three digits after its first comma.
bool could_be_thousands(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) return true;
  const std::size_t first = text.find_first_of("0123456789");
  return text.size() - comma == 4 && first < comma && comma - first <= 3 && text[first] != '0';
}

void refuse_thousands(std::span<const Line> lines, const Shape& shape, const std::string& file) {
  Place place{file, 0, 0};
  std::string example;
  for (const Line& line : lines) {
    if (is_comment(line) || is_blank(line)) continue;
    const std::vector<Piece> fields = pieces_of(line, shape.separator, file);
    if (numbers_in(fields, shape.decimal).count < 2) continue;
    for (const Piece& field : fields) {
      if (!measured_number(field.text, ',')) continue;
      if (!could_be_thousands(field.text)) return;
      if (!example.empty() || field.text.find(',') == std::string::npos) continue;
      example = field.text;
      place = {file, line.number, field.column};
    }
  }
  if (example.empty()) return;
  std::string point = example;
  std::ranges::replace(point, ',', '.');
  std::string whole = example;
  std::erase(whole, ',');
  throw InputError(place,
                   "`" + example + "` could be " + point + " or " + whole +
                       ", and no other number of the file decides this; give `--decimal ,`, or "
                       "save the numbers with points and without marks between thousands");
}

// A line of numbers such as `1.500,25;-476,5`, whose commas separate no columns, is refused.
void refuse_marked_numbers(const Line& line, const std::string& file) {
  const std::vector<Piece> fields = pieces_of(line, ';', file);
  const Piece* example = nullptr;
  for (const Piece& field : fields) {
    const std::size_t comma = field.text.find(',');
    if (comma != std::string::npos && field.text.find('.') < comma) example = &field;
    std::string plain = field.text;
    std::erase(plain, '.');
    if (plain.empty() || !measured_number(plain, ',')) return;
  }
  if (example == nullptr || fields.size() < 2) return;
  throw InputError({file, line.number, example->column},
                   "`" + example->text +
                       "` has marks between thousands, which are no part of a number; save the "
                       "numbers without them, as `1234.5`");
}

}  // namespace

bool is_comment(const Line& line) {
  const std::size_t first = line.text.find_first_not_of(" \t");
  return first != std::string::npos && line.text[first] == '#';
}

bool is_blank(const Line& line) { return line.text.find_first_not_of(" \t") == std::string::npos; }

Numbers numbers_in(std::span<const Piece> fields, char decimal) {
  Numbers numbers{0, true};
  for (const Piece& field : fields) {
    const auto number = measured_number(field.text, decimal);
    if (!number) numbers.all = false;
    if (number && !field.text.empty()) ++numbers.count;
  }
  return numbers;
}

namespace {

// The first and last lines of a long file, and some between.
std::vector<Line> sample_of(std::span<const Line> lines) {
  constexpr std::size_t part = 1000;
  if (lines.size() <= 3 * part) return {lines.begin(), lines.end()};
  std::vector<Line> some(lines.begin(), lines.begin() + part);
  for (std::size_t k = 0; k < part; ++k)
    some.push_back(lines[part + (lines.size() - 2 * part) * k / part]);
  some.insert(some.end(), lines.end() - part, lines.end());
  return some;
}

}  // namespace

Shape shape_of(std::span<const Line> all, const std::string& file, const DataLayout& layout) {
  const std::vector<Line> lines = sample_of(all);
  constexpr std::array separators{'\t', ';', ',', ' ', '|'};  // at equal scores the first is taken
  constexpr std::array decimals{'.', ','};
  Shape best;
  best.separator_given = !layout.separator.empty();
  best.decimal_given = !layout.decimal.empty();
  const char separator = best.separator_given ? separator_of(layout.separator) : '\0';
  const char decimal = best.decimal_given ? decimal_of(layout.decimal) : '\0';
  Score highest{-1, -1, -1};
  for (const char one : separators)
    for (const char mark : decimals) {
      if ((best.separator_given && one != separator) || (best.decimal_given && mark != decimal))
        continue;
      Shape shape = best;
      shape.separator = one;
      shape.decimal = mark;
      const Score reached = score(lines, shape, file);
      if (reached <= highest) continue;
      highest = reached;
      best = shape;
    }
  if (best.separator == ',' && !best.separator_given)
    for (const Line& line : lines) refuse_marked_numbers(line, file);
  if (best.decimal == ',' && !best.decimal_given) refuse_thousands(all, best, file);
  return best;
}

}  // namespace palpate::measured
