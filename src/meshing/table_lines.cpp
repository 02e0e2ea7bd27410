// Splits lines into words at blanks or commas, as TetGen does.
#include "meshing/table_lines.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/files.h"
#include "base/text.h"

namespace palpate::meshing {

TableLines::TableLines(std::string file) : file_(std::move(file)), text_(read_text(file_)) {}

bool TableLines::next() {
  constexpr std::string_view gaps = " \t\r,";
  // Some programs end their files with zero bytes.
  while (text_.find_first_not_of('\0', position_) != std::string::npos) {
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    current_ = std::string_view(text_).substr(position_, end - position_);
    position_ = end + 1;
    ++line_;
    words_.clear();
    const std::string_view content = current_.substr(0, current_.find('#'));
    std::size_t start = content.find_first_not_of(gaps);
    while (start != std::string_view::npos) {
      const std::size_t stop = std::min(content.find_first_of(gaps, start), content.size());
      words_.push_back(content.substr(start, stop - start));
      start = content.find_first_not_of(gaps, stop);
    }
    if (!words_.empty()) return true;
  }
  words_.clear();
  return false;
}

bool TableLines::next_joined() {
  constexpr char goes_on = '\\';
  if (!next()) return false;
  if (!words_.back().ends_with(goes_on)) return true;
  std::vector<std::string_view> joined = words_;
  while (!joined.empty() && joined.back().ends_with(goes_on)) {
    joined.back().remove_suffix(1);
    if (joined.back().empty()) joined.pop_back();
    if (!next()) break;
    joined.insert(joined.end(), words_.begin(), words_.end());
  }
  words_ = std::move(joined);
  return !words_.empty();
}

void TableLines::skip_paragraph() {
  bool empty = false;
  while (!empty && position_ < text_.size()) {
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    empty = trimmed(std::string_view(text_).substr(position_, end - position_)).empty();
    position_ = end + 1;
    ++line_;
  }
}

std::string_view TableLines::take(std::size_t bytes) {
  if (position_ > text_.size() || bytes > text_.size() - position_)
    throw InputError({file_}, "ends in the numbers after line " + std::to_string(line_) +
                                  "; it is cut short: save it again");
  position_ += bytes;
  return std::string_view(text_).substr(position_ - bytes, bytes);
}

double TableLines::number(std::size_t i, const std::string& what) const {
  const auto value = whole_number(words_[i]);
  if (!value || !std::isfinite(*value))
    fail_at(i, what + " wants a finite number, got `" + std::string(words_[i]) +
                   "`; write it like `12.5` or `1.25e1`");
  return *value;
}

int TableLines::whole(std::size_t i, const std::string& what) const {
  const auto value = whole_number(words_[i]);
  // Within the range of int, so that the conversion is defined.
  constexpr double most = std::numeric_limits<int>::max();
  if (!value || !(std::abs(*value) <= most) || std::trunc(*value) != *value)
    fail_at(i, what + " wants a whole number, got `" + std::string(words_[i]) +
                   "`; write it like `12`");
  return static_cast<int>(*value);
}

void TableLines::fail(const std::string& message) const {
  throw InputError({file_, line_}, message);
}

void TableLines::fail_at(std::size_t i, const std::string& message) const {
  // A word of a joined line may stand in an earlier one.
  const std::string_view text = text_;
  const auto at = static_cast<std::size_t>(words_[i].data() - text.data());
  const auto line_end = static_cast<std::size_t>(current_.data() - text.data()) + current_.size();
  const auto lines_after =
      std::count(text.begin() + static_cast<std::ptrdiff_t>(at),
                 text.begin() + static_cast<std::ptrdiff_t>(std::max(at, line_end)), '\n');
  const std::size_t start = at == 0 ? 0 : text.rfind('\n', at - 1) + 1;  // npos + 1 is 0
  throw InputError({file_, line_ - static_cast<int>(lines_after), static_cast<int>(at - start) + 1},
                   message);
}

}  // namespace palpate::meshing
