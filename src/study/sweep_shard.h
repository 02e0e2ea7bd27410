// A part of a plan, and the lock of who runs it.
#pragma once

#include <cstddef>
#include <string>

namespace palpate::study {

// The i-th of n parts: every n-th case, so that all parts hold the same mix of cheap and dear.
struct Shard {
  std::size_t number = 1;  // from 1
  std::size_t of = 1;

  [[nodiscard]] bool holds(std::size_t index) const { return index % of == number - 1; }
  [[nodiscard]] std::string text() const;  // `3-of-16`
};

// `3/16`. Throws InputError for anything else.
[[nodiscard]] Shard parse_shard(const std::string& text);

// Held as long as it lives; the system gives it back however the process ends.
class FolderLock {
 public:
  // Locks FOLDER/locks/NAME.lock. Throws InputError, saying who holds it, where another process
  // does; SystemError where there can be no such file.
  FolderLock(const std::string& folder, const std::string& name);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int file_ = -1;
};

// This machine's name.
[[nodiscard]] std::string host_name();

}  // namespace palpate::study
