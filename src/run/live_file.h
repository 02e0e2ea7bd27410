// A file that grows while a live run goes on; what goes wrong with it ends nothing.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <string_view>

#include "base/files.h"

namespace palpate::run {

class LiveFile {
 public:
  // Nothing is made before the first text. An empty path: a file that takes nothing.
  explicit LiveFile(std::string path);

  // Returns how much of the text, which ends with a line feed, is in the file now: whole lines.
  // After a failure the file is left alone for a second.
  std::size_t append(std::string_view text);
  // Once a second, brings to the disk what is still on its way.
  void sync_when_due();
  // Does so now.
  void sync();
  // After a failure, lets the next append() try at once.
  void try_again() { next_try_ = {}; }

  // What went wrong first, as `force_indentation.csv cannot be written: No space left on device`;
  // empty where nothing did.
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
  bool dirty_ = false;  // not all of it is on the disk
  Clock::time_point next_sync_{};
  Clock::time_point next_try_{};
};

}  // namespace palpate::run
