// A part of a plan, and the lock of the process that runs it.
#pragma once

#include <cstddef>
#include <string>

#include "base/error.h"

namespace palpate::sweep {

// The i-th of n parts: every n-th case, so that all parts take about the same time.
struct Shard {
  std::size_t number = 1;  // from 1
  std::size_t of = 1;

  [[nodiscard]] bool holds(std::size_t index) const { return index % of == number - 1; }
  [[nodiscard]] std::string text() const;  // `3-of-16`
};

// Reads `3/16`. Throws InputError for any other text.
[[nodiscard]] Shard parse_shard(const std::string& text);

// Another process runs the part.
class PartIsRun : public InputError {
 public:
  using InputError::InputError;
};

// A lock for the life of the object; the system releases it however the process ends.
class FolderLock {
 public:
  // Locks FOLDER/locks/NAME.lock. Throws PartIsRun, naming the holder, if another process holds
  // the lock, and SystemError if the file cannot be made or locked. Where the file system has no
  // locks, there is none, and warning() says so: two runs of a part do no harm.
  FolderLock(const std::string& folder, const std::string& name);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  [[nodiscard]] const std::string& warning() const { return warning_; }  // a sentence, or empty

 private:
  int file_ = -1;
  std::string warning_;
};

}  // namespace palpate::sweep
