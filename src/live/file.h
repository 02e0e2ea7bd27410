// A file that grows during a live run; errors are kept as a sentence and do not end the run.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <string_view>

#include "base/files.h"

namespace palpate::live {

class LiveFile {
 public:
  // The file is created by the first append(). With an empty path nothing is ever written.
  explicit LiveFile(std::string path);

  // Appends whole lines of `text`, which ends with a line feed, and returns how many bytes were
  // written. For a second after a failure it writes nothing and returns 0.
  std::size_t append(std::string_view text);
  // Flushes written text to the disk, at most once a second.
  void sync_when_due();
  // Flushes it now.
  void sync();
  // After a failure, lets the next append() try at once.
  void try_again() { next_try_ = {}; }

  // The first error, as `force_indentation.csv cannot be written: No space left on device`, if any.
  [[nodiscard]] const std::string& trouble() const { return trouble_; }
  [[nodiscard]] bool named() const { return !path_.empty(); }

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] std::size_t next_piece(std::string_view text) const;
  void fail(const std::string& why);

  std::string path_;
  std::unique_ptr<GrowingFile> file_;
  std::size_t size_ = 0;  // bytes
  std::string trouble_;
  bool dirty_ = false;  // some text is not on the disk yet
  Clock::time_point next_sync_{};
  Clock::time_point next_try_{};
};

}  // namespace palpate::live
