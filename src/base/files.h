// Files: reading, writing without readers ever seeing half a file, locks and checksums.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpate {

// An open file of the system, which is closed with it; below 0 there is none.
class Descriptor {
 public:
  Descriptor(int file = -1) : file_(file) {}  // NOLINT(google-explicit-constructor)
  Descriptor(Descriptor&& other) noexcept : file_(other.release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(file_, other.file_);
    return *this;
  }
  ~Descriptor();
  operator int() const { return file_; }  // NOLINT(google-explicit-constructor)
  int release() { return std::exchange(file_, -1); }

 private:
  int file_;
};

// Returns the content of a file. Throws InputError if it does not exist, if it is larger than 2 GiB
// (as a pipe 256 MiB, as a device 64 MiB), and if reading fails before the end.
[[nodiscard]] std::string read_text(const std::string& path);

// Writes to an open file; false, with the reason in errno, if not all could be written.
[[nodiscard]] bool write_all(int file, std::string_view content);

// Replaces a file whole, by a temporary one on the disk, which gets the mode of the old one; makes
// its folder; writes into a device, a pipe or a link's target. Throws SystemError (full disk, no
// permission), the file as it was. With Disk::later the new content is only on its way to the disk,
// and sync_file() waits for it.
enum class Disk { now, later };
void write_atomically(const std::string& path, std::string_view content, Disk disk = Disk::now);

// Returns when the file is on the disk. Throws SystemError.
void sync_file(const std::string& path);

// Creates a folder and the folders above it if they do not exist. Throws SystemError.
void make_folders(const std::string& path);

// The paths of a folder's entries in alphabetical order; empty if the folder cannot be read.
[[nodiscard]] std::vector<std::string> entries_of(const std::string& folder);

// The name of this machine, with every `/` replaced, so that it can be part of a file name.
[[nodiscard]] std::string host_name();

// A file with an exclusive lock (flock), which the system releases when the process ends.
class HeldFile {
 public:
  // Writes a file as write_atomically() does. The lock exists before the file has its final name.
  void write(const std::string& path, std::string_view content, Disk disk = Disk::now);
  // Locks an existing file. Returns false if another process has the lock, there is no such file,
  // or its file system has no locks.
  [[nodiscard]] bool take(const std::string& path);
  void release() { file_ = {}; }

 private:
  Descriptor file_;
};

// SHA-256 as 64 lower-case hexadecimal digits.
[[nodiscard]] std::string sha256(std::string_view content);
// The same of a file, which may be larger than the memory. Throws InputError if it cannot be read.
[[nodiscard]] std::string file_sha256(const std::string& path);

// A file's name and the hash of its content.
struct HashedFile {
  std::string path = {};
  std::string sha256 = {};
  bool operator==(const HashedFile&) const = default;
};

// SHA-256 of content that comes in parts.
class Sha256 {
 public:
  Sha256();
  ~Sha256();
  void add(std::string_view part);
  [[nodiscard]] std::string digits();  // call once, at the end

 private:
  struct Context;
  std::unique_ptr<Context> context_;
};

// A line of a file: the offset of its start in bytes, and its text without the line feed.
struct FileLine {
  std::size_t offset = 0;
  std::string_view text;
  bool whole = true;  // false: the file ends without a line feed
};

// Calls `see` with every line in order. In memory is at most a part of the file and its longest
// line, which has at most 64 MiB. Throws InputError as read_text() does.
void for_each_line(const std::string& path, const std::function<void(const FileLine&)>& see);

// A new file for appending: for data too large for the memory, or to be kept if the program dies.
class GrowingFile {
 public:
  // Throws SystemError if the file cannot be created or exists already.
  explicit GrowingFile(std::string path);
  // Appends the text, by one write() if the system accepts it whole. On an error the part that was
  // written is cut off again and SystemError is thrown (a full disk, a size limit).
  void append(std::string_view text);
  // Returns when the whole file is on the disk. Throws SystemError.
  void sync();

  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
  Descriptor file_;
  std::size_t size_ = 0;
};

}  // namespace palpate
