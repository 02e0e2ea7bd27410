// Failures become a sentence and a pause.
#include "run/live_file.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/error.h"

namespace palpate::run {
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

// Lines that lie in one page of the file, or one line that does not: SIGKILL ends a write between
// two pages, and would leave half a line of a longer piece.
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

// The sentence goes into a result: the folder, which has a process's number, stays out of it.
void LiveFile::fail(const std::string& why) {
  next_try_ = Clock::now() + pause;
  if (!trouble_.empty()) return;
  trouble_ = why.starts_with(path_)
                 ? std::filesystem::path(path_).filename().string() + why.substr(path_.size())
                 : why;
}

}  // namespace palpate::run
