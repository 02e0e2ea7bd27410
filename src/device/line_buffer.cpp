// Lines of bytes, and what tells that the bytes are none.
#include "device/line_buffer.h"

#include <algorithm>
#include <cstring>

namespace palpate::device {
namespace {

bool is_end(char c) { return c == '\r' || c == '\n'; }

}  // namespace

void LineBuffer::feed(std::string_view bytes) {
  if (bytes.size() > bytes_.size()) {
    dropped_ += bytes.size() - bytes_.size();
    bytes.remove_prefix(bytes.size() - bytes_.size());
  }
  const std::size_t waiting = end_ - begin_;
  const std::size_t room = bytes_.size() - bytes.size();
  if (waiting > room) {
    dropped_ += waiting - room;
    begin_ += waiting - room;
  }
  std::memmove(bytes_.data(), bytes_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  std::copy(bytes.begin(), bytes.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(end_));
  end_ += bytes.size();
}

std::optional<std::string_view> LineBuffer::next() {
  while (begin_ < end_ && is_end(bytes_[begin_])) ++begin_;
  std::size_t at = begin_;
  while (at < end_ && !is_end(bytes_[at]) && at - begin_ < longest_line) ++at;
  if (at == end_) return std::nullopt;
  const std::string_view line(bytes_.data() + begin_, at - begin_);
  begin_ = at;
  return without_outer_spaces(line);
}

std::string_view LineBuffer::rest() const { return {bytes_.data() + begin_, end_ - begin_}; }

void LineBuffer::clear() { begin_ = end_ = 0; }

std::string_view without_outer_spaces(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

double garbage_share(std::string_view bytes) {
  if (bytes.empty()) return 0.0;
  const auto odd = std::count_if(bytes.begin(), bytes.end(), [](char c) {
    return !is_end(c) &&
           (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) > 0x7e);
  });
  return static_cast<double>(odd) / static_cast<double>(bytes.size());
}

std::string printable(std::string_view bytes) {
  std::string text;
  for (const char c : bytes.substr(0, 40)) text += c >= ' ' && c <= '~' ? c : '.';
  return text;
}

}  // namespace palpate::device
