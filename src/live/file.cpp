// Writes a live file; an error becomes a sentence, and the next attempt follows a second later.
#include "live/file.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/error.h"

namespace palpate::live {
namespace {

constexpr auto pause = std::chrono::seconds(1);
constexpr std::size_t page = 4096;  // bytes

}  // namespace

LiveFile::LiveFile(std::string path) : path_(std::move(path)) {}

std::size_t LiveFile::append(std::string_view text) {
  if (!named() || Clock::now() < next_try_) return 0;
  std::size_t taken = 0;
  try {
    if (!file_) file_ = std::make_unique<GrowingFile>(path_);
    while (taken < text.size()) {
      const std::string_view piece = text.substr(taken, next_piece(text.substr(taken)));
      file_->append(piece);
      taken += piece.size();
      size_ += piece.size();
    }
  } catch (const SystemError& error) {
    fail(error.what());
  }
  if (taken > 0 && !dirty_) next_sync_ = Clock::now() + pause;
  dirty_ = dirty_ || taken > 0;
  return taken;
}

// The length of the lines that fit into the current page of the file, or of one longer line:
// SIGKILL may end a longer write at a page boundary, within a line.
std::size_t LiveFile::next_piece(std::string_view text) const {
  const std::size_t last = text.substr(0, page - size_ % page).rfind('\n');
  if (last != std::string_view::npos) return last + 1;
  return std::min(text.find('\n'), text.size() - 1) + 1;
}

void LiveFile::sync_when_due() {
  if (dirty_ && Clock::now() >= next_sync_) sync();
}

void LiveFile::sync() {
  if (!dirty_) return;
  dirty_ = false;
  try {
    file_->sync();
  } catch (const SystemError& error) {
    fail(error.what());
  }
}

// The sentence becomes part of a result, without the folder, whose name has a process number.
void LiveFile::fail(const std::string& why) {
  next_try_ = Clock::now() + pause;
  if (!trouble_.empty()) return;
  trouble_ = why.starts_with(path_)
                 ? std::filesystem::path(path_).filename().string() + why.substr(path_.size())
                 : why;
}

}  // namespace palpate::live
