// File operations by POSIX calls; every return value is checked, so that a full disk is not missed.
#include "base/files.h"

#include <fcntl.h>
#include <poll.h>
#include <sha2.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <span>

#include "base/error.h"
#include "base/index.h"
#include "base/text.h"

namespace palpate {

namespace {

constexpr std::size_t most_bytes = std::size_t{2} << 30;         // of a file in memory
constexpr std::size_t most_pipe_bytes = std::size_t{256} << 20;  // which may be a large file's
constexpr std::size_t most_line_bytes = std::size_t{64} << 20;   // of a line, or of a device
constexpr std::size_t part_bytes = std::size_t{1} << 16;         // that are read at a time
constexpr int patience = 10'000;  // ms, for a pipe to which nobody writes

// A file that is read from its start: every read tells an error from the end.
class Source {
 public:
  explicit Source(const std::string& path) : path_(path) {
    // Without O_NONBLOCK the system would wait for somebody who writes to a pipe.
    file_ = path == "-" ? ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0)
                        : ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    struct stat status {};
    if (file_ < 0 || ::fstat(file_, &status) != 0) refuse();
    regular_ = S_ISREG(status.st_mode);
    if (!regular_ && !S_ISFIFO(status.st_mode) && !S_ISCHR(status.st_mode))
      refuse("is not a file; give the path of a file");
    if (!regular_) most_ = S_ISFIFO(status.st_mode) ? most_pipe_bytes : most_line_bytes;
    size_ = as_index(std::max<off_t>(status.st_size, 0));
  }

  // The number of bytes that were read; 0 at the end.
  std::size_t read(std::span<char> into) {
    for (;;) {
      wait();
      const ssize_t got = ::read(file_, into.data(), into.size());
      if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
      if (got < 0) refuse();
      return as_index(got);
    }
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] bool regular() const { return regular_; }

  // Refuses a file (or a line of it, the `what`) that is too large for the memory.
  void check_size(std::size_t size, const char* what = "") {
    const std::size_t most = *what == 0 ? most_ : most_line_bytes;
    if (size > most)
      refuse(std::string("has ") + what + "more than " + std::to_string(most >> 20) +
             " MiB, the most that is read; give a smaller file");
  }

 private:
  [[noreturn]] void refuse(const std::string& why) { throw InputError({path_, 0, 0}, why); }
  [[noreturn]] void refuse() {
    const int error = errno;
    refuse(std::string("cannot be read: ") + std::strerror(error) +
           (error == EIO      ? "; copy it from a disk that works"
            : error == EACCES ? "; check its permissions"
                              : "; check the path"));
  }
  void wait() {
    pollfd source{file_, POLLIN, 0};
    if (regular_ || ::poll(&source, 1, patience) != 0) return;
    refuse("is no file, and nothing has come from it for 10 s; give the path of a file");
  }

  const std::string& path_;
  Descriptor file_;
  bool regular_ = false;
  std::size_t size_ = 0;           // bytes, 0 if the system does not know it
  std::size_t most_ = most_bytes;  // that are read
};

}  // namespace

Descriptor::~Descriptor() {
  if (file_ >= 0) ::close(file_);
}

bool write_all(int file, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(file, content.data(), content.size());
    if (written < 0 && errno != EINTR) return false;
    content.remove_prefix(as_index(std::max<ssize_t>(written, 0)));
  }
  return true;
}

std::string read_text(const std::string& path) {
  Source source(path);
  source.check_size(source.size());
  std::string content;
  content.reserve(source.size() + part_bytes);
  while (true) {
    const std::size_t before = content.size();
    content.resize(before + part_bytes);
    const std::size_t got = source.read(std::span(content).subspan(before));
    content.resize(before + got);
    source.check_size(content.size());
    if (got == 0) return content;
  }
}

namespace {

[[noreturn]] void fail(const std::string& path, int error = errno) {
  throw SystemError(path + " cannot be written: " + std::strerror(error));
}

// While this exists, a signal that ends the program waits, so that no temporary file is left.
class SignalsWait {
 public:
  SignalsWait() {
    sigset_t ends;
    ::sigemptyset(&ends);
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::sigaddset(&ends, signal);
    ::pthread_sigmask(SIG_BLOCK, &ends, &before_);
  }
  ~SignalsWait() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;

 private:
  sigset_t before_{};
};

constexpr const char* left_name = ".palpate-part";  // before a process number

// Removes what processes have left that were killed before a whole file took its place.
void remove_left(const std::string& path) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(path).parent_path();
  const std::string begin = fs::path(path).filename().string() + left_name;
  std::error_code none;
  fs::directory_iterator at(folder.empty() ? "." : folder, none);
  for (; !none && at != fs::directory_iterator(); at.increment(none))
    if (at->path().filename().string().starts_with(begin) && HeldFile().take(at->path().string()))
      ::unlink(at->path().c_str());
}

}  // namespace

void HeldFile::write(const std::string& path, std::string_view content, Disk disk) {
  const SignalsWait wait;
  const std::string temporary = path + left_name + std::to_string(::getpid());
  // Without a name until it is whole, so that SIGKILL leaves nothing; not every file system can.
  const std::string folder = std::filesystem::path(path).parent_path().string();
  Descriptor file =
      ::open(folder.empty() ? "." : folder.c_str(), O_RDWR | O_TMPFILE | O_CLOEXEC, 0666);
  const bool unnamed = file >= 0;
  if (!unnamed) file = ::open(temporary.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  // A file that could not be replaced later is not begun.
  if (file >= 0 && ::access(temporary.c_str(), F_OK) != 0 && errno == ENAMETOOLONG) file = {};
  const auto check = [&](bool good) {
    if (good) return;
    const int error = errno;
    ::unlink(temporary.c_str());
    if (error == ENAMETOOLONG)
      throw InputError({path, 0, 0}, "is too long for the name of a file; give a shorter one");
    fail(path, error);
  };
  check(file >= 0);
  // Waits: a process that clears up may hold the new file for a moment. If the file system has no
  // locks, the file is written without one.
  while (::flock(file, LOCK_EX) != 0 && errno == EINTR) {
  }
  // A file that is replaced keeps its mode and, as far as this process may give files away, its
  // owner; chown() takes bits of the mode.
  struct stat there {};
  if (::stat(path.c_str(), &there) == 0) {
    (void)!::fchown(file, there.st_uid, there.st_gid);
    check(::fchmod(file, there.st_mode & 07777) == 0);
  }
  check(write_all(file, content));
  // Where the system cannot begin early, sync_file() does all.
  if (disk == Disk::now)
    check(::fsync(file) == 0);
  else
    (void)::sync_file_range(file, 0, 0, SYNC_FILE_RANGE_WRITE);
  const std::string itself = "/proc/self/fd/" + std::to_string(file);
  const auto name = [&](const std::string& as) {
    return ::linkat(AT_FDCWD, itself.c_str(), AT_FDCWD, as.c_str(), AT_SYMLINK_FOLLOW) == 0;
  };
  if (!unnamed || !name(path)) {  // a file of that name is there
    remove_left(path);
    if (unnamed) {
      ::unlink(temporary.c_str());
      check(name(temporary));
    }
    check(::rename(temporary.c_str(), path.c_str()) == 0);
  }
  file_ = std::move(file);
}

bool HeldFile::take(const std::string& path) {
  file_ = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  struct stat ours {};
  struct stat there {};
  if (file_ >= 0 && ::flock(file_, LOCK_EX | LOCK_NB) == 0 && ::fstat(file_, &ours) == 0 &&
      ::stat(path.c_str(), &there) == 0 && ours.st_ino == there.st_ino)
    return true;  // otherwise another process has just replaced the file
  release();
  return false;
}

namespace {

// Writes into what a path names already: a device or a pipe.
void write_through(const std::string& path, std::string_view content) {
  Descriptor file = ::open(path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
  if (file < 0 || !write_all(file, content) || ::close(file.release()) != 0) fail(path);
}

// Where links lead, also to a file that is not there yet: it is replaced, and not the link.
std::string followed(const std::string& path) {
  constexpr int most = 40;  // as Linux
  std::filesystem::path at = path;
  std::error_code none;
  for (int links = 0; std::filesystem::is_symlink(at, none); ++links) {
    if (links == most)
      throw InputError({path, 0, 0}, "is a link that leads to itself; give another path");
    at = at.parent_path() / std::filesystem::read_symlink(at, none);
  }
  return at.string();
}

}  // namespace

void sync_file(const std::string& path) {
  const Descriptor file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0 || ::fsync(file) != 0) fail(path);
}

void write_atomically(const std::string& path, std::string_view content, Disk disk) {
  struct stat there {};
  const bool exists = ::stat(path.c_str(), &there) == 0;
  if (exists && S_ISDIR(there.st_mode))
    throw InputError({path, 0, 0}, "is a folder, and a file is to be written; give its name");
  if (exists && !S_ISREG(there.st_mode)) return write_through(path, content);
  const std::string target = followed(path);
  if (!exists) make_folders(std::filesystem::path(target).parent_path().string());
  HeldFile().write(target, content, disk);
}

void make_folders(const std::string& path) {
  std::error_code error;
  if (!path.empty()) std::filesystem::create_directories(path, error);
  if (error == std::errc::not_a_directory || error == std::errc::file_exists)
    throw InputError(
        {path, 0, 0},
        "cannot be a folder, because a part of this path is a file; give another path");
  if (error == std::errc::filename_too_long)
    throw InputError({path, 0, 0}, "is too long for the name of a folder; give a shorter one");
  if (error == std::errc::no_such_file_or_directory)  // as in /proc
    throw InputError({path, 0, 0},
                     "cannot be a folder, because none can be made there; give another path");
  if (error) throw SystemError(path + " cannot be made: " + error.message());
}

std::vector<std::string> entries_of(const std::string& folder) {
  std::vector<std::string> paths;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    paths.push_back(entry.path().string());
  std::ranges::sort(paths);
  return paths;
}

std::string host_name() {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0) return "unknown";
  std::string text = name.data();
  std::ranges::replace(text, '/', '_');
  return text;
}

struct Sha256::Context : SHA2_CTX {};

Sha256::Sha256() : context_(std::make_unique<Context>()) { SHA256Init(context_.get()); }
Sha256::~Sha256() = default;

void Sha256::add(std::string_view part) {
  SHA256Update(context_.get(), reinterpret_cast<const std::uint8_t*>(part.data()), part.size());
}

std::string Sha256::digits() {
  std::array<std::uint8_t, SHA256_DIGEST_LENGTH> digest{};
  SHA256Final(digest.data(), context_.get());
  std::string text;
  for (const std::uint8_t byte : digest) text += hex_text(byte);
  return text;
}

std::string sha256(std::string_view content) {
  Sha256 hash;
  hash.add(content);
  return hash.digits();
}

std::string file_sha256(const std::string& path) {
  Source source(path);
  Sha256 hash;
  std::string part(part_bytes, '\0');  // a recording of an hour at 1 kHz has a gigabyte
  std::size_t size = 0;
  while (const std::size_t got = source.read(part)) {
    hash.add(std::string_view(part).substr(0, got));
    size += got;
    if (!source.regular()) source.check_size(size);  // a device may never end
  }
  return hash.digits();
}

void for_each_line(const std::string& path, const std::function<void(const FileLine&)>& see) {
  Source source(path);
  std::string held;
  std::size_t begin = 0;   // offset of `held` in the file
  std::size_t looked = 0;  // length of the part of `held` that has no line feed
  while (true) {
    const std::size_t before = held.size();
    held.resize(before + part_bytes);
    const std::size_t got = source.read(std::span(held).subspan(before));
    held.resize(before + got);
    std::size_t at = 0;
    for (std::size_t end = held.find('\n', looked); end != std::string::npos;
         end = held.find('\n', at)) {
      see({begin + at, std::string_view(held).substr(at, end - at), true});
      at = end + 1;
    }
    held.erase(0, at);
    begin += at;
    looked = held.size();
    source.check_size(looked, "a line of ");
    if (got == 0) break;
  }
  if (!held.empty()) see({begin, held, false});
}

GrowingFile::GrowingFile(std::string path) : path_(std::move(path)) {
  file_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file_ < 0) throw SystemError(path_ + " cannot be made: " + std::strerror(errno));
}

void GrowingFile::append(std::string_view text) {
  if (!write_all(file_, text)) {
    const int error = errno;
    // Where it fails, a reader recognises the incomplete line as such.
    (void)!::ftruncate(file_, static_cast<off_t>(size_));
    ::lseek(file_, static_cast<off_t>(size_), SEEK_SET);
    fail(path_, error);
  }
  size_ += text.size();
}

void GrowingFile::sync() {
  if (::fsync(file_) != 0) fail(path_);
}

}  // namespace palpate
