// Tries every separator with every decimal sign and takes the pair that gives the most numbers.
#include "measured/shape.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <tuple>

#include "base/error.h"
#include "base/text.h"
#include "measured/table.h"

namespace palpate::measured {
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
  return std::any_of(pieces.begin(), pieces.end(), [](const Piece& piece) {
    return piece.text.find(' ') != std::string::npos &&
           std::any_of(piece.text.begin(), piece.text.end(),
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
  std::replace(point.begin(), point.end(), ',', '.');
  std::string whole = example;
  std::erase(whole, ',');
  throw InputError(place, "`" + example + "` could be " + point + " or " + whole +
                              ", and no other number of the file decides this; give `--decimal ,`, "
                              "or save the numbers with points and without marks between "
                              "thousands");
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
