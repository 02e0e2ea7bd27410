// Failures become a sentence and a pause.
#include "run/live_file.h"

#include <filesystem>
#include <utility>

#include "base/error.h"

namespace palpate::run {
namespace {

constexpr auto pause = std::chrono::seconds(1);

}  // namespace

LiveFile::LiveFile(std::string path) : path_(std::move(path)) {}

bool LiveFile::append(std::string_view text) {
  if (!named()) return false;
  if (Clock::now() < next_try_) return false;
  try {
    if (!file_) file_ = std::make_unique<GrowingFile>(path_);
    file_->append(text);
  } catch (const SystemError& error) {
    fail(error.what());
    return false;
  }
  if (!dirty_) next_sync_ = Clock::now() + pause;
  dirty_ = true;
  return true;
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
