// Files: read whole, written beside and renamed, so that nobody ever sees half of one.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace palpate {

// The whole file. Throws InputError where it is not there or cannot be read.
[[nodiscard]] std::string read_text(const std::string& path);

// Writes `path` by way of a temporary file beside it, flushed to the disk and renamed.
// Throws SystemError (a full disk, no permission); then `path` is as it was before.
void write_atomically(const std::string& path, std::string_view content);

// SHA-256 as 64 lower-case hexadecimal digits.
[[nodiscard]] std::string sha256(std::string_view content);

// The same of a content that comes in parts.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  void add(std::string_view part);
  [[nodiscard]] std::string digits();  // once, at the end

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

// A line of a file: where it begins, in bytes, and its text without the line feed.
struct FileLine {
  std::size_t offset = 0;
  std::string_view text;
  bool whole = true;  // false: the file ends without a line feed
};

// Calls `see` with every line, holding no more than a part of the file and the longest line at a
// time. Throws InputError where the file cannot be read.
void for_each_line(const std::string& path, const std::function<void(const FileLine&)>& see);

// A new file that grows at its end, for what is too much to hold or must outlive its program.
class GrowingFile {
 public:
  // Throws SystemError where the file cannot be made; it is an error that it is there.
  explicit GrowingFile(std::string path);
  ~GrowingFile();
  GrowingFile(const GrowingFile&) = delete;
  GrowingFile& operator=(const GrowingFile&) = delete;

  // One write() where the system takes it at once. What cannot be written whole is cut off again;
  // then throws SystemError (a full disk, a limit).
  void append(std::string_view text);
  // Returns when all of it is on the disk. Throws SystemError.
  void sync();

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
  int file_ = -1;
  std::size_t size_ = 0;
};

}  // namespace palpate
